#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "raytrace/cases/propagation_case.h"

namespace asdic::detail::bellhop {

/// Depths or speeds on a grid of the map, as a file of BELLHOP3D has them. x east, y north.
struct GridFile {
  bool curvilinear = false;    ///< type C, not R
  std::vector<double> x, y;    ///< [≥ 2] increasing [m]
  std::vector<double> z;       ///< levels of a volume, increasing [m]; empty: a surface
  std::vector<double> values;  ///< [levels × y × x], x fastest [m] or [m/s]

  [[nodiscard]] bool operator==(const GridFile&) const = default;
};

/// What a case of BELLHOP3D has beside that of one plane. The map is x east, y north; azimuths are
/// the file's, in degrees counter-clockwise from x. docs/formats/bellhop3d.md
struct MapInput {
  std::vector<double> source_x = {0.0}, source_y = {0.0};  ///< [m]
  std::vector<double> azimuths_deg = {0.0};                ///< of the lines of receivers
  int fan = 0;  ///< beams in azimuth as written; 0: automatic
  double lowest_azimuth_deg = 0.0, highest_azimuth_deg = 360.0;  ///< of the fan
  double box_x = 0.0, box_y = 0.0;                       ///< to either side of the source [m]
  double profile_top = 0.0, profile_depth = 0.0;         ///< where the profile begins and ends [m]
  std::optional<GridFile> bathymetry, altimetry, water;  ///< the files
  std::shared_ptr<const Area> area;    ///< what they are; none: the same everywhere
  std::shared_ptr<const Area> relief;  ///< its sea floor is the surface; none: that is flat

  /// Places of sources × azimuths: x slowest, azimuth fastest.
  [[nodiscard]] std::size_t planes() const noexcept {
    return source_x.size() * source_y.size() * azimuths_deg.size();
  }
  [[nodiscard]] double azimuth_deg(std::size_t plane) const noexcept {
    return azimuths_deg[plane % azimuths_deg.size()];
  }
  /// Whether the fan has beams towards an azimuth: half a spacing of them is added at its ends.
  [[nodiscard]] bool shines_at(double azimuth_deg) const noexcept;
  [[nodiscard]] bool shines_all_around() const noexcept;
  [[nodiscard]] double margin_deg() const noexcept;  ///< half a spacing
};

/// A case as read, and what the reader did that the user should know (a source moved into the
/// water, a value left out and taken from the row before, letters that mean nothing …).
struct Input {
  PropagationCase run_case;
  bool binary_arrivals = false;
  std::vector<std::string> notes;
  /// Those of the notes that tell of values taken over from a line of another kind (of the ice into
  /// the water): they change the answer and are hardly ever meant.
  std::vector<std::string> leaks;
  std::string echo;             ///< the input in words, for the .prt file
  std::string file;             ///< "case.env"
  std::string fan_place;        ///< where the launch angles stand: "case.env:14: launch angles"
  std::optional<MapInput> map;  ///< of a case of BELLHOP3D; run_case is then its first plane
};

/// One plane of a case over a map: from a source along an azimuth, through the area in planes or in
/// three dimensions. Of a case without a map: itself.
[[nodiscard]] PropagationCase on_plane(const Input& input, std::size_t plane);

/// \throws InputError  it is over a map, and whoever asks knows one plane only
void require_one_plane(const Input& input);

/// A fault that a run found in a case, told of the file: "beams.highest" is the place of its launch
/// angles, all else gets the file's name.
[[nodiscard]] InputError told_of_file(const InputError& error, const Input& input);

/// Reads ROOT.env and the companions it names (.bty .ati .ssp .brc .trc .sbp), of BELLHOP or of
/// BELLHOP3D, which is told by its lines of sources and receivers. No letter of the file's options
/// gets past this function. docs/formats/bellhop.md, bellhop3d.md
/// \throws InputError "case.env:12: bottom half space, item 2" with what was found and expected
[[nodiscard]] Input read_case(const std::filesystem::path& root);

/// The same from text, for tests and fuzzing; companions are looked up by extension (".bty").
struct Texts {
  std::string env;
  std::vector<std::pair<std::string, std::string>> companions;
};
[[nodiscard]] Input read_case(const Texts& texts, const std::string& root_name);

}  // namespace asdic::detail::bellhop
