#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/bellhop/attenuation.h"
#include "io/bellhop/case_reader.h"
#include "io/bellhop/list_reader.h"

/// The parts of a case as they are read one after another; for case_reader.cpp alone.
namespace asdic::detail::bellhop {

/// A row of the profile, a half space, a node of a long boundary file: values left out are those of
/// the row before, whatever it was for.
struct MaterialRow {
  double depth = 0.0;        ///< [m]
  double speed = 1500.0;     ///< [m/s]
  double shear_speed = 0.0;  ///< [m/s]
  double density = 1.0;      ///< [g/cm³]
  double attenuation = 0.0;  ///< [unit of the case]
  double shear_attenuation = 0.0;
};

/// The letters of the two lines of options.
struct CaseOptions {
  char profile = 'C', surface = 'V', bottom = 'V', volume = ' ';
  AttenuationUnit unit = AttenuationUnit::db_per_wavelength;
  bool altimetry = false, bathymetry = false, single_beam = false;
};

/// A case that is being read.
struct CaseReading {
  ListReader env;
  std::string root;
  const Texts& texts;
  CaseOptions options;
  MaterialRow row;                ///< the last one read
  std::string row_of;             ///< what that was for: "the profile"; empty: none was read
  double volume_loss = 0.0;       ///< [Np/m] at the case's frequency, without biology
  double surface_depth = 0.0;     ///< first depth of the profile [m]
  double bottom_depth = 0.0;      ///< DEPTH [m]
  bool receivers_sorted = false;  ///< their depths or ranges do not stand in the file's order
  Input input;

  [[nodiscard]] PropagationCase& run_case() noexcept { return input.run_case; }
  [[nodiscard]] Environment& ocean() noexcept { return input.run_case.environment; }
  void note(std::string text) { input.notes.push_back(std::move(text)); }
  void leak(std::string text) {
    input.leaks.push_back(text);
    note(std::move(text));
  }

  /// A companion by extension. \throws InputError if it is not there, saying what it is wanted for
  [[nodiscard]] ListReader companion(const std::string& extension,
                                     const std::string& wanted_for) const;
};

// case_options.cpp
void read_head(CaseReading& reading);  ///< title, frequency, media, top options, volume loss
void read_bottom_options(CaseReading& reading);

// case_ocean.cpp
void read_profile(CaseReading& reading);  ///< with .ssp
/// A row for a purpose ("the profile"). Values left out that come from a row for another one, and
/// are not BELLHOP's initial ones, are noted.
void read_material_row(CaseReading& reading, ListReader& from, const std::string& purpose);
/// What is behind the surface or the bottom, by its option letter.
[[nodiscard]] BoundaryMaterial read_material(CaseReading& reading, char letter, bool surface);
/// \param volume_loss  added [Np/m]
[[nodiscard]] BoundaryMaterial half_space(const CaseReading& reading, const ListReader& from,
                                          const MaterialRow& row, AttenuationUnit unit,
                                          double volume_loss);

// case_companions.cpp
void read_section(CaseReading& reading, const std::vector<double>& depth,
                  const std::vector<double>& speed);
[[nodiscard]] BoundaryShape read_shape(CaseReading& reading, bool surface);
[[nodiscard]] ReflectionTable read_reflection_table(CaseReading& reading, bool surface);
[[nodiscard]] SourcePattern read_source_pattern(CaseReading& reading);

// case_run.cpp
void read_run(CaseReading& reading);  ///< run type, fan, step, box, Cerveny's lines

// case_map.cpp
/// Whether the lines from the bottom options on are those of BELLHOP3D: six vectors, where BELLHOP
/// has three. The reader stays where it is.
[[nodiscard]] bool is_over_map(const CaseReading& reading);
/// \throws InputError  profile H in a case of one plane
void require_profile_of_a_plane(const CaseReading& reading);
/// All from the bottom options on, with the files of the map.
void read_map_case(CaseReading& reading);
/// What the letters of a run over a map must not be.
void check_map_run(CaseReading& reading, const std::string& letters);

// grid_file.cpp
/// .bty, .ati or (a volume) .ssp of BELLHOP3D.
[[nodiscard]] GridFile read_grid_file(ListReader file, bool volume);

// case_vectors.cpp
void read_receivers(CaseReading& reading);  ///< sources, receivers

/// A vector as its READ gives it: all values, or the two ends, or one.
struct GivenVector {
  std::vector<double> values;  ///< as given
  std::int64_t count = 0;      ///< as announced
  std::string left = {};       ///< a number more that stands on its last line, and is dropped
  [[nodiscard]] bool are_ends() const noexcept { return values.size() == 2 && count > 2; }
};
/// Reads the values of a vector of `count`. \throws InputError if there are neither all, two nor
/// one
[[nodiscard]] GivenVector read_vector(ListReader& from, std::int64_t count,
                                      const std::string& field);
/// The values that are meant, ascending, in single precision as BELLHOP keeps depths and ranges.
/// \param sorted  becomes true if they were not ascending
[[nodiscard]] std::vector<double> single_precision(const GivenVector& given, float factor,
                                                   bool& sorted);

/// The input in words. case_echo.cpp
[[nodiscard]] std::string echo(const CaseReading& reading);

}  // namespace asdic::detail::bellhop
