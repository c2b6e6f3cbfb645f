#include "sonar/noise/interference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "raytrace/parallel/parallel.h"
#include "sonar/noise/interference_segment.h"
#include "sonar/signal/fractional_delay.h"

namespace asdic::detail {
namespace {

constexpr std::int64_t chunk = interference_chunk;
constexpr double node_spacing = 0.5;  // [s], about

std::complex<double> phasor(double cycles) {
  return std::polar(1.0, 2.0 * pi * (cycles - std::floor(cycles)));
}

}  // namespace

/// A chunk of one path whose losses depend on frequency: Σ_k A_k(t)·q_k on the samples of the
/// source that it spans, interpolated and turned as one signal. \param u  where it lies between
/// the nodes, and how fast that grows   \param at  place of its first sample in the source
/// \param step  from sample to sample   \param z, turn  phase of the first, and from one to the
/// next
void Interference::add_band(const Segment& path, std::span<const float> source, std::size_t length,
                            std::array<double, 2> u, double at, double step, std::complex<double> z,
                            std::complex<double> rotation, std::span<std::complex<double>> sum) {
  const FractionalDelay& between_samples = FractionalDelay::shared();
  constexpr std::int64_t reach = FractionalDelay::taps;
  const auto last = static_cast<double>(sum.size() - 1);
  const auto first = static_cast<std::int64_t>(std::floor(std::min(at, at + last * step))) - reach;
  const auto end =
      static_cast<std::int64_t>(std::floor(std::max(at, at + last * step))) + reach + 1;
  std::vector<float> filtered(2 * static_cast<std::size_t>(end - first), 0.0F);
  for (std::size_t k = 0; k < path.band[0].size(); ++k) {
    const std::complex<double> slope = path.band[1][k] - path.band[0][k];
    const float* q = source.data() + k * length + 2 * first;
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
      const Carried reference = reference_of(scenario_, array);
      for (Received& one :
           received_at(ship, array, reference, clock.time(clock.first - later), false)) {
        one.path.interferer = static_cast<int>(ship_index);
        paths.push_back(std::move(one.path));
      }
      std::vector<Vec3> phones = phones_at(scenario_, array, record.ping, record.start_time);
      std::vector<std::vector<Segment>> received;  // by all phones together, or by each
      if (scenario_.propagation.exact_per_phone || !plane_waves(ship, array, record, clock)) {
        for (std::size_t n = 0; n < phones.size(); ++n)
          received.push_back(segments(
              ship, array, phone_of(scenario_, array, record.ping, static_cast<int>(n)), clock));
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
      const double depth = array_at(scenario_, array, clock.time(clock.first)).position.z();
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
            add_band(*path, source, part_length, {u0, du}, left * source_rate_ - double(begin),
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
