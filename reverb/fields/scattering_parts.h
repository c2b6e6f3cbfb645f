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

/// All that scatters. \param sound_speed  at the surface [m/s]   \param winds  kinds that there are
/// where wind is mapped (wind_kind())
[[nodiscard]] std::vector<ScatteringPart> scattering_parts(const ReverberationSettings& settings,
                                                           double wind_speed, double sound_speed,
                                                           std::span<const int> winds = {});

/// Moves a sheet aside that lies at the very depth of a platform: only paths along it would reach
/// it. \param depth  of the platform [m]
void move_aside(ScatteringPart& part, double depth) noexcept;

}  // namespace asdic::detail
