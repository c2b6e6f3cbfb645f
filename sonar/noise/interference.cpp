#include "sonar/noise/interference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "core/doppler.h"
#include "core/geometry.h"
#include "core/mixed_bits.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/noise/interference_segment.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/paths/enough_bounces.h"
#include "sonar/paths/moving_paths.h"
#include "sonar/paths/plane_wave.h"
#include "sonar/scenario/ping_bounds.h"
#include "sonar/scenario/sampling.h"
#include "sonar/signal/fractional_delay.h"

namespace asdic::detail {

// What a scenario's ships send, and the paths along which arrays receive it.

double source_density(const Interferer& ship, double frequency) noexcept {
  double level = -infinity;
  if (ship.table)
    level = ship.table->level_at(frequency);
  else if (ship.level_db)
    level =
        *ship.level_db + ship.slope_db_per_decade * std::log10(std::max(frequency, 100.0) / 1000.0);
  return power_from_db(level) * micropascal * micropascal;
}

namespace {

/// Frequencies between which amplitudes are straight: no path of 50 km changes by more than 0.3
/// neper from one to the next, so that in the middle it is right to 0.3²/8 = 0.1 dB.
std::vector<double> frequencies_of_losses(const Environment& ocean, double low, double high) {
  constexpr double longest = 50e3, straight = 0.3;
  constexpr int fewest = 3, most = 17;
  const double depth = 0.0;
  const double change = longest * (attenuation_np_per_m(ocean, high).at(depth) -
                                   attenuation_np_per_m(ocean, low).at(depth));
  const int segments = static_cast<int>(
      std::clamp(std::ceil(std::abs(change) / straight), double(fewest - 1), double(most - 1)));
  std::vector<double> all;
  for (int i = 0; i <= segments; ++i) all.push_back(low + (high - low) * i / segments);
  return all;
}

/// The share of a frequency that belongs to node k: 1 there, straight to 0 at its neighbours.
double hat(const std::vector<double>& nodes, std::size_t k, double f) {
  if (k > 0 && f < nodes[k]) return std::max(0.0, (f - nodes[k - 1]) / (nodes[k] - nodes[k - 1]));
  if (k + 1 < nodes.size() && f > nodes[k])
    return std::max(0.0, (nodes[k + 1] - f) / (nodes[k + 1] - nodes[k]));
  return 1.0;
}

}  // namespace

Interference::Interference(const Scenario& scenario, const PropagationPaths& paths)
    : scenario_(scenario),
      paths_(paths),
      motions_(array_motions(scenario)),
      frequency_(scenario.interferers.empty() ? 0.0
                                              : Pulse(pulse_of(scenario, 0)).centre_frequency()),
      rate_(recorded_rate(scenario)),
      carrier_(recorded_carrier(scenario)),
      // Twice oversampled, for the interpolation: the band is half of the rate.
      source_rate_(carrier_ > 0.0 ? 2.0 * rate_ : rate_),
      source_carrier_(carrier_ > 0.0 ? carrier_ : 0.25 * rate_) {
  double fastest_platform = 0.0;
  for (const Platform& p : scenario.platforms)
    fastest_platform = std::max(fastest_platform, fastest(p.track));
  if (scenario.propagation.band == BandOfLosses::wide && !scenario.interferers.empty()) {
    const double high = source_carrier_ + 0.25 * source_rate_;
    band_ = frequencies_of_losses(
        scenario.environment, std::max(source_carrier_ - 0.25 * source_rate_, 0.01 * high), high);
  }
  for (std::size_t i = 0; i < scenario.interferers.size(); ++i) {
    const Interferer& ship = scenario.interferers[i];
    // What Doppler would shift out of the band is left out.
    const double doppler = (fastest(ship.track) + fastest_platform) / 1300.0;
    const double low = std::max(0.0, source_carrier_ - 0.25 * source_rate_) * (1.0 + doppler),
                 high = (source_carrier_ + 0.25 * source_rate_) * (1.0 - doppler);
    const std::array<Vec3, 1> point = {Vec3::Zero()};
    for (std::size_t k = 0; k < std::max<std::size_t>(1, band_.size()); ++k)
      sources_.emplace_back(
          [&](double f) {
            const double share = band_.empty() ? 1.0 : hat(band_, k, f);
            return f >= low && f <= high ? share * share * source_density(ship, f) : 0.0;
          },
          source_rate_, source_carrier_, point, NoiseCoherence::independent, NoiseDirections{},
          1500.0, NoiseKey{.seed = scenario.seed, .purpose = Draw::ship_noise, .first_channel = i});
  }
}

/// Paths that arrive at a time, delays those from where the ship was when each left it.
std::vector<Interference::Received> Interference::received_at(const Interferer& ship, int array,
                                                              const Carried& receiver_point,
                                                              double time,
                                                              bool across_the_band) const {
  const Kinematics receiver = receiver_point.at(time);
  const Bounces followed =
      enough_bounces(paths_, scenario_.propagation, ship.track.at(time).position, receiver.position,
                     frequency_, infinity);
  PathLimits limits = limits_of(scenario_.propagation, followed);
  limits.diffraction = false;  // at every frequency of a ship's band: too dear
  double left = time;
  Arrivals found;
  Kinematics source;
  for (int i = 0; i < 4; ++i) {  // each round gains a factor v/c
    source = ship.track.at(left);
    found = paths_.find(source.position, receiver.position, frequency_, limits);
    if (found.empty() || source.velocity.isZero()) break;
    const double before = std::exchange(left, time - found.front().delay);
    if (std::abs(left - before) < 1e-7) break;
  }
  const Separation way = separation(source.position, receiver.position);
  const double c_source = paths_.speed_at(source.position),
               c_array = paths_.speed_at(receiver.position);
  std::vector<Arrivals> at_frequencies;
  if (across_the_band)
    for (const double f : band_)
      at_frequencies.push_back(paths_.find(source.position, receiver.position, f, limits));
  std::vector<Received> received;
  for (const Arrival& path : found) {
    const Vec3 leaving = leaving_slowness(way.bearing, path, c_source);
    const Vec3 arriving = arriving_slowness(way.bearing, path, c_array);
    // Left when the ship was v·(t_e − left) further on: τ = τ₀ − s·v(t_e − left), t_e = t − τ.
    const double along = leaving.dot(source.velocity);
    const double delay = (path.delay - along * (time - left)) / (1.0 - along);
    Received one{
        .path = {.array = array,
                 .delay = delay,
                 .doppler = leg_doppler({source.velocity, leaving}, {receiver.velocity, arriving}),
                 .range = way.range,
                 .bearing = way.bearing,
                 .slowness = arriving,
                 .moveout = arriving / (1.0 - along),
                 .path = path},
        .band = {},
        .scattered_band = {},
        .parts = {}};
    for (const Arrivals& arrivals : at_frequencies) {
      const Arrival* same = same_path(arrivals, path, paths_.layered());
      one.band.push_back(same == nullptr ? 0.0 : same->amplitude);
      one.scattered_band.push_back(same == nullptr ? 0.0 : std::sqrt(same->scattered));
    }
    received.push_back(std::move(one));
  }
  return received;
}

bool Interference::plane_waves(const Interferer& ship, int array, const RecordSamples& record,
                               const Clock& clock) const {
  const ArrayMotion& motion = motions_[static_cast<std::size_t>(array)];
  const Listening here{
      .scenario = scenario_, .motion = motion, .ping = record.ping, .ping_time = record.start_time};
  const double begin = clock.time(clock.first), end = clock.time(clock.first + clock.samples);
  for (const double time : {begin, end})
    for (const Received& one : received_at(ship, array, motion.reference(), time, false))
      if (!is_plane_wave(here, {.slowness = one.path.slowness,
                                .length = one.path.path.path_length,
                                .delay = begin - record.start_time,
                                .duration = end - begin,
                                .highest_frequency = source_carrier_ + 0.25 * source_rate_}))
        return false;
  return true;
}

void Interference::scatter(const Interferer& ship, double time,
                           std::vector<Received>& received) const {
  constexpr int most_parts = 8;
  double loudest = 0.0;
  for (const Received& one : received)
    loudest = std::max(loudest, std::norm(one.path.path.amplitude) + one.path.path.scattered);
  const auto number = static_cast<std::uint64_t>(&ship - scenario_.interferers.data());
  SeaDraws draws(scenario_.seed);
  for (Received& one : received) {
    const Arrival& path = one.path.path;
    if (!(path.scattered > 1e-9 * std::norm(path.amplitude))) continue;
    const double left = time - one.path.delay;
    const std::uint64_t entity = mixed(mixed(number, ~1ULL), scatter_history(path));
    const int parts = path.scattered > 0.01 * loudest ? most_parts : 1;
    const RoughPath rough =
        rough_path(scenario_.environment, path, frequency_, parts, draws, entity);
    const ScatteredLeg leg{&rough, ship.track.at(left).position.head<2>(), one.path.bearing, left};
    one.parts = forward_scatter(scenario_.environment, std::span(&leg, 1), frequency_, parts,
                                scenario_.seed, entity);
  }
}

/// Between nodes a part's frequency is shifted by the mean of its ends', and by what more turns the
/// phase of the one into the other's. Where a part is another draw at the other end, one fades out
/// and the other in.
void Interference::add_parts(const Received* one, const Received* other, std::int64_t begin,
                             double seconds, std::vector<Segment>& all) {
  const auto end = [](const Received& received, std::size_t i, double phase, std::size_t side,
                      Segment& into) {
    const ScatteredPart& part = received.parts[i];
    const std::complex<double> weight =
        std::polar(1.0 / std::sqrt(double(received.parts.size())), phase);
    into.delay[side] = received.path.delay + part.delay;
    into.length[side] = received.path.path.path_length;
    into.moveout[side] = slowness_vector(
        arrival_bearing(received.path.path, received.path.bearing) + part.bearing,
        received.path.path.arrival_elevation + part.elevation, 1.0 / received.path.moveout.norm());
    into.amplitude[side] = std::sqrt(received.path.path.scattered) * weight;
    for (const double root : received.scattered_band) into.band[side].push_back(root * weight);
  };
  const auto same_draw = [&](const ScatteredPart& a, const ScatteredPart& b) {
    return std::abs(a.shift - b.shift) * seconds < 0.5 &&
           std::abs(a.delay - b.delay) < 1e-5 + 0.2 * std::max(a.delay, b.delay);
  };
  const auto fades = [&](const Received& received, std::size_t i, std::size_t side) {
    const ScatteredPart& part = received.parts[i];
    const double rotated = side == 0 ? 0.0 : 2.0 * pi * part.shift * seconds;
    Segment s{.begin = begin, .shift = part.shift};
    end(received, i, std::arg(part.amplitude) - rotated, 0, s);
    end(received, i, std::arg(part.amplitude) - rotated, 1, s);
    s.amplitude[1 - side] = 0.0;
    for (std::complex<double>& amplitude : s.band[1 - side]) amplitude = 0.0;
    all.push_back(std::move(s));
  };
  const std::size_t first = one == nullptr ? 0 : one->parts.size(),
                    second = other == nullptr ? 0 : other->parts.size();
  for (std::size_t i = 0; i < std::max(first, second); ++i) {
    if (i >= first || i >= second || !same_draw(one->parts[i], other->parts[i])) {
      if (i < first) fades(*one, i, 0);
      if (i < second) fades(*other, i, 1);
      continue;
    }
    const ScatteredPart &a = one->parts[i], &b = other->parts[i];
    const double mean = 0.5 * (a.shift + b.shift), phase = std::arg(a.amplitude);
    const double more = std::arg(b.amplitude * std::conj(a.amplitude) *
                                 std::polar(1.0, -2.0 * pi * mean * seconds));
    Segment s{.begin = begin, .shift = mean + more / (2.0 * pi * seconds)};
    end(*one, i, phase, 0, s);
    end(*other, i, phase, 1, s);
    all.push_back(std::move(s));
  }
}

std::vector<Interference::Segment> Interference::segments(const Interferer& ship, int array,
                                                          const Carried& receiver_point,
                                                          const Clock& clock) const {
  const std::int64_t from = floor_div(clock.first, clock.node),
                     to = floor_div(clock.first + clock.samples - 1, clock.node);
  const auto count = static_cast<std::size_t>(to - from + 2);
  const bool across_the_band = !band_.empty() && (ship.level_db || ship.table);
  std::vector<std::vector<Received>> nodes(count);
  in_parallel(count, [&](std::size_t i) {
    const double time = clock.time((from + static_cast<std::int64_t>(i)) * clock.node);
    nodes[i] = received_at(ship, array, receiver_point, time, across_the_band);
    scatter(ship, time, nodes[i]);
  });
  const double seconds = static_cast<double>(clock.node) / clock.rate;
  std::vector<Segment> all;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const std::int64_t begin = (from + static_cast<std::int64_t>(i)) * clock.node;
    std::vector<bool> taken(nodes[i + 1].size(), false);
    const auto times = [](double there, std::vector<std::complex<double>> amplitudes) {
      for (std::complex<double>& amplitude : amplitudes) amplitude *= there;
      return amplitudes;
    };
    const auto add = [&](const Received& one, const Received& other, double a_there,
                         double b_there) {
      const ReceivedPath &a = one.path, &b = other.path;
      all.push_back({.begin = begin,
                     .delay = {a.delay, b.delay},
                     .length = {a.path.path_length, b.path.path_length},
                     .amplitude = {a_there * a.path.amplitude, b_there * b.path.amplitude},
                     .band = {times(a_there, one.band), times(b_there, other.band)},
                     .moveout = {a.moveout, b.moveout}});
    };
    Arrivals next;
    for (const Received& one : nodes[i + 1]) next.push_back(one.path.path);
    for (const Received& one : nodes[i]) {
      const Arrival* same = same_path(next, one.path.path, paths_.layered());
      const auto at = same == nullptr ? next.size() : static_cast<std::size_t>(same - next.data());
      if (at < next.size() && !taken[at]) {
        taken[at] = true;
        add(one, nodes[i + 1][at], 1.0, 1.0);
        add_parts(&one, &nodes[i + 1][at], begin, seconds, all);
      } else {
        add(one, one, 1.0, 0.0);
        add_parts(&one, nullptr, begin, seconds, all);
      }
    }
    for (std::size_t j = 0; j < next.size(); ++j) {
      if (taken[j]) continue;
      add(nodes[i + 1][j], nodes[i + 1][j], 0.0, 1.0);
      add_parts(nullptr, &nodes[i + 1][j], begin, seconds, all);
    }
  }
  return all;
}

