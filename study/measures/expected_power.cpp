#include "study/measures/expected_power.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "processing/signal_excess.h"
#include "reverb/power/reverberation_streams.h"
#include "sonar/noise/noise_in_guide.h"
#include "sonar/noise/noise_spectrum.h"
#include "sonar/signal/fft.h"
#include "sonar/synthesis/wave_lags.h"

namespace asdic::detail::study {
namespace {

/// |C(u)|²/E², and its integral from −∞, for one ratio of Doppler factors.
class Overlap {
 public:
  /// \param doppler  η of the filter   \param other  η' of the sound
  Overlap(const Pulse& pulse, double doppler, double other) {
    const double longest = pulse.duration() / std::min(doppler, other);
    step_ = 0.25 / std::max(pulse.bandwidth_99(), 4.0 / pulse.duration());
    const auto n = static_cast<std::size_t>(std::ceil(longest / step_)) + 1;
    const ComplexFft<double> transform(fast_fft_length(2 * n));
    FftBuffer<std::complex<double>> own(transform.length()), sound(transform.length());
    const double turn = 2.0 * pi * pulse.centre_frequency() * doppler;
    double energy = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double t = static_cast<double>(i) * step_;
      const std::complex<double> to_baseband = std::polar(1.0, -turn * t);
      own[i] = pulse.analytic(doppler * t) * to_baseband;
      sound[i] = pulse.analytic(other * t) * to_baseband;
      energy += std::norm(own[i]);
    }
    transform.forward(own.data());
    transform.forward(sound.data());
    for (std::size_t k = 0; k < own.size(); ++k) own[k] *= std::conj(sound[k]);
    transform.inverse(own.data());
    // own[u] is now C(u)* times the transform's length, u = 0 … n − 1, and −u at its end.
    const double scale = 1.0 / (energy * static_cast<double>(transform.length()));
    first_ = -static_cast<double>(n) * step_;
    sums_.assign(1, 0.0);
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const std::size_t at = i < n ? transform.length() - n + i : i - n;
      sums_.push_back(sums_.back() + step_ * std::norm(scale * own[at]));
    }
  }
  /// ∫_{−∞}^u |C|²du/E² [s]
  [[nodiscard]] double until(double u) const noexcept {
    const double place =
        std::clamp((u - first_) / step_ + 0.5, 0.0, static_cast<double>(sums_.size() - 1));
    const std::size_t below = std::min(static_cast<std::size_t>(place), sums_.size() - 2);
    const double t = place - static_cast<double>(below);
    return sums_[below] + t * (sums_[below + 1] - sums_[below]);
  }
  /// Beyond which there is nothing [s].
  [[nodiscard]] double reach() const noexcept { return -first_ + step_; }

 private:
  double step_ = 1.0, first_ = 0.0;
  std::vector<double> sums_;  // up to the edges of the steps, in whose middles |C|² is
};

}  // namespace

/// The phones that are added, and how.
struct ExpectedPower::Beam {
  double doppler = 1.0, delay = 0.0;  // η, and the mean of the phones' delays [s]
  std::vector<Vec3> phones;           // from where streams are received [m]
  std::vector<Vec3> places;           // the same, as noise is received [m]
  std::vector<double> steered;        // d_p [s]
  struct Frequency {
    double frequency = 0.0, second = 0.0, fourth = 0.0;  // [Hz], u_k and v_k
  };
  std::vector<Frequency> band;

