#pragma once
#include <complex>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/files/output_file.h"

/// The files that BELLHOP and BELLHOP3D write, as plain data. Layouts: docs/formats/bellhop.md,
/// bellhop3d.md. In these structs
/// as in the files: metres, seconds, Hz, degrees, angles positive down (declination).
namespace asdic::detail::bellhop {

/// Which numbers of a header are float64: Fortran BELLHOP writes float32, the toolbox since 2024
/// and its C++ port float64.
enum class Dialect { fortran, wide };

/// Where sources and lines of receivers are on the map, x east, y north. Of a single plane: one 0
/// each.
struct MapPlaces {
  std::vector<double> source_x = {0.0}, source_y = {0.0};  ///< [m]
  std::vector<double> azimuths_deg = {0.0};                ///< counter-clockwise from x

  /// x slowest, azimuth fastest.
  [[nodiscard]] std::size_t planes() const noexcept {
    return source_x.size() * source_y.size() * azimuths_deg.size();
  }
  /// Whether they are a map, and not the one plane that files of BELLHOP have.
  [[nodiscard]] bool is_map() const noexcept { return *this != MapPlaces(); }
  [[nodiscard]] bool operator==(const MapPlaces&) const = default;
};

/// A pressure field, `.shd`.
struct ShadeFile {
  std::string title;
  bool irregular = false;
  double frequency = 0.0;
  std::vector<double> source_depths, receiver_depths, receiver_ranges;  ///< [m]
  /// [planes × sources × rows × ranges]; rows: 1 if irregular
  std::vector<std::complex<float>> pressure;
  Dialect dialect = Dialect::fortran;
  MapPlaces map = {};
  [[nodiscard]] std::size_t rows() const noexcept { return irregular ? 1 : receiver_depths.size(); }
};

/// One row of an arrivals file.
struct ArrivalRow {
  double amplitude = 0.0;  ///< without absorption
  double phase_deg = 0.0;
  double delay = 0.0;            ///< [s]
  double delay_imaginary = 0.0;  ///< ≤ 0; amplitude × exp(2πf·delay_imaginary) has the absorption
  double launch_angle_deg = 0.0, arrival_angle_deg = 0.0;
  int surface_bounces = 0, bottom_bounces = 0;
  /// In three dimensions: of travel, clockwise from the line to the receiver; in a `.arr` of
  /// BELLHOP3D as azimuths, in one of BELLHOP not at all
  double launch_deflection_deg = 0.0, arrival_deflection_deg = 0.0;
};

/// Arrivals, `.arr`, ASCII or binary.
struct ArrivalsFile {
  bool binary = false;
  double frequency = 0.0;
  std::vector<double> source_depths, receiver_depths, receiver_ranges;  ///< [m]
  bool irregular = false;
  /// [planes × sources × rows × ranges], range fastest
  std::vector<std::vector<ArrivalRow>> arrivals;
  Dialect dialect = Dialect::fortran;
  bool three_dimensional = false;  ///< laid out as BELLHOP3D does it, with azimuths
  MapPlaces map = {};

  [[nodiscard]] std::size_t rows() const noexcept { return irregular ? 1 : receiver_depths.size(); }
};

/// Rays or eigenrays, `.ray`.
struct RayFile {
  struct Ray {
    double launch_angle_deg = 0.0;
    int surface_bounces = 0, bottom_bounces = 0;
    std::vector<double> range, depth;  ///< [n] [m]
  };
  std::string title;
  double frequency = 0.0;
  int sources_x = 1, sources_y = 1, sources_z = 1, angles = 0;
  double surface_depth = 0.0, bottom_depth = 0.0;  ///< [m]
  std::vector<Ray> rays;
};

/// The same files in memory, for tests and fuzzing. \param name  of the file, for messages
[[nodiscard]] ShadeFile parse_shade_file(std::string_view bytes, const std::string& name);
[[nodiscard]] ArrivalsFile parse_arrivals_file(std::string_view bytes, const std::string& name);
[[nodiscard]] RayFile parse_ray_file(std::string_view bytes, const std::string& name);
[[nodiscard]] std::string shade_file_bytes(const ShadeFile& file);
[[nodiscard]] std::string arrivals_file_bytes(const ArrivalsFile& file);
[[nodiscard]] std::string ray_file_bytes(const RayFile& file);

/// Readers. \throws InputError that says file, line or byte, found and expected
[[nodiscard]] ShadeFile read_shade_file(const std::filesystem::path& path);
[[nodiscard]] ArrivalsFile read_arrivals_file(const std::filesystem::path& path);
[[nodiscard]] RayFile read_ray_file(const std::filesystem::path& path);

/// Writers. A path may have no file, or one of the kind. \throws InputError, RunError
void write_shade_file(const std::filesystem::path& path, const ShadeFile& file);
void write_arrivals_file(const std::filesystem::path& path, const ArrivalsFile& file);
void write_ray_file(const std::filesystem::path& path, const RayFile& file);
void write_shade_file(OutputFile&& output, const ShadeFile& file);
void write_arrivals_file(OutputFile&& output, const ArrivalsFile& file);
void write_ray_file(OutputFile&& output, const RayFile& file);

}  // namespace asdic::detail::bellhop
