#include "sonar/echoes/sparse_sound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "raytrace/ocean/absorption.h"
#include "sonar/echoes/leg_response.h"
#include "sonar/scenario/transmitter.h"
#include "sonar/signal/pulse_spectrum.h"
#include "sonar/synthesis/sound_synthesis.h"

namespace asdic::detail {
namespace {

/// Responses of the legs whose amplitudes depend on frequency by more than absorption, once for
/// each leg.
template <class Response>
class ChangingLegs {
 public:
  /// \param make  makes the response of a leg
  template <class Make>
  ChangingLegs(const PropagationPaths& paths, std::span<const EchoPath> echoes, const Make& make) {
    for (const EchoPath& echo : echoes)
      for (const PathOnLeg& on : echo.legs)
        if (const auto [at, is_new] = legs_.try_emplace(on.leg.get()); is_new)
          if (changes_with_frequency(paths, *on.leg)) at->second = make(*on.leg);
  }

  /// Response of a leg; null if only absorption changes it.
  [[nodiscard]] const Response* of(const PathOnLeg& on) const {
    const std::optional<Response>& found = legs_.at(on.leg.get());
    return found ? &*found : nullptr;
  }

 private:
  std::unordered_map<const MetLeg*, std::optional<Response>> legs_;
};

/// Ratio of a path's amplitude at another frequency to that at the centre.   \param legs
/// amplitudes of each leg's paths
std::complex<double> response_of(const EchoPath& path, const BandPart& part,
                                 std::span<const std::span<const std::complex<double>>> legs) {
  double by_rays = path.response.path_length;  // length of legs by rays [m]
  std::complex<double> product = 1.0;
  for (std::size_t i = 0; i < path.legs.size(); ++i) {
    if (legs[i].empty()) continue;
    const Arrival& at_centre = path.legs[i].leg->paths[path.legs[i].path];
    if (path.legs[i].leg->by_waves()) by_rays -= at_centre.path_length;
    product *= at_centre.amplitude == 0.0 ? 0.0 : legs[i][path.legs[i].path] / at_centre.amplitude;
  }
  return product * std::exp(-part.more_nepers_per_metre * by_rays);
}

double nepers_per_metre(const EchoContext& context, double frequency) {
  const Absorption& water = context.paths.along_transect().environment().absorption;
  return absorption_db_per_km(water, frequency) / 1000.0 * std::numbers::ln10 / 20.0;
}

BeamPattern pattern_at(const EchoContext& context, const Transmitter& projector, double frequency) {
  const double c = context.paths.speed_at(context.geometry.source().position);
  return {projector, c / frequency, c, context.geometry.source_heading(), c / context.frequency};
}

BandPart band_part(const EchoContext& context, const Transmitter& projector, double frequency) {
  return {.frequency = frequency,
          .filter = {},
          .pattern = pattern_at(context, projector, frequency),
          .more_nepers_per_metre =
              nepers_per_metre(context, frequency) - nepers_per_metre(context, context.frequency)};
}

/// Frequencies that represent a pulse's band for given paths. docs/theory/synthesis.md, "Across the
/// band"
class WideBand {
 public:
  /// \param longest  path there and back [m]
  WideBand(const EchoContext& context, const Transmitter& projector,
           std::span<const EchoPath> paths, double longest, const Recording& recording,
           double max_doppler)
      : context_(context),
        projector_(projector),
        centre_(context.pulse->centre_frequency()),
        half_width_(
            std::min(response_half_band(*context.pulse),
                     Synthesizer(*context.pulse, recording, max_doppler, context.paths.memory())
                         .half_band())),
        legs_(context.paths, paths, [&](const MetLeg& leg) {
          return leg_response(context.paths, leg, centre_, half_width_);
        }) {
    // The number of nodes is that for absorption and the transmitter's pattern, plus the degree of
    // the legs.
    nepers_ = 0.5 * longest *
              std::abs(nepers_per_metre(context, centre_ + half_width_) -
                       nepers_per_metre(context, std::max(1.0, centre_ - half_width_)));
    // A leg that is faint beside another one of its target matters less.
    std::map<int, std::array<double, 2>> loudest;
    for (const EchoPath& path : paths)
      for (std::size_t i = 0; i < path.legs.size(); ++i)
        if (const SampledResponse* leg = legs_.of(path.legs[i]))
          loudest[path.target][i] = std::max(loudest[path.target][i], leg->energy());
    std::size_t degree = 0;
    std::unordered_map<const SampledResponse*, std::size_t> known;
    for (const EchoPath& path : paths) {
      std::size_t sum = 0;
      for (std::size_t i = 0; i < path.legs.size(); ++i)
        if (const SampledResponse* leg = legs_.of(path.legs[i])) {
          const auto [found, is_new] = known.try_emplace(leg);
          if (is_new) found->second = leg->degree(loudest[path.target][i]);
          const std::size_t own = found->second;
          sum += own;
          degrees_[i] = std::max(degrees_[i], own);
        }
      degree = std::max(degree, sum);
    }
    nodes_ = nodes_for(nepers_, longest_delay(), degree);
  }