  Beam(const Pulse& pulse, double factor, const std::vector<MatchedFilterAt::Phone>& heard,
       std::size_t first_channel, const std::vector<Vec3>& all, const std::vector<Vec3>& here,
       double sound_speed)
      : doppler(factor) {
    double reach = 0.0;
    for (const MatchedFilterAt::Phone& phone : heard) {
      phones.push_back(all[phone.channel - first_channel]);
      places.push_back(here[phone.channel - first_channel]);
      steered.push_back(phone.delay);
      delay += phone.delay / static_cast<double>(heard.size());
      reach = std::max(reach, (phones.back() - phones.front()).norm() / sound_speed);
    }
    for (double& d : steered) d -= delay;
    // So many that a wave from anywhere turns by less than a quarter between two of them.
    constexpr double most = 64.0;
    const double width = pulse.bandwidth_99();
    const auto count =
        static_cast<std::size_t>(std::min(most, std::ceil(8.0 * width * reach) + 1.0));
    const double rate = 4.0 * std::max(pulse.bandwidth_40db(), 4.0 / pulse.duration());
    const auto samples = static_cast<std::size_t>(std::ceil(pulse.duration() * rate));
    double second = 0.0, fourth = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const double beside =
          width * ((static_cast<double>(k) + 0.5) / static_cast<double>(count) - 0.5);
      const double f = pulse.centre_frequency() + beside;
      std::complex<double> sum = 0.0;
      for (std::size_t i = 0; i < samples; ++i) {
        const double t = (static_cast<double>(i) + 0.5) / rate;
        sum += pulse.analytic(t) * std::polar(1.0, -2.0 * pi * f * t);
      }
      const double power = count == 1 ? 1.0 : std::norm(sum);
      band.push_back({.frequency = f * doppler, .second = power, .fourth = power * power});
      second += power;
      fourth += power * power;
    }
    for (Frequency& one : band) {
      one.second /= second;
      one.fourth /= fourth;
    }
  }
};

ExpectedPower::ExpectedPower(const PingSimulator& simulator, const PingRecord& record, int array)
    : simulator_(simulator),
      pulse_(simulator.pulse(record.transmitter)),
      array_(array),
      first_channel_(first_channel(simulator.scenario(), array)),
      sound_speed_(simulator.paths().speed_at(
          simulator.geometry(record.ping).reference_place(array).position)),
      sea_(simulator.mean_sea(record.ping, array)) {
  const auto first = record.phones.begin() + static_cast<std::ptrdiff_t>(first_channel_);
  places_.assign(first, first + static_cast<std::ptrdiff_t>(sea_.phones.size()));
}

double ExpectedPower::noise(const Beam& beam) const {
  const Scenario& scenario = simulator_.scenario();
  if (!scenario.noise.any()) return 0.0;
  const NoiseField field = noise_field(scenario, array_);
  const std::size_t n = beam.phones.size();
  double sum = 0.0;
  for (const Beam::Frequency& one : beam.band) {
    double kept = 1.0 / static_cast<double>(n);  // wᴴΓw
    if (field.coherence != NoiseCoherence::independent && n > 1) {
      const double omega = 2.0 * pi * one.frequency;
      const std::vector<std::complex<double>> coherence =
          noise_coherences(beam.places, omega / sound_speed_, field);
      std::vector<std::complex<double>> turned(n);
      for (std::size_t p = 0; p < n; ++p) turned[p] = std::polar(1.0, omega * beam.steered[p]);
      kept = 0.0;
      for (std::size_t p = 0; p < n; ++p) {
        std::complex<double> row = 0.0;
        for (std::size_t q = 0; q < n; ++q) row += coherence[p * n + q] * std::conj(turned[q]);
        kept += std::real(turned[p] * row);
      }
      kept /= static_cast<double>(n * n);
    }
    sum += one.second * noise_density(scenario.noise, one.frequency) * kept;
  }
  return 2.0 * sum * beam.doppler / pulse_.energy();
}

