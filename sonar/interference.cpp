#include "sonar/interference.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <utility>

#include "sonar/fractional_delay.h"
#include "sonar/geometry.h"
#include "sonar/moving_paths.h"
#include "sonar/noise_spectrum.h"
#include "sonar/ping_bounds.h"
#include "sonar/sampling.h"

namespace asdic {
namespace {

constexpr std::int64_t chunk = 64;    // samples over which phases are stepped
constexpr double node_spacing = 0.5;  // [s], about

std::int64_t floor_div(std::int64_t a, std::int64_t b) { return (a >= 0 ? a : a - b + 1) / b; }

std::complex<double> turns(double cycles) {
  return std::polar(1.0, 2.0 * pi * (cycles - std::floor(cycles)));
}

}  // namespace

double source_density(const Interferer& ship, double frequency) noexcept {
  double level = -infinity;
  if (ship.table)
    level = level_db(*ship.table, frequency);
  else if (ship.level_db)
    level =
        *ship.level_db + ship.slope_db_per_decade * std::log10(std::max(frequency, 100.0) / 1000.0);
  return power_from_db(level) * micropascal * micropascal;
}

/// Samples are numbered from the scenario's start in a stream, else from the record's.
struct Interference::Clock {
  std::int64_t first = 0, samples = 0, node = chunk;  // node spacing
  double zero = 0.0;                                  // time of sample 0 [s]
  double carrier_zero = 0.0;                          // on the carrier's clock [s]
  double rate = 1.0;

  [[nodiscard]] double time(std::int64_t sample) const {
    return zero + static_cast<double>(sample) / rate;
  }
};

/// One path between two nodes: everything straight in time.
struct Interference::Stretch {
  std::int64_t begin = 0;  // sample of its first node
  std::array<double, 2> delay{}, length{};
  std::array<std::complex<double>, 2> amplitude{};
  std::array<Vec3, 2> moveout{};
};

Interference::Interference(const Scenario& scenario, const PropagationPaths& paths)
    : scenario_(scenario),
      paths_(paths),
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
  for (std::size_t i = 0; i < scenario.interferers.size(); ++i) {
    const Interferer& ship = scenario.interferers[i];
    // What Doppler would shift out of the band is left out.
    const double doppler = (fastest(ship.track) + fastest_platform) / 1300.0;
    const double low = std::max(0.0, source_carrier_ - 0.25 * source_rate_) * (1.0 + doppler),
                 high = (source_carrier_ + 0.25 * source_rate_) * (1.0 - doppler);
    const std::array<Vec3, 1> point = {Vec3::Zero()};
    sources_.emplace_back(
        [&](double f) { return f >= low && f <= high ? source_density(ship, f) : 0.0; },
        source_rate_, source_carrier_, point, NoiseCoherence::independent, NoiseDirections{},
        1500.0, NoiseKey{.seed = scenario.seed, .purpose = Draw::ship_noise, .first_channel = i});
  }
}

/// Paths that arrive at a time, delays those from where the ship was when each left it.
std::vector<HeardPath> Interference::heard_at(const Interferer& ship, int array,
                                              double time) const {
  const Kinematics receiver = array_at(scenario_, array, time);
  const PathLimits limits = limits_of(scenario_.propagation);
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
  std::vector<HeardPath> heard;
  for (const Arrival& path : found) {
    const Vec3 leaving = slowness_vector(way.bearing, path.launch_elevation, c_source);
    const Vec3 arriving = slowness_vector(way.bearing, path.arrival_elevation, c_array);
    // Left when the ship was v·(t_e − left) further on: τ = τ₀ − s·v(t_e − left), t_e = t − τ.
    const double along = leaving.dot(source.velocity);
    const double delay = (path.delay - along * (time - left)) / (1.0 - along);
    heard.push_back({.array = array,
                     .delay = delay,
                     .doppler = (1.0 - arriving.dot(receiver.velocity)) / (1.0 - along),
                     .range = way.range,
                     .bearing = way.bearing,
                     .slowness = arriving,
                     .moveout = arriving / (1.0 - along),
                     .path = path});
  }
  return heard;
}

std::vector<Interference::Stretch> Interference::stretches(const Interferer& ship, int array,
                                                           const Clock& clock) const {
  const std::int64_t from = floor_div(clock.first, clock.node),
                     to = floor_div(clock.first + clock.samples - 1, clock.node);
  const auto count = static_cast<std::size_t>(to - from + 2);
  std::vector<std::vector<HeardPath>> nodes(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    nodes[i] =
        heard_at(ship, array, clock.time((from + static_cast<std::int64_t>(i)) * clock.node));
  });
  std::vector<Stretch> all;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const std::int64_t begin = (from + static_cast<std::int64_t>(i)) * clock.node;
    std::vector<bool> taken(nodes[i + 1].size(), false);
    const auto add = [&](const HeardPath& a, const HeardPath& b, double a_there, double b_there) {
      all.push_back({.begin = begin,
                     .delay = {a.delay, b.delay},
                     .length = {a.path.path_length, b.path.path_length},
                     .amplitude = {a_there * a.path.amplitude, b_there * b.path.amplitude},
                     .moveout = {a.moveout, b.moveout}});
    };
    Arrivals next;
    for (const HeardPath& one : nodes[i + 1]) next.push_back(one.path);
    for (const HeardPath& one : nodes[i]) {
      const Arrival* same = same_path(next, one.path, paths_.layered());
      const auto at = same == nullptr ? next.size() : static_cast<std::size_t>(same - next.data());
      if (at < next.size() && !taken[at]) {
        taken[at] = true;
        add(one, nodes[i + 1][at], 1.0, 1.0);
      } else {
        add(one, one, 1.0, 0.0);
      }
    }
    for (std::size_t j = 0; j < next.size(); ++j)
      if (!taken[j]) add(nodes[i + 1][j], nodes[i + 1][j], 0.0, 1.0);
  }
  return all;
}

