#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/text/toml_table.h"
#include "raytrace/ocean/environment.h"

namespace asdic {

/// How it is called in a file.
[[nodiscard]] std::string_view name(Spreading spreading) noexcept;

/// The parts of [environment] (docs/formats/scenario.md), one function per table.
namespace scenario {

/// What the reading of an ocean needs to know besides its tables.
struct OceanReading {
  std::filesystem::path folder;     ///< that file names are relative to
  double frequency = 0.0;           ///< for attenuations per metre [Hz]
  std::vector<std::string>& notes;  ///< grows by what the user should know
};

/// `kind` and its keys. \param water  beside it, which grain sizes refer to
/// \param fallback  the kind where none is given; none: it is required
[[nodiscard]] BoundaryMaterial read_material(TomlTable& table, const OceanReading& reading,
                                             const WaterAtBoundary& water,
                                             std::optional<std::string> fallback);

/// Where a boundary is, of [environment.surface] or [environment.bottom]: `depth`, or `shape`.
[[nodiscard]] Boundary read_boundary_place(TomlTable& table, const OceanReading& reading,
                                           bool surface);
/// What is behind it, when its place and the water are known.
void read_boundary_materials(TomlTable& table, const OceanReading& reading,
                             const Environment& ocean, std::optional<std::string> fallback,
                             Boundary& boundary);

/// `kind` and its keys: a profile, or a section. The boundaries are in their places already.
void read_sound_speed(TomlTable table, const OceanReading& reading, Environment& ocean);

/// [environment.absorption], [[environment.biology]], [environment.attenuation], water_density.
void read_water_losses(TomlTable& table, const OceanReading& reading, Environment& ocean);

/// All of [environment] but what only a sonar needs (wind_speed, transect): the caller asks for
/// those keys, and finishes the table.
[[nodiscard]] Environment read_ocean(TomlTable& table, const OceanReading& reading);

}  // namespace scenario
}  // namespace asdic