namespace {

constexpr std::int64_t chunk = interference_chunk;
constexpr double node_spacing = 0.5;  // [s], about

std::complex<double> phasor(double cycles) {
  return std::polar(1.0, 2.0 * pi * (cycles - std::floor(cycles)));
}

}  // namespace

/// A chunk of one path whose losses depend on frequency: Σ_k A_k(t)·q_k on the samples of the
/// source that it spans, interpolated and turned as one signal. \param u  where it lies between
/// the nodes, and how fast that grows   \param begin  number of the first of `source`
/// \param at  place of the chunk's first sample in the source, from sample 0 on, so that rounding
/// is the same whatever part of the record is wanted   \param step  from sample to sample   \param
/// z, turn  phase of the first, and from one to the next
void Interference::add_band(const Segment& path, std::span<const float> source, std::int64_t begin,
                            std::size_t length, std::array<double, 2> u, double at, double step,
                            std::complex<double> z, std::complex<double> rotation,
                            std::span<std::complex<double>> sum) {
  const FractionalDelay& between_samples = FractionalDelay::shared();
  constexpr std::int64_t reach = FractionalDelay::taps;
  const auto last = static_cast<double>(sum.size() - 1);
  const auto first = static_cast<std::int64_t>(std::floor(std::min(at, at + last * step))) - reach;
  const auto end =
      static_cast<std::int64_t>(std::floor(std::max(at, at + last * step))) + reach + 1;
  std::vector<float> filtered(2 * static_cast<std::size_t>(end - first), 0.0F);
  for (std::size_t k = 0; k < path.band[0].size(); ++k) {
    const std::complex<double> slope = path.band[1][k] - path.band[0][k];
    const float* q = source.data() + k * length + 2 * (first - begin);
    for (std::int64_t j = 0; j < end - first; ++j) {
      // The output's sample that is received there; amplitudes hardly change from one to the next.
      const double i = (static_cast<double>(first + j) - at) / step;
      const std::complex<float> a(path.band[0][k] + (u[0] + i * u[1]) * slope);
      const std::complex<float> product = a * std::complex<float>(q[2 * j], q[2 * j + 1]);
      filtered[2 * static_cast<std::size_t>(j)] += product.real();
      filtered[2 * static_cast<std::size_t>(j) + 1] += product.imag();
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i, z *= rotation) {
    const double place = at + static_cast<double>(i) * step;
    sum[i] += z * std::complex<double>(between_samples.at(filtered.data(), first, place));
  }
}

std::vector<ReceivedPath> Interference::add(const RecordSamples& record, std::int64_t later) const {
  const Recording& recording = record.recording;
  if (scenario_.interferers.empty() || recording.samples == 0) return {};
  const FractionalDelay& between_samples = FractionalDelay::shared();
  std::vector<ReceivedPath> paths;
  const bool complex = recording.is_complex();
  const std::size_t width = recording.components();
  Clock clock;
  clock.rate = recording.sample_rate;
  clock.samples = static_cast<std::int64_t>(recording.samples);
  clock.node = chunk * std::max<std::int64_t>(1, std::llround(node_spacing * rate_ / chunk));
  if (scenario_.pings.continuous) {
    clock.first = std::llround(record.start_time * rate_);
    clock.zero = clock.carrier_zero = recording.start;
  } else {
    clock.zero = record.start_time + recording.start;
    clock.carrier_zero = recording.start + recording.epoch;
  }
  clock.first += later;
  for (std::size_t ship_index = 0; ship_index < scenario_.interferers.size(); ++ship_index) {
    const Interferer& ship = scenario_.interferers[ship_index];
    const bool broadband = ship.level_db || ship.table;
    std::vector<std::complex<double>> tone;  // peak at 1 m, with its phase at time 0
    for (std::size_t k = 0; k < ship.tonals.size(); ++k) {
      RandomStream draw(scenario_.seed, Draw::ship_tonal, static_cast<std::uint32_t>(k),
                        ship_index);
      tone.push_back(std::numbers::sqrt2 * micropascal *
                     amplitude_from_db(ship.tonals[k].level_db) * phasor(draw.uniform()));
    }
    for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
      const int array = static_cast<int>(a);
      const ArrayMotion& motion = motions_[a];
      const Carried& reference = motion.reference();
      for (Received& one :
           received_at(ship, array, reference, clock.time(clock.first - later), false)) {
        one.path.interferer = static_cast<int>(ship_index);
        paths.push_back(std::move(one.path));
      }
      std::vector<Vec3> phones = motion.phones(record.ping, record.start_time);
      std::vector<std::vector<Segment>> received;  // by all phones together, or by each
      if (scenario_.propagation.exact_per_phone || !plane_waves(ship, array, record, clock)) {
        for (std::size_t n = 0; n < phones.size(); ++n)
          received.push_back(
              segments(ship, array, motion.phone(record.ping, static_cast<int>(n)), clock));
        std::fill(phones.begin(), phones.end(), Vec3::Zero());
      } else {
        received.push_back(segments(ship, array, reference, clock));
      }
      if (std::all_of(received.begin(), received.end(),
                      [](const auto& all) { return all.empty(); }))
        continue;
      // The source's samples that any phone receives.
      double reach = 0.0, least = infinity, most = -infinity;
      for (const Vec3& phone : phones) reach = std::max(reach, phone.norm() / 1000.0);
      for (const std::vector<Segment>& all : received)
        for (const Segment& s : all) {
          least = std::min({least, s.delay[0], s.delay[1]});
          most = std::max({most, s.delay[0], s.delay[1]});
        }
      constexpr std::int64_t margin = 2 * FractionalDelay::taps;
      const auto begin =
          static_cast<std::int64_t>(
              std::floor((clock.time(clock.first - clock.node) - most - reach) * source_rate_)) -
          margin;
      const auto end = static_cast<std::int64_t>(std::ceil(
                           (clock.time(clock.first + clock.samples + clock.node) - least + reach) *
                           source_rate_)) +
                       margin;
      const std::size_t parts = std::max<std::size_t>(1, band_.size());
      const std::size_t part_length = broadband ? 2 * static_cast<std::size_t>(end - begin) : 0;
      std::vector<float> source(parts * part_length, 0.0F);
      for (std::size_t k = 0; broadband && k < parts; ++k)
        sources_[ship_index * parts + k].add(
            std::span(source).subspan(k * part_length, part_length), begin, 0);
      const double depth = motion.at(clock.time(clock.first)).position.z();
      std::vector<double> loss;
      for (const Tonal& tonal : ship.tonals)
        loss.push_back(attenuation_np_per_m(scenario_.environment, tonal.frequency).at(depth) -
                       attenuation_np_per_m(scenario_.environment, frequency_).at(depth));
      const std::size_t first_row = first_channel(scenario_, array);
      const std::int64_t chunks =
          floor_div(clock.first + clock.samples - 1, chunk) - floor_div(clock.first, chunk) + 1;
      const auto per_phone = static_cast<std::size_t>(chunks);
      in_parallel(phones.size() * per_phone, [&](std::size_t task) {
        const std::size_t n = task / per_phone;
        const std::vector<Segment>& all = received[received.size() > 1 ? n : 0];
        // Whole chunks of the absolute grid, of which the record may want a part.
        const std::int64_t sample =
            (floor_div(clock.first, chunk) + static_cast<std::int64_t>(task % per_phone)) * chunk;
        const std::int64_t node = floor_div(sample, clock.node) * clock.node;
        std::array<std::complex<double>, chunk> sum{};
        const auto [from, to] =
            std::equal_range(all.begin(), all.end(), Segment{.begin = node},
                             [](const Segment& x, const Segment& y) { return x.begin < y.begin; });
        for (auto path = from; path != to; ++path) {
          const double u0 = static_cast<double>(sample - node) / static_cast<double>(clock.node),
                       du = 1.0 / static_cast<double>(clock.node);
          const double delay0 = path->delay[0] + path->moveout[0].dot(phones[n]),
                       delay1 = path->delay[1] + path->moveout[1].dot(phones[n]);
          // When the first sample left the ship, and how much later the next one did.
          const double left = clock.time(sample) - (delay0 + u0 * (delay1 - delay0)),
                       step = 1.0 / clock.rate - du * (delay1 - delay0);
          const std::complex<double> slope = du * (path->amplitude[1] - path->amplitude[0]);
          const std::complex<double> level =
              path->amplitude[0] + u0 * (path->amplitude[1] - path->amplitude[0]);
          // What the sea's motion has turned since the node, and turns from sample to sample.
          const std::complex<double> moved =
              phasor(path->shift * static_cast<double>(sample - node) / clock.rate);
          const std::complex<double> moves = phasor(path->shift / clock.rate);
          const double clock_cycles =
              carrier_ * (clock.carrier_zero + static_cast<double>(sample) / clock.rate);
          if (broadband && !band_.empty()) {
            add_band(*path, source, begin, part_length, {u0, du}, left * source_rate_,
                     step * source_rate_,
                     moved * phasor(source_carrier_ * left) * std::conj(phasor(clock_cycles)),
                     moves * phasor(source_carrier_ * step - carrier_ / clock.rate), sum);
          } else if (broadband) {
            std::complex<double> z =
                moved * phasor(source_carrier_ * left) * std::conj(phasor(clock_cycles));
            const std::complex<double> rotation =
                moves * phasor(source_carrier_ * step - carrier_ / clock.rate);
            for (std::int64_t i = 0; i < chunk; ++i, z *= rotation) {
              const double at = (left + static_cast<double>(i) * step) * source_rate_;
              const std::complex<float> q = between_samples.at(source.data(), begin, at);
              sum[static_cast<std::size_t>(i)] +=
                  (level + static_cast<double>(i) * slope) * z * std::complex<double>(q);
            }
          }
          for (std::size_t k = 0; k < tone.size(); ++k) {
            const double f = ship.tonals[k].frequency;
            if (std::abs(f - (complex ? carrier_ : 0.25 * rate_)) > (complex ? 0.5 : 0.25) * rate_)
              continue;  // outside the recorded band
            const double length = path->length[0] + u0 * (path->length[1] - path->length[0]);
            std::complex<double> z = moved * tone[k] * std::exp(-loss[k] * length) *
                                     phasor(f * left) * std::conj(phasor(clock_cycles));
            const std::complex<double> rotation = moves * phasor(f * step - carrier_ / clock.rate);
            for (std::int64_t i = 0; i < chunk; ++i, z *= rotation)
              sum[static_cast<std::size_t>(i)] += (level + static_cast<double>(i) * slope) * z;
          }
        }
        float* row = record.pressure.data() + (first_row + n) * recording.samples * width;
        for (std::int64_t i = 0; i < chunk; ++i) {
          const std::int64_t at = sample + i - clock.first;
          if (at < 0 || at >= clock.samples) continue;
          const auto out = static_cast<std::size_t>(at) * width;
          row[out] += static_cast<float>(sum[static_cast<std::size_t>(i)].real());
          if (complex) row[out + 1] += static_cast<float>(sum[static_cast<std::size_t>(i)].imag());
        }
      });
    }
  }
  return paths;
}

}  // namespace asdic::detail
