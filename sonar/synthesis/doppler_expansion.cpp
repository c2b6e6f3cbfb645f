#include "sonar/synthesis/doppler_expansion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/units.h"

namespace asdic::detail {
namespace {

constexpr double expansion_error = 3e-5;  // of the pulse's peak, −90 dB

/// Σ_{n≥N}|J_n(z)| for N = 0…, until it is negligible: Miller's downward recurrence.
std::vector<double> bessel_tails(double z) {
  const auto top = static_cast<std::size_t>(z + 8.0 * std::cbrt(z) + 24.0);
  std::vector<double> j(top + 2, 0.0);
  j[top] = 1e-30;
  for (std::size_t n = top; n > 0; --n) {
    j[n - 1] = 2.0 * static_cast<double>(n) / z * j[n] - j[n + 1];
    if (std::abs(j[n - 1]) > 1e100)
      for (std::size_t i = n - 1; i <= top; ++i) j[i] *= 1e-100;
  }
  double norm = j[0];  // J₀ + 2ΣJ₂ₖ = 1
  for (std::size_t n = 2; n <= top; n += 2) norm += 2.0 * j[n];
  double tail = 0.0;
  for (std::size_t n = top + 1; n-- > 0;) {
    tail += std::abs(j[n] / norm);
    j[n] = tail;
  }
  return j;
}

DopplerBand chebyshev_band(double lowest, double highest, std::size_t count) {
  DopplerBand band{
      .lowest = lowest, .highest = highest, .nodes = {}, .barycentric = {}, .ridge = 0.0};
  for (std::size_t i = 0; i < count; ++i) {
    const double theta = pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    band.nodes.push_back(0.5 * (lowest + highest) - 0.5 * (highest - lowest) * std::cos(theta));
    band.barycentric.push_back(i % 2 == 0 ? std::sin(theta) : -std::sin(theta));
  }
  if (count == 1 && lowest == highest) band.nodes[0] = lowest;
  return band;
}

}  // namespace

void DopplerBand::weights(double doppler, std::span<float> weights) const noexcept {
  if (nodes.size() == 1) {
    weights[0] = 1.0F;
    return;
  }
  // q_m = b_m/(η − η_m), ℓ_m = q_m/Σq. On a node its q is so large that no other counts.
  constexpr double on_node = 1e-15;
  const auto share = [&](std::size_t m) {
    const double distance = doppler - nodes[m];
    return barycentric[m] / (std::abs(distance) < on_node ? on_node : distance);
  };
  constexpr std::size_t lanes = 8;
  std::array<double, lanes> sums{}, q;
  std::size_t m = 0;
  for (; m + lanes <= nodes.size(); m += lanes) {
    for (std::size_t j = 0; j < lanes; ++j) q[j] = share(m + j);
    for (std::size_t j = 0; j < lanes; ++j) sums[j] += q[j];
    for (std::size_t j = 0; j < lanes; ++j) weights[m + j] = static_cast<float>(q[j]);
  }
  double sum = 0.0;
  for (; m < nodes.size(); ++m) {
    const double rest = share(m);
    sum += rest;
    weights[m] = static_cast<float>(rest);
  }
  for (const double s : sums) sum += s;
  const auto scale = static_cast<float>(1.0 / sum);
  for (float& w : weights) w *= scale;
}

DopplerExpansion::DopplerExpansion(const BandLimitedPulse& pulse)
    : highest_frequency_(pulse.centre_frequency() + pulse.half_band()) {
  constexpr int points = 128, fine = 8;
  for (int i = 0; i < points; ++i) {
    double amplitude = 0.0;  // the most in this segment, on either side
    for (int k = 0; k <= fine; ++k) {
      const double u = pulse.half_duration() * (i + k / double(fine)) / points;
      amplitude = std::max({amplitude, std::abs(pulse.at(u)), std::abs(pulse.at(-u))});
    }
    envelope_.push_back({pulse.half_duration() * (i + 1.0) / points, amplitude});
  }
}

std::size_t DopplerExpansion::nodes_needed(double span) const {
  std::size_t count = 1;
  std::vector<double> tails;  // of the latest z that was looked at
  double latest = infinity;
  for (auto point = envelope_.rbegin(); point != envelope_.rend(); ++point) {
    const auto& [time, amplitude] = *point;
    const double z = pi * highest_frequency_ * span * time;  // 2πf·(span/2)·u
    if (z < 1e-9) break;
    if (amplitude < 0.25 * expansion_error) continue;
    const auto too_few = [&, share = 4.0 * amplitude] {
      return count < tails.size() && share * tails[count] > expansion_error;
    };
    // |J_n(z)| grows with z up to n: what is enough for a later part is enough for this one.
    if (static_cast<double>(count) >= latest && !too_few()) continue;
    tails = bessel_tails(z);
    latest = z;
    while (too_few()) ++count;
  }
  return count;
}

std::vector<DopplerBand> DopplerExpansion::bands(std::vector<double> dopplers) const {
  std::sort(dopplers.begin(), dopplers.end());
  dopplers.erase(std::unique(dopplers.begin(), dopplers.end()), dopplers.end());
  std::vector<DopplerBand> found;
  if (dopplers.empty()) return found;

  struct Segment {
    std::size_t first, last, cost;  // of `dopplers`, both inclusive
  };
  const auto segment = [&](std::size_t first, std::size_t last) {
    return Segment{first, last, nodes_needed(dopplers[last] - dopplers[first])};
  };
  std::vector<Segment> open = {segment(0, dopplers.size() - 1)};
  while (!open.empty()) {
    const Segment s = open.back();
    open.pop_back();
    const std::size_t distinct = s.last - s.first + 1;
    if (distinct <= s.cost) {  // a pass for each is no dearer
      for (std::size_t i = s.first; i <= s.last; ++i)
        found.push_back(chebyshev_band(dopplers[i], dopplers[i], 1));
      continue;
    }
    // Split at the widest gap if that is cheaper.
    std::size_t cut = s.first;
    for (std::size_t i = s.first; i < s.last; ++i)
      if (dopplers[i + 1] - dopplers[i] > dopplers[cut + 1] - dopplers[cut]) cut = i;
    if (s.cost > 1) {
      const Segment left = segment(s.first, cut), right = segment(cut + 1, s.last);
      if (left.cost + right.cost < s.cost) {
        open.insert(open.end(), {right, left});
        continue;
      }
    }
    found.push_back(chebyshev_band(dopplers[s.first], dopplers[s.last], s.cost));
  }
  return found;
}

std::vector<DopplerBand> DopplerExpansion::bands_over(std::vector<DopplerSpan> spans) const {
  std::sort(spans.begin(), spans.end(),
            [](const DopplerSpan& a, const DopplerSpan& b) { return a.lowest < b.lowest; });
  std::vector<DopplerBand> found;
  for (std::size_t i = 0; i < spans.size();) {
    DopplerSpan joined = spans[i];
    std::size_t cost = nodes_needed(joined.highest - joined.lowest);
    for (++i; i < spans.size(); ++i) {  // the next too, if one band for both is no dearer
      const DopplerSpan& next = spans[i];
      const double highest = std::max(joined.highest, next.highest);
      const std::size_t both = nodes_needed(highest - joined.lowest);
      if (next.lowest > joined.highest && both > cost + nodes_needed(next.highest - next.lowest))
        break;
      joined.highest = highest;
      cost = both;
    }
    found.push_back(chebyshev_band(joined.lowest, joined.highest, cost));
  }
  return found;
}

std::vector<DopplerBand> DopplerExpansion::cut(std::vector<DopplerBand> bands, double returns,
                                               double grid_cost, const DopplerRidge* ridge) const {
  struct Way {
    std::size_t parts, each;  // nodes of each
    double ridge;             // along which impulses are moved [s]
  };
  std::vector<DopplerBand> narrower;
  for (DopplerBand& band : bands) {
    constexpr std::size_t few = 4;  // nodes
    const double span = band.highest - band.lowest;
    Way best = {.parts = 1, .each = band.nodes.size(), .ridge = 0.0};
    double least = static_cast<double>(best.each) * (returns + grid_cost);
    const auto attempt = [&](const Way& way) {
      const double cost =
          static_cast<double>(way.each) * (returns + static_cast<double>(way.parts) * grid_cost);
      if (cost >= least) return;
      least = cost;
      best = way;
    };
    for (const std::size_t parts : {1U, 2U, 3U, 4U, 6U, 8U, 12U, 16U}) {
      if (band.nodes.size() <= few) break;
      const double width = span / static_cast<double>(parts);
      if (parts > 1) attempt({.parts = parts, .each = nodes_needed(width), .ridge = 0.0});
      if (ridge == nullptr) continue;
      const std::size_t each = ridge->nodes_needed(width);
      if (each < DopplerRidge::too_many)
        attempt({.parts = parts, .each = each, .ridge = ridge->slope()});
    }
    if (best.parts == 1 && best.ridge == 0.0) {
      narrower.push_back(std::move(band));
      continue;
    }
    const auto edge = [&](std::size_t i) {
      return i == best.parts
                 ? band.highest
                 : band.lowest + span * static_cast<double>(i) / static_cast<double>(best.parts);
    };
    for (std::size_t i = 0; i < best.parts; ++i) {
      narrower.push_back(chebyshev_band(edge(i), edge(i + 1), best.each));
      narrower.back().ridge = best.ridge;
    }
  }
  return narrower;
}

}  // namespace asdic::detail