  [[nodiscard]] const BandNodes& nodes() const noexcept { return nodes_; }
  [[nodiscard]] const Pulse& pulse() const noexcept { return *context_.pulse; }
  [[nodiscard]] BandPart part(std::size_t k) const { return part(nodes_, k); }
  /// Gives paths the amplitudes that they have in one part. \param paths  of those of the band
  void put_amplitudes(const BandPart& at, std::span<EchoPath> paths) const {
    std::unordered_map<const SampledResponse*, std::vector<std::complex<double>>> known;
    std::vector<std::span<const std::complex<double>>> of_path;
    for (EchoPath& path : paths) {
      of_path.clear();
      for (const PathOnLeg& on : path.legs) {
        const SampledResponse* leg = legs_.of(on);
        if (leg == nullptr) {
          of_path.emplace_back();
          continue;
        }
        const auto [found, is_new] = known.try_emplace(leg);
        if (is_new) found->second = leg->at(at.frequency);
        of_path.emplace_back(found->second);
      }
      path.received.amplitude = path.response.without_pattern *
                                at.pattern.towards(path.response.bearing, path.response.elevation) *
                                response_of(path, at, of_path);
    }
  }
  /// The largest amplitudes that paths have anywhere in the band. \return [paths]
  [[nodiscard]] std::vector<double> largest_amplitudes(std::span<const EchoPath> paths) const {
    constexpr std::size_t finer = 4;  // than the nodes
    const std::size_t count = nodes_.frequencies.size(), steps = finer * count;
    std::vector<EchoPath> at_node(paths.begin(), paths.end());
    std::vector<std::complex<double>> amplitudes(steps * paths.size());
    for (std::size_t k = 0; k < count; ++k) {
      put_amplitudes(part(k), at_node);
      for (std::size_t j = 0; j < steps; ++j) {
        const double beside = 2.0 * (double(j) + 0.5) / double(steps) - 1.0;
        const double basis = nodes_.basis(k, centre_ + beside * half_width_);
        for (std::size_t i = 0; i < paths.size(); ++i)
          amplitudes[j * paths.size() + i] += basis * at_node[i].received.amplitude;
      }
    }
    std::vector<double> largest(paths.size());
    for (std::size_t n = 0; n < amplitudes.size(); ++n)
      largest[n % paths.size()] = std::max(largest[n % paths.size()], std::abs(amplitudes[n]));
    return largest;
  }
  /// Parts for one leg by itself. \param leg  0: the way there, with the transmitter's pattern;
  /// 1: the way back
  [[nodiscard]] std::vector<BandPart> parts_of(std::size_t leg) const {
    const BandNodes nodes =
        nodes_for(0.5 * nepers_, leg == 0 ? longest_delay() : 0.0, degrees_[leg]);
    std::vector<BandPart> parts;
    for (std::size_t k = 0; k < nodes.frequencies.size(); ++k) parts.push_back(part(nodes, k));
    return parts;
  }

 private:
  [[nodiscard]] double longest_delay() const {
    return pattern_at(context_, projector_, centre_).longest_delay();
  }
  /// Nodes for absorption and a pattern, and as many more as the degree of the legs: of a row of
  /// numbers, so that the next ping asks for waves at the same frequencies.
  [[nodiscard]] BandNodes nodes_for(double nepers, double delay, std::size_t degree) const {
    const BandNodes nodes = band_nodes(centre_, half_width_, nepers, delay);
    if (degree == 0) return nodes;
    // Nodes for losses and pattern need be no more exact than the legs' if these have many, each of
    // which costs as much as the centre.
    constexpr std::size_t few = 16;
    const bool many = degree > few;
    const std::size_t step = many ? 4 : 8;
    const std::size_t least =
        degree +
        (many ? asdic::detail::nodes_for(nepers, pi * half_width_ * delay, ResponseError{}.few)
              : nodes.frequencies.size());
    return chebyshev_nodes(centre_, half_width_,
                           least <= step ? least : (least + step - 1) / step * step);
  }
  [[nodiscard]] BandPart part(const BandNodes& nodes, std::size_t k) const {
    BandPart part = band_part(context_, projector_, std::max(1.0, nodes.frequencies[k]));
    part.filter = [nodes, k, scale = 1.0 / nodes.product(k, nodes.frequencies[k])](double beside) {
      return scale * nodes.product(
                         k, nodes.centre + std::clamp(beside, -nodes.half_width, nodes.half_width));
    };
    return part;
  }

