#include "sonar/echoes/wave_response.h"

#include <algorithm>
#include <cmath>

#include "sonar/paths/moving_paths.h"
#include "sonar/scenario/carried.h"
#include "sonar/scenario/sampling.h"

namespace asdic::detail {
namespace {

/// Of paths that were found, the one that a path is, or that it has become.
const Arrival* become(const Arrivals& found, const Arrival& path, bool layered) {
  // There is one diffracted arrival, from wherever it comes.
  if (path.kind == ArrivalKind::diffracted)
    for (const Arrival& one : found)
      if (one.kind == ArrivalKind::diffracted) return &one;
  return same_path(found, path, layered);
}

/// The paths between two places at a frequency, among them what one is there: all of them, known or
/// not, but of a diffracted one itself.
Arrivals at_place(const PropagationPaths& paths, const Arrival& path, const Vec3& from,
                  const Vec3& to, double frequency, const PathLimits& limits) {
  if (path.kind != ArrivalKind::diffracted) return paths.find(from, to, frequency, limits);
  return paths.follow(std::span(&path, 1), from, to, frequency, limits);
}

}  // namespace

std::complex<double> SampledResponse::at(double frequency) const noexcept {
  std::complex<double> sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) sum += nodes.basis(k, frequency) * values[k];
  return sum;
}

SampledResponse sampled_response(double centre, double half_width, double error, std::size_t most,
                                 const std::function<std::complex<double>(double)>& response) {
  const auto place = [&](std::size_t k, std::size_t cells) {
    return centre - half_width * std::cos(pi * static_cast<double>(k) / static_cast<double>(cells));
  };
  SampledResponse known{.nodes = {centre, half_width, {}}, .values = {}};
  for (std::size_t k = 0; k <= 2; ++k) {
    known.nodes.frequencies.push_back(place(k, 2));
    known.values.push_back(response(known.nodes.frequencies.back()));
  }
  for (std::size_t cells = 4;; cells *= 2) {
    SampledResponse finer{.nodes = {centre, half_width, {}}, .values = {}};
    double worst = 0.0, greatest = 0.0;
    for (std::size_t k = 0; k <= cells; ++k) {
      const double f = place(k, cells);
      const bool before = k % 2 == 0;
      const std::complex<double> value = before ? known.values[k / 2] : response(f);
      if (!before) worst = std::max(worst, std::abs(value - known.at(f)));
      greatest = std::max(greatest, std::abs(value));
      finer.nodes.frequencies.push_back(f);
      finer.values.push_back(value);
    }
    finer.error = greatest > 0.0 ? worst / greatest : 0.0;
    known = std::move(finer);
    if (known.error <= error || 2 * cells + 1 > most) return known;
  }
}

std::complex<double> wave_response(const PropagationPaths& paths, const WaveLeg& leg,
                                   double frequency) {
  const double f = std::max(1.0, frequency);
  const Arrivals there = at_place(paths, leg.path, leg.from, leg.to, f, leg.limits);
  const Arrival* same = become(there, leg.path, paths.layered());
  if (same == nullptr) return 0.0;  // too faint there
  const double cycles = std::fmod(f * (same->delay - leg.path.delay), 1.0);
  return same->amplitude / leg.path.amplitude * std::polar(1.0, -2.0 * pi * cycles);
}

SampledResponse wave_response(const PropagationPaths& paths, const WaveLeg& leg, double centre,
                              double half_width) {
  return sampled_response(centre, half_width, wave_response_error, most_wave_frequencies,
                          [&](double f) { return wave_response(paths, leg, f); });
}

std::vector<WaveLeg> wave_legs(const EchoContext& context, const EchoPath& received,
                               std::span<const Leg> legs) {
  const PingGeometry& geometry = context.geometry;
  const int channel =
      received.received.channel == Return::all_channels ? -1 : received.received.channel;
  const Vec3 source = geometry.source().position,
             phone = geometry.receiver(received.array, channel)
                         .at(geometry.time() + received.received.delay)
                         .position;
  std::vector<WaveLeg> waves;
  const auto add = [&](const Vec3& from, const Vec3& to, const Leg& leg, const Arrival& path) {
    if (path.kind == ArrivalKind::ray) return;
    // A wave's amplitude is that of all rays of its term, which bounce once more at most.
    int bounces = 0;
    for (const Arrival& a : leg.arrivals)
      bounces = std::max({bounces, a.surface_bounces, a.bottom_bounces});
    const PathLimits limits = limits_of(context.scenario().propagation, bounces + 2);
    const Arrivals there = at_place(context.paths, path, from, to, context.frequency, limits);
    if (const Arrival* met = become(there, path, context.paths.layered()))
      if (met->kind != ArrivalKind::ray)
        waves.push_back({.from = from, .to = to, .path = *met, .limits = limits});
  };
  const auto leg_of = [&](Leg::Kind kind) {
    return std::find_if(legs.begin(), legs.end(), [&](const Leg& leg) {
      return leg.kind == kind && leg.target == received.target &&
             (kind == Leg::Kind::source_to_target ||
              (leg.array == received.array && (leg.channel == channel || leg.channel < 0)));
    });
  };
  if (received.target < 0) {  // the blast tells of itself by its angle and length
    const auto leg = leg_of(Leg::Kind::source_to_array);
    if (leg == legs.end()) return waves;
    const auto off = [&](const Arrival& a) {
      return std::abs(a.launch_elevation - received.response.elevation) +
             std::abs(a.path_length / received.response.path_length - 1.0);
    };
    const auto path =
        std::min_element(leg->arrivals.begin(), leg->arrivals.end(),
                         [&](const Arrival& a, const Arrival& b) { return off(a) < off(b); });
    if (path != leg->arrivals.end()) add(source, phone, *leg, *path);
    return waves;
  }
  const Vec3 target = geometry.target_at(received.target, received.struck).position;
  const auto out = leg_of(Leg::Kind::source_to_target), home = leg_of(Leg::Kind::target_to_array);
  const auto has = [&](auto leg, int path) {
    return leg != legs.end() && static_cast<std::size_t>(path) < leg->arrivals.size();
  };
  if (has(out, received.outgoing))
    add(source, target, *out, out->arrivals[static_cast<std::size_t>(received.outgoing)]);
  if (has(home, received.returning))
    add(target, phone, *home, home->arrivals[static_cast<std::size_t>(received.returning)]);
  return waves;
}

}  // namespace asdic::detail
