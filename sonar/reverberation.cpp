#include "sonar/reverberation.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "sonar/doppler.h"
#include "sonar/geometry.h"

namespace asdic {

Returns reverberation_returns(const ReverberationContext& context, std::span<const Patch> patches) {
  constexpr double faint = 1e-5;
  const int azimuths = context.scenario.reverberation.azimuths;
  std::vector<double> beamed(patches.size());  // |A·D|
  double strongest = 0.0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    beamed[i] = std::abs(patches[i].amplitude * context.pattern(patches[i].launch_elevation));
    strongest = std::max(strongest, beamed[i]);
  }

  Returns returns;
  returns.reserve(patches.size() * static_cast<std::size_t>(azimuths));
  std::vector<std::complex<double>> weights(static_cast<std::size_t>(azimuths));
  const double share =
      1.0 / std::sqrt(double(azimuths));  // of the ring's amplitude in a sector of its area
  const bool moving = !context.platform.velocity.isZero();
  std::uint32_t weighted_cell = 0;
  bool has_weights = false;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (beamed[i] <= faint * strongest) continue;
    const Patch& patch = patches[i];
    if (!has_weights || patch.cell != weighted_cell) {
      for (int k = 0; k < azimuths; ++k) {
        const std::uint64_t sector =
            std::uint64_t{patch.cell} << 20 | static_cast<std::uint64_t>(k);
        weights[static_cast<std::size_t>(k)] =
            share * RandomStream(context.scenario.seed, Draw::surface_weight, context.ping, sector)
                        .complex_normal();
      }
      weighted_cell = patch.cell;
      has_weights = true;
    }
    const std::complex<double> amplitude =
        patch.amplitude * context.pattern(patch.launch_elevation);
    for (int k = 0; k < azimuths; ++k) {
      const double bearing = 2.0 * pi * (k + 0.5) / azimuths;  // of the sector, from the platform
      const Vec3 arriving = -direction(bearing, patch.return_elevation) /
                            context.sound_speed;  // travels the other way
      double doppler = 1.0;
      if (moving) {  // the scatterer stands still
        const Vec3 leaving = direction(bearing, patch.launch_elevation) / context.sound_speed;
        doppler = leg_doppler({context.platform.velocity, leaving}, {}) *
                  leg_doppler({}, {context.platform.velocity, arriving});
      }
      returns.push_back({.delay = patch.delay,
                         .amplitude = amplitude * weights[static_cast<std::size_t>(k)],
                         .doppler = doppler,
                         .slowness = arriving});
    }
  }
  return returns;
}

double expected_reverberation_db(const ReverberationContext& context,
                                 std::span<const Patch> patches, const Pulse& pulse, double t) {
  double power = 0.0;
  std::complex<double> cell_sum = 0.0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Patch& patch = patches[i];
    const double since = t - patch.delay;
    if (since >= 0.0 && since <= pulse.duration())
      cell_sum += patch.amplitude * context.pattern(patch.launch_elevation) * pulse.analytic(since);
    if (i + 1 == patches.size() || patches[i + 1].cell != patch.cell) {
      power += std::norm(cell_sum);
      cell_sum = 0.0;
    }
  }
  return context.scenario.transmitter.source_level_db + db_from_power(power);
}

PatchRows patch_rows(const ReverberationContext& context, std::span<const Patch> patches,
                     std::size_t most) {
  PatchRows result;
  if (patches.empty()) return result;
  result.every = static_cast<int>((patches.size() + most - 1) / most);
  for (const Patch& patch : patches) {
    if (patch.cell % static_cast<std::uint32_t>(result.every) != 0 || result.rows.size() == most)
      continue;
    const double beamed = std::abs(patch.amplitude * context.pattern(patch.launch_elevation));
    result.rows.push_back(
        {.range = patch.range,
         .area = patch.area,
         .delay = patch.delay,
         .grazing_in = patch.grazing_in,
         .grazing_out = patch.grazing_out,
         .launch_elevation = patch.launch_elevation,
         .arrival_elevation = -patch.return_elevation,
         .scattering_strength_db = db_from_power(patch.cross_section),
         .level_db = context.scenario.transmitter.source_level_db + db_from_amplitude(beamed)});
  }
  return result;
}

}  // namespace asdic