void Interference::add(PingRecord& record, std::int64_t later) const {
  const Recording& recording = record.recording;
  if (scenario_.interferers.empty() || recording.samples == 0) return;
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
  static const FractionalDelay interpolate;
  for (std::size_t ship_index = 0; ship_index < scenario_.interferers.size(); ++ship_index) {
    const Interferer& ship = scenario_.interferers[ship_index];
    const bool broadband = ship.level_db || ship.table;
    std::vector<std::complex<double>> tone;  // peak at 1 m, with its phase at time 0
    for (std::size_t k = 0; k < ship.tonals.size(); ++k) {
      RandomStream draw(scenario_.seed, Draw::ship_tonal, static_cast<std::uint32_t>(k),
                        ship_index);
      tone.push_back(std::numbers::sqrt2 * micropascal *
                     amplitude_from_db(ship.tonals[k].level_db) * turns(draw.uniform()));
    }
    for (std::size_t a = 0; a < scenario_.arrays.size(); ++a) {
      const int array = static_cast<int>(a);
      for (HeardPath& path : heard_at(ship, array, clock.time(clock.first - later))) {
        path.interferer = static_cast<int>(ship_index);
        record.interference.push_back(path);
      }
      const std::vector<Stretch> all = stretches(ship, array, clock);
      if (all.empty()) continue;
      const std::vector<Vec3> phones = phones_at(scenario_, array, record.ping, record.start_time);
      // The source's samples that any phone hears.
      double reach = 0.0, least = infinity, most = -infinity;
      for (const Vec3& phone : phones) reach = std::max(reach, phone.norm() / 1000.0);
      for (const Stretch& s : all) {
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
      std::vector<float> source(broadband ? 2 * static_cast<std::size_t>(end - begin) : 0, 0.0F);
      if (broadband) sources_[ship_index].add(source, begin, 0);
      const double depth = array_at(scenario_, array, clock.time(clock.first)).position.z();
      std::vector<double> loss;
      for (const Tonal& tonal : ship.tonals)
        loss.push_back(attenuation_np_per_m(scenario_.environment, tonal.frequency).at(depth) -
                       attenuation_np_per_m(scenario_.environment, frequency_).at(depth));
      const std::size_t first_row = first_channel(scenario_, array);
      const std::int64_t chunks =
          floor_div(clock.first + clock.samples - 1, chunk) - floor_div(clock.first, chunk) + 1;
      const auto per_phone = static_cast<std::size_t>(chunks);
      tbb::parallel_for(std::size_t{0}, phones.size() * per_phone, [&](std::size_t task) {
        const std::size_t n = task / per_phone;
        // Whole chunks of the absolute grid, of which the record may want a part.
        const std::int64_t sample =
            (floor_div(clock.first, chunk) + static_cast<std::int64_t>(task % per_phone)) * chunk;
        const std::int64_t node = floor_div(sample, clock.node) * clock.node;
        std::array<std::complex<double>, chunk> sum{};
        const auto [from, to] =
            std::equal_range(all.begin(), all.end(), Stretch{.begin = node},
                             [](const Stretch& x, const Stretch& y) { return x.begin < y.begin; });
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
          const double clock_cycles =
              carrier_ * (clock.carrier_zero + static_cast<double>(sample) / clock.rate);
          if (broadband) {
            std::complex<double> z = turns(source_carrier_ * left) * std::conj(turns(clock_cycles));
            const std::complex<double> turn = turns(source_carrier_ * step - carrier_ / clock.rate);
            for (std::int64_t i = 0; i < chunk; ++i, z *= turn) {
              const double at = (left + static_cast<double>(i) * step) * source_rate_;
              const double whole = std::floor(at);
              const std::complex<float> q =
                  interpolate(source.data() + 2 * (static_cast<std::int64_t>(whole) - begin),
                              static_cast<float>(at - whole));
              sum[static_cast<std::size_t>(i)] +=
                  (level + static_cast<double>(i) * slope) * z * std::complex<double>(q);
            }
          }
          for (std::size_t k = 0; k < tone.size(); ++k) {
            const double f = ship.tonals[k].frequency;
            if (std::abs(f - (complex ? carrier_ : 0.25 * rate_)) > (complex ? 0.5 : 0.25) * rate_)
              continue;  // outside the recorded band
            const double length = path->length[0] + u0 * (path->length[1] - path->length[0]);
            std::complex<double> z = tone[k] * std::exp(-loss[k] * length) * turns(f * left) *
                                     std::conj(turns(clock_cycles));
            const std::complex<double> turn = turns(f * step - carrier_ / clock.rate);
            for (std::int64_t i = 0; i < chunk; ++i, z *= turn)
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
}

}  // namespace asdic
