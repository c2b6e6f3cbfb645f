#include "processing/threshold_probes.h"

#include <cmath>

#include "raytrace/propagation.h"

namespace asdic::detail {

std::vector<PlacedProbe> place_probes(std::span<const Probe> probes, const MatchedFilterBank& bank,
                                      double doppler_cell, const BeamGrid& grid,
                                      std::span<const Vec3> phones, std::span<const double> weights,
                                      double wavenumber) {
  std::vector<PlacedProbe> all;
  const double last = static_cast<double>(bank.samples()) - 1.0;
  const double step = bank.filters() > 1 ? bank.doppler(1) - bank.doppler(0) : 0.0;
  for (const Probe& probe : probes) {
    PlacedProbe placed;
    const double sample = std::round((probe.time - bank.time(0.0)) * bank.sample_rate());
    placed.inside = sample >= 0.0 && sample <= last;
    if (placed.inside) placed.sample = static_cast<std::size_t>(sample);
    double most = -1.0, least = infinity;
    for (std::size_t b = 0; b < grid.looks.size(); ++b) {
      const double received = beam_pattern(phones, weights, grid.looks[b], probe.look, wavenumber);
      if (received > most) most = received, placed.beam = b;
    }
    for (std::size_t f = 0; f < bank.filters(); ++f)
      if (const double off = std::abs(bank.doppler(f) - probe.doppler); off < least)
        least = off, placed.filter = f;
    // Beyond the bank's last filter as far as that still answers.
    placed.inside = placed.inside && least <= 0.5 * step + doppler_cell;
    all.push_back(placed);
  }
  return all;
}

}  // namespace asdic::detail