  const EchoContext& context_;
  const Transmitter& projector_;
  double centre_, half_width_;
  ChangingLegs<SampledResponse> legs_;
  double nepers_ = 0.0;                      // half of what losses change across the band
  std::array<std::size_t, 2> degrees_ = {};  // of the polynomials of either leg
  BandNodes nodes_;
};

/// Length of the longest path there and back [m].
double longest_of(std::span<const EchoPath> paths) {
  double longest = 0.0;
  for (const EchoPath& path : paths) longest = std::max(longest, path.response.path_length);
  return longest;
}

/// Adds what phones receive along paths, part by part of the band.
void add_sound(const WideBand& band, std::span<const EchoPath> paths, std::span<const Vec3> phones,
               const Recording& recording, double max_doppler, Baseband& sum) {
  std::vector<EchoPath> filtered(paths.begin(), paths.end());
  for (std::size_t k = 0; k < band.nodes().frequencies.size(); ++k) {
    const BandPart at = band.part(k);
    band.put_amplitudes(at, filtered);
    Baseband sound = narrow_band_sound(Synthesizer(band.pulse(), recording, max_doppler, at.filter),
                                       filtered, phones);
    if (sum.channels == 0)
      sum = std::move(sound);
    else
      std::transform(sound.values.begin(), sound.values.end(), sum.values.begin(),
                     sum.values.begin(), std::plus<>{});
  }
}

/// Paths whose sound is received with no more than a pulse's duration between them.
struct PathsTogether {
  double first, last;  // times between which they are received [s]
  std::vector<EchoPath> paths;
  double bound = 0.0;  // of the envelope of their sum [Pa]
};

/// Paths by the times at which they are received, in order. Times hold the edges of the band and
/// what reflections delay; there may be minutes between echoes of one ping.
std::vector<PathsTogether> paths_together(const Pulse& pulse, std::span<const EchoPath> paths) {
  const double edge = 2.0 / response_half_band(pulse);
  const auto begin_of = [&](const EchoPath& path) {
    return (path.curve ? path.curve->first_received() : path.received.delay) - edge;
  };
  const auto end_of = [&](const EchoPath& path) {
    const Return& received = path.received;
    return (path.curve ? path.curve->last_received()
                       : received.delay + pulse.duration() / received.doppler) +
           delay_of_response(pulse);
  };
  std::vector<const EchoPath*> sorted;
  for (const EchoPath& path : paths) sorted.push_back(&path);
  std::stable_sort(sorted.begin(), sorted.end(), [&](const EchoPath* a, const EchoPath* b) {
    return begin_of(*a) < begin_of(*b);
  });
  std::vector<PathsTogether> groups;
  for (const EchoPath* path : sorted) {
    const double begin = begin_of(*path), end = end_of(*path);
    if (groups.empty() || begin > groups.back().last + pulse.duration())
      groups.push_back({.first = begin, .last = end, .paths = {}});
    groups.back().last = std::max(groups.back().last, end);
    groups.back().paths.push_back(*path);
  }
  return groups;
}

}  // namespace

TwoStepBand two_step_band(const EchoContext& context, const Transmitter& projector,
                          std::span<const EchoPath> paths, double longest,
                          const Recording& recording, double max_doppler) {
  const WideBand band(context, projector, paths, longest, recording, max_doppler);
  return {.out = band.parts_of(0), .home = band.parts_of(1)};
}

Baseband narrow_band_sound(const Synthesizer& synthesizer, std::span<const EchoPath> paths,
                           std::span<const Vec3> phones) {
  Returns straight;
  std::vector<CurvedReturn> curved;
  for (const EchoPath& path : paths)
    if (path.curve)
      curved.push_back({path.received, *path.curve});
    else
      straight.push_back(path.received);
  // A part of a record may hold no echo; transforms of nothing would take time as well.
  Baseband sound = straight.empty() ? synthesizer.silence(phones.size())
                                    : synthesizer.baseband(straight, phones);
  synthesizer.add_curved(curved, phones, sound);
  return sound;
}

double change_across_band(const EchoContext& context, const Transmitter& projector,
                          std::span<const EchoPath> paths, double half_width) {
  using Amplitudes = std::vector<std::complex<double>>;
  double most = 0.0;
  for (const double f :
       {std::max(1.0, context.frequency - half_width), context.frequency + half_width}) {
    const BandPart at = band_part(context, projector, f);
    const ChangingLegs<Amplitudes> legs(context.paths, paths, [&](const MetLeg& leg) {
      const bool still = leg.by_waves() && too_narrow_to_change(leg, half_width, tolerable_change);
      return still ? Amplitudes() : amplitudes_at(context.paths, leg, f);
    });
    double energy = 0.0, changed = 0.0;
    std::vector<std::span<const std::complex<double>>> of_path;
    for (const EchoPath& path : paths) {
      of_path.clear();
      for (const PathOnLeg& on : path.legs) {
        const Amplitudes* found = legs.of(on);
        of_path.push_back(found != nullptr ? std::span(*found)
                                           : std::span<const std::complex<double>>());
      }
      const std::complex<double> there =
          path.response.without_pattern *
          at.pattern.towards(path.response.bearing, path.response.elevation) *
          response_of(path, at, of_path);
      energy += std::norm(path.received.amplitude);
      changed += std::norm(there - path.received.amplitude);
    }
    if (energy > 0.0) most = std::max(most, std::sqrt(changed / energy));
  }
  return most;
}

bool across_the_band(const EchoContext& context, const Transmitter& projector,
                     std::span<const EchoPath> paths) {
  const BandOfLosses band = context.scenario().propagation.band;
  if (band != BandOfLosses::automatic) return band == BandOfLosses::wide;
  return change_across_band(context, projector, paths, 0.5 * context.pulse->bandwidth_99()) >
         tolerable_change;
}

SparseSound by_band(const EchoContext& context, const Transmitter& projector,
                    std::vector<EchoPath> paths) {
  std::stable_sort(paths.begin(), paths.end(),
                   [](const EchoPath& a, const EchoPath& b) { return a.target < b.target; });
  SparseSound sorted;
  for (auto first = paths.begin(), last = first; first != paths.end(); first = last) {
    last = std::find_if(first, paths.end(),
                        [&](const EchoPath& path) { return path.target != first->target; });
    std::vector<EchoPath>& into =
        across_the_band(context, projector, {first, last}) ? sorted.wide : sorted.narrow;
    into.insert(into.end(), std::make_move_iterator(first), std::make_move_iterator(last));
  }
  return sorted;
}

Baseband wide_band_sound(const EchoContext& context, const Transmitter& projector,
                         std::span<const EchoPath> paths, std::span<const Vec3> phones,
                         const Recording& recording, double max_doppler, Baseband more) {
  const WideBand band(context, projector, paths, longest_of(paths), recording, max_doppler);
  add_sound(band, paths, phones, recording, max_doppler, more);
  return more;
}

double peak_of_wide_band(const EchoContext& context, const Transmitter& projector,
                         std::span<const EchoPath> paths, const Recording& recording,
                         double max_doppler) {
  const Pulse& pulse = *context.pulse;
  std::vector<PathsTogether> groups = paths_together(pulse, paths);
  if (groups.empty()) return 0.0;
  const double start = groups.front().first;
  const WideBand band(context, projector, paths, longest_of(paths), recording, max_doppler);
  if (groups.size() > 1) {
    // |∫C(ν)·H(ν)·e^{i2πνt}dν| is at most max|H|·∫|C|dν.
    const PulseSpectrum spectrum = pulse_spectrum(pulse, context.frequency);
    double sum = 0.0;
    for (const std::complex<double> bin : spectrum.bins) sum += spectrum.bin_width * std::abs(bin);
    for (PathsTogether& group : groups)
      for (const double most : band.largest_amplitudes(group.paths)) group.bound += sum * most;
    std::stable_sort(
        groups.begin(), groups.end(),
        [](const PathsTogether& a, const PathsTogether& b) { return a.bound > b.bound; });
  }
  const std::vector<Vec3> reference_point = {Vec3::Zero()};
  double peak = 0.0;
  for (const PathsTogether& group : groups) {
    if (groups.size() > 1 && group.bound <= peak) break;
    Recording around = recording;  // its samples are those of one recording of all
    around.start =
        start + std::floor((group.first - start) * around.sample_rate) / around.sample_rate;
    around.samples =
        static_cast<std::size_t>(std::ceil((group.last - around.start) * around.sample_rate)) + 1;
    Baseband sound;
    add_sound(band, group.paths, reference_point, around, max_doppler, sound);
    peak = std::max(peak, largest_envelope(sound, 0));
  }
  return peak;
}

}  // namespace asdic::detail
