#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/random.h"
#include "raytrace/paths/boundary_paths.h"
#include "reverb/fields/reverberation_settings.h"
#include "reverb/pairs/scattering_sheet.h"

namespace asdic::detail {

/// A boundary, or a sheet of a layer of the water: what scatters there, and how.
struct ScatteringPart {
  GroundLevel level;
  ScatteringSheet::Laws law;
  ScattererField field;
  Draw weights = Draw::surface_weight;  ///< purpose of their draws
  std::uint64_t id = 0;                 ///< 0: the surface, 1: the bottom, then the sheets
  double thickness = 0.0;               ///< of a sheet [m]
};

/// Where sound leaves and is received, near which layers are cut into thinner sheets.
struct LayerEnds {
  std::vector<double> depths = {};  ///< none: far from all layers [m]
  double finest = 1.0;              ///< thickness of a sheet, at least [m]
};

/// Thicknesses of the sheets of a layer from its top down [m]. A sheet has the amplitude of its
/// middle. It is no thicker than 50 m, nor than 0.115 of its distance from the nearest end, where
/// spreading over its half makes 0.5 dB of a narrow beam (20·lg 1.0575); the one at the edge that
/// faces the ends, which is received alone for a while, is half of that (40·lg 1.029).
[[nodiscard]] std::vector<double> sheets_of(const VolumeLayer& layer, const LayerEnds& ends);

/// All that scatters. \param sound_speed  at the surface [m/s]   \param winds  kinds that there are
/// where wind is mapped (wind_kind())
[[nodiscard]] std::vector<ScatteringPart> scattering_parts(const ReverberationSettings& settings,
                                                           double wind_speed, double sound_speed,
                                                           std::span<const int> winds = {},
                                                           const LayerEnds& ends = {});

/// Moves a sheet aside that lies at the very depth of a platform: only paths along it would reach
/// it. \param depth  of the platform [m]
void move_aside(ScatteringPart& part, double depth) noexcept;

}  // namespace asdic::detail
