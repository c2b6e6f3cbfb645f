#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/fields.h"
#include "io/text/toml_table.h"
#include "raytrace/area/ocean_on_map.h"
#include "raytrace/ocean/ocean_origin.h"

namespace asdic::detail {

// How they are called in a file.
inline constexpr std::string_view spreading_words[] = {"plane", "cylindrical"};
constexpr std::span<const std::string_view> words(Spreading) { return spreading_words; }
[[nodiscard]] std::span<const std::string_view> words(Interpolation);
[[nodiscard]] std::span<const std::string_view> words(ShapeInterpolation);

/// The parts of [environment] (docs/formats/scenario.md), one function per table.
namespace scenario {

class AreaReading;

/// What the reading of an ocean needs to know besides its tables.
struct OceanReading {
  std::filesystem::path folder;       ///< that file names are relative to
  double frequency = 0.0;             ///< for attenuations per metre [Hz]
  std::vector<std::string>& notes;    ///< grows by what the user should know
  const AreaReading* area = nullptr;  ///< none: depth and water are those of the tables
};

// The settings of each table are described once, in the .cpp of its reader: read_…() reads them
// and makes of them what they say, describe_…() shows to a walker that reads nothing what says it
// bit for bit.

/// `kind` and its keys. \param water  beside it, which grain sizes refer to
/// \param vacuum_unless_given  else the kind is required
[[nodiscard]] BoundaryMaterial read_material(TomlTable& table, const OceanReading& reading,
                                             const WaterAtBoundary& water,
                                             bool vacuum_unless_given);
/// \param kind  the key: it is not of all places that it is required
void describe_material(Fields& field, const BoundaryMaterial& material, SettingKey kind);

/// Where a boundary is, of [environment.surface] or [environment.bottom]: `depth`, or `shape`.
[[nodiscard]] Boundary read_boundary_place(TomlTable& table, const OceanReading& reading,
                                           bool surface);
/// What is behind it, when its place and the water are known.
void read_boundary_materials(TomlTable& table, const OceanReading& reading,
                             const Environment& ocean, bool surface, Boundary& boundary);
/// How rough it is. \param wind_speed  of the sea that "wind" asks for [m/s]
void read_roughness(TomlTable& table, double wind_speed, bool surface, Roughness& roughness);
/// \param by_map  where it is, an area says
void describe_boundary(Fields& field, bool surface, const Boundary& boundary, bool by_map = false);

/// `kind` and its keys: a profile, or a section. The boundaries are in their places already.
void read_sound_speed(TomlTable table, const OceanReading& reading, Environment& ocean);
void describe_sound_speed(Fields& field, const Environment& ocean);

/// water_density, of all walkers.
void describe_density(Fields& field, Environment& ocean);
/// [environment.absorption], [[environment.biology]], [environment.attenuation], of all walkers.
void describe_losses(Fields& field, Environment& ocean);

/// Of absorption alone, for a walker that does not read.
void describe_absorption(Fields& field, const Environment& ocean);

/// [environment] for a walker that does not read, without what only a sonar needs.
struct OceanTable {
  const Environment& ocean;
  bool depth_by_map = false, water_by_map = false;  ///< which an area says
  void describe(Fields& field) const;
};

/// The same of an area with its transect, for a walker that does not read.
void describe_ocean_on_area(Fields& field, const Area& area, const Transect& transect);

/// [environment.transect]
[[nodiscard]] Transect read_transect(TomlTable& table);
/// [environment.origin]; none: it is not said.
[[nodiscard]] std::optional<OceanOrigin> read_origin(TomlTable& table);
/// [environment.area], its files opened; none: there is none.
[[nodiscard]] std::optional<AreaReading> read_area(TomlTable& table, const OceanReading& reading,
                                                   const std::optional<OceanOrigin>& origin);

/// All of [environment] but what only a sonar needs (wind_speed, transect), origin and area: the
/// caller asks for those keys, and finishes the table.
[[nodiscard]] Environment read_ocean(TomlTable& table, const OceanReading& reading);

}  // namespace scenario
}  // namespace asdic::detail
