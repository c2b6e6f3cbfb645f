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

/// Depths at which sound leaves and is received. Layers are cut into thinner sheets near them.
struct LayerEnds {
  std::vector<double> depths = {};  ///< [m]; none: sheets of 50 m
  double finest = 1.0;              ///< least thickness of a sheet [m]
};

/// Thicknesses of the sheets of a layer from its top down [m]. All of a sheet has the amplitude of
/// its middle. So it is at most 50 m thick and at most 0.115 of its distance from the nearest end:
/// over half of that, spreading changes a narrow beam by 0.5 dB (20·lg 1.0575). The sheet at the
/// edge that faces the ends is received alone for a while and is half as thick (40·lg 1.029).
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