ExpectedPower::Kept ExpectedPower::kept_by(const Beam& beam, std::size_t part) const {
  const ReverberationStreams::Part& of = sea_.streams->parts[part];
  const PhonePlaces at(beam.phones);
  const std::size_t n = beam.phones.size();
  const auto count = static_cast<double>(n);
  std::vector<double> lags(n);
  std::array<std::vector<std::complex<double>>, 2> response;  // [waves][frequencies]
  Kept kept;
  double all = 0.0;
  for (std::size_t wave = 0; wave < 2; ++wave) {
    const double power = std::norm(of.weight[0][wave]) + std::norm(of.weight[1][wave]);
    response[wave].assign(beam.band.size(), 0.0);
    if (power == 0.0) continue;
    find_lags(of.slowness[wave], of.length[wave], of.curvature[wave], at, lags);
    for (std::size_t p = 0; p < n; ++p) lags[p] -= beam.steered[p];
    kept.late += power * std::accumulate(lags.begin(), lags.end(), 0.0) / count;
    all += power;
    for (std::size_t k = 0; k < beam.band.size(); ++k)
      for (std::size_t p = 0; p < n; ++p)
        response[wave][k] += std::polar(1.0 / count, -2.0 * pi * beam.band[k].frequency * lags[p]);
  }
  if (all > 0.0) kept.late /= all;
  for (std::size_t k = 0; k < beam.band.size(); ++k)
    for (const auto& weight : of.weight)
      kept.share +=
          beam.band[k].fourth * std::norm(weight[0] * response[0][k] + weight[1] * response[1][k]);
  return kept;
}

std::vector<double> ExpectedPower::operator()(const MatchedFilterAt& filter, double doppler,
                                              const std::vector<double>& later) const {
  const Beam beam(pulse_, doppler, filter.phones(), first_channel_, sea_.phones, places_,
                  sound_speed_);
  std::vector<double> powers(later.size(), noise(beam));
  const ReverberationStreams& sea = *sea_.streams;
  // Factors to a twentieth of what the pulse resolves are alike.
  const double alike = 0.05 / (pulse_.centre_frequency() * pulse_.duration());
  std::map<long, Overlap> overlaps;
  const auto overlap_of = [&](double factor) -> const Overlap& {
    const long place = std::lround((factor / doppler - 1.0) / alike);
    const auto known = overlaps.find(place);
    if (known != overlaps.end()) return known->second;
    return overlaps
        .emplace(place,
                 Overlap(pulse_, doppler, doppler * (1.0 + static_cast<double>(place) * alike)))
        .first->second;
  };
  std::map<std::size_t, Kept> known;
  const auto kept = [&](std::size_t part) {
    const auto at = known.find(part);
    return at != known.end() ? at->second : known.emplace(part, kept_by(beam, part)).first->second;
  };
  double aperture = 0.0;
  for (const Vec3& phone : beam.phones)
    aperture = std::max(aperture, 2.0 * phone.norm() / sound_speed_);
  const double scale = sea_.peak_pressure * sea_.peak_pressure;
  for (std::size_t i = 0; i < later.size(); ++i) {
    const double time = beam.delay + later[i];
    const double reach = aperture + 1.2 * pulse_.duration();
    double sum = 0.0;
    for (const ReverberationStreams::Block& block : sea.blocks) {
      if (static_cast<double>(block.end) * sea.bin < time - reach ||
          static_cast<double>(block.begin) * sea.bin > time + reach)
        continue;
      for (std::size_t s = block.first; s < block.last; ++s) {
        const ReverberationStreams::Stream& stream = sea.streams[s];
        double before = 0.0;
        for (std::size_t part = stream.first_part; part < stream.first_part + stream.parts;
             ++part) {
          const double chance = sea.parts[part].chance - before;
          before = sea.parts[part].chance;
          const auto [share, late] = kept(part);
          const Overlap& overlap = overlap_of(sea.parts[part].doppler);
          const double zero = static_cast<double>(block.begin) * sea.bin + late - time;
          const auto bins = static_cast<double>(block.end - block.begin);
          const auto from = static_cast<std::size_t>(
                         std::clamp(std::floor((-overlap.reach() - zero) / sea.bin), 0.0, bins)),
                     to = static_cast<std::size_t>(
                         std::clamp(std::ceil((overlap.reach() - zero) / sea.bin), 0.0, bins));
          double last = overlap.until(zero + static_cast<double>(from) * sea.bin), energy = 0.0;
          for (std::size_t bin = from; bin < to; ++bin) {
            const double next = overlap.until(zero + static_cast<double>(bin + 1) * sea.bin);
            energy += static_cast<double>(sea.intensity[stream.first + bin]) * (next - last);
            last = next;
          }
          sum += chance * share * energy;
        }
      }
    }
    powers[i] += scale * sum;
  }
  return powers;
}

}  // namespace asdic::detail::study
