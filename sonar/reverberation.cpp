#include "sonar/reverberation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/random.h"
#include "sonar/doppler.h"
#include "sonar/geometry.h"

namespace asdic {

namespace {

/// Indices of the patches that matter, in their order: in every stretch of delay a quarter of a
/// pulse long the weakest are left out as long as all that is left out there stays 50 dB below the
/// stretch's power.
std::vector<std::uint32_t> audible(std::span<const Patch> patches, const BeamPattern& pattern,
                                   double pulse_duration) {
  constexpr double left_out = 1e-5;
  struct Entry {
    std::uint32_t stretch, index;
    double power;
  };
  std::vector<Entry> entries(patches.size());
  const double length = 0.25 * pulse_duration;
  for (std::size_t i = 0; i < patches.size(); ++i)
    entries[i] = {static_cast<std::uint32_t>(patches[i].delay / length),
                  static_cast<std::uint32_t>(i),
                  std::norm(patches[i].amplitude * pattern(patches[i].launch_elevation))};
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.stretch, a.power, a.index) < std::tie(b.stretch, b.power, b.index);
  });
  std::vector<std::uint32_t> kept;
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end) {
    double total = 0.0;
    for (end = begin; end < entries.size() && entries[end].stretch == entries[begin].stretch; ++end)
      total += entries[end].power;
    double dropped = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      dropped += entries[i].power;
      if (dropped > left_out * total) kept.push_back(entries[i].index);
    }
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

/// The returns of the patches that some sectors share.
void add_returns(const ReverberationContext& context, std::span<const Patch> patches,
                 std::span<const int> sectors, Returns& returns) {
  const int azimuths = context.scenario.reverberation.azimuths;
  const std::vector<std::uint32_t> kept =
      audible(patches, context.pattern, context.scenario.pulse.duration);
  returns.reserve(returns.size() + kept.size() * sectors.size());
  std::vector<std::complex<double>> weights(sectors.size());
  std::vector<double> bearings;
  std::vector<Vec3> towards;  // of every sector, from the platform, horizontal
  for (const int k : sectors) {
    bearings.push_back(context.first_bearing + 2.0 * pi * (k + 0.5) / azimuths);
    towards.push_back(direction(bearings.back(), 0.0));
  }
  const double share =
      1.0 / std::sqrt(double(azimuths));  // of the ring's amplitude in a sector of its area
  const bool moving = !context.platform.velocity.isZero();
  std::uint32_t weighted_cell = 0;
  bool has_weights = false;
  for (const std::uint32_t index : kept) {
    const Patch& patch = patches[index];
    if (!has_weights || patch.cell != weighted_cell) {
      for (std::size_t i = 0; i < sectors.size(); ++i) {
        const std::uint64_t sector =
            std::uint64_t{patch.cell} << 20 | static_cast<std::uint64_t>(sectors[i]);
        weights[i] =
            share * RandomStream(context.scenario.seed, Draw::surface_weight, context.ping, sector)
                        .complex_normal();
      }
      weighted_cell = patch.cell;
      has_weights = true;
    }
    const std::complex<double> amplitude =
        patch.amplitude * context.pattern(patch.launch_elevation);
    const double level = std::cos(patch.return_elevation) /
                         context.sound_speed;  // horizontal and vertical slowness of the
    const double down =
        std::sin(patch.return_elevation) / context.sound_speed;  // sound that comes back
    for (std::size_t sector = 0; sector < sectors.size(); ++sector) {
      const Vec3 arriving(-level * towards[sector].x(), -level * towards[sector].y(), down);
      double doppler = 1.0;
      if (moving) {  // the scatterer stands still
        const Vec3 leaving =
            direction(bearings[sector], patch.launch_elevation) / context.sound_speed;
        doppler = leg_doppler({context.platform.velocity, leaving}, {}) *
                  leg_doppler({}, {context.platform.velocity, arriving});
      }
      returns.push_back({.delay = patch.delay,
                         .amplitude = amplitude * weights[sector],
                         .doppler = doppler,
                         .slowness = arriving});
    }
  }
}

/// The power of the whole ring heard at a time, were it all like these patches.
double expected_power(const ReverberationContext& context, std::span<const Patch> patches,
                      const Pulse& pulse, double t) {
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
  return power;
}

/// The part of every ring that a piece stands for.
double share_of(const ReverberationContext& context, const SectorPatches& piece) {
  return double(piece.sectors.size()) / context.scenario.reverberation.azimuths;
}

}  // namespace

Returns reverberation_returns(const ReverberationContext& context,
                              std::span<const SectorPatches> pieces) {
  Returns returns;
  for (const SectorPatches& piece : pieces)
    add_returns(context, piece.patches, piece.sectors, returns);
  return returns;
}

Returns reverberation_returns(const ReverberationContext& context, std::span<const Patch> patches) {
  std::vector<int> sectors(static_cast<std::size_t>(context.scenario.reverberation.azimuths));
  std::iota(sectors.begin(), sectors.end(), 0);
  Returns returns;
  add_returns(context, patches, sectors, returns);
  return returns;
}

double expected_reverberation_db(const ReverberationContext& context,
                                 std::span<const SectorPatches> pieces, const Pulse& pulse,
                                 double t) {
  double power = 0.0;
  for (const SectorPatches& piece : pieces)
    power += share_of(context, piece) * expected_power(context, piece.patches, pulse, t);
  return context.scenario.transmitters[0].source_level_db + db_from_power(power);
}

PatchRows patch_rows(const ReverberationContext& context, std::span<const SectorPatches> pieces,
                     std::size_t most) {
  PatchRows result;
  std::size_t all = 0;
  for (const SectorPatches& piece : pieces) all += piece.patches.size();
  if (all == 0) return result;
  result.every = static_cast<int>((all + most - 1) / most);
  const int azimuths = context.scenario.reverberation.azimuths;
  for (const SectorPatches& piece : pieces) {
    const double share = share_of(context, piece);
    const double bearing =
        share == 1.0 ? std::nan("")
                     : context.first_bearing + 2.0 * pi * (piece.sectors[0] + 0.5) / azimuths;
    for (const Patch& patch : piece.patches) {
      if (patch.cell % static_cast<std::uint32_t>(result.every) != 0 || result.rows.size() == most)
        continue;
      const double beamed = std::abs(patch.amplitude * context.pattern(patch.launch_elevation));
      result.rows.push_back({.bearing = bearing,
                             .range = patch.range,
                             .area = share * patch.area,
                             .delay = patch.delay,
                             .grazing_in = patch.grazing_in,
                             .grazing_out = patch.grazing_out,
                             .launch_elevation = patch.launch_elevation,
                             .arrival_elevation = -patch.return_elevation,
                             .scattering_strength_db = db_from_power(patch.cross_section),
                             .level_db = context.scenario.transmitters[0].source_level_db +
                                         db_from_amplitude(beamed) + db_from_power(share)});
    }
  }
  return result;
}

}  // namespace asdic
