#include "processing/echo_pointing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/matched_filter.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {}  // namespace

EchoPointing::EchoPointing(const Baseband& baseband, std::span<const Vec3> phones,
                           double sound_speed, const Replica& replica, const ArrayShape& shape,
                           std::span<const double> weights, double spacing, double lowest_doppler,
                           int sub_bands)
    : baseband_(baseband),
      phones_(phones),
      sound_speed_(sound_speed),
      replica_(replica),
      shape_(shape),
      weights_(weights),
      spacing_(spacing),
      wavelength_(sound_speed / replica.centre_frequency()),
      cuts_(sub_band_edges(replica, sub_bands)),
      cut_(fast_fft_length(static_cast<std::size_t>(
          std::ceil(1.5 * replica.duration() / lowest_doppler * baseband.sample_rate) + 64))) {}

std::vector<std::vector<std::complex<double>>> EchoPointing::snapshot(double time, double doppler,
                                                                      const Vec3& look) const {
  const double rate = baseband_.sample_rate, spacing = rate / static_cast<double>(cut_);
  // The cut begins an eighth of its length before the echo, as far as the record goes.
  const double before = 0.125 * static_cast<double>(cut_);
  const auto wanted = std::lround((time - baseband_.start) * rate - before);
  const auto first_sample = static_cast<std::ptrdiff_t>(wanted);
  const auto half = static_cast<std::ptrdiff_t>(cut_ / 2);
  const double room = 0.25 * replica_.bandwidth();
  const auto bin = [&](double f) {
    return static_cast<std::ptrdiff_t>(std::floor((f * doppler - baseband_.carrier) / spacing));
  };
  const std::ptrdiff_t first = std::max(bin(replica_.lowest_frequency() - room), 1 - half);
  const std::ptrdiff_t last = std::min(bin(replica_.highest_frequency() + room), half - 1);
  std::vector<std::complex<double>> weights;
  for (std::ptrdiff_t k = first; k <= last; ++k)
    weights.push_back(std::conj(
        replica_.spectrum(baseband_.carrier + static_cast<double>(k) * spacing, doppler)));
  const double scale = doppler / (replica_.energy() * static_cast<double>(cut_));
  const ComplexFft<float> fft(cut_);
  FftBuffer<std::complex<float>> work(cut_);
  std::vector<std::ptrdiff_t> ends;  // of the sub-bands
  for (const double cut : cuts_) ends.push_back(std::clamp(bin(cut) + 1, first, last + 1));
  ends.push_back(last + 1);
  std::vector<std::vector<std::complex<double>>> sums(ends.size());
  for (std::size_t n = 0; n < phones_.size(); ++n) {
    const auto row = baseband_.channel(n);
    for (std::size_t i = 0; i < cut_; ++i) {
      const std::ptrdiff_t at = first_sample + static_cast<std::ptrdiff_t>(i);
      work[i] = at >= 0 && at < std::ssize(row) ? row[static_cast<std::size_t>(at)]
                                                : std::complex<float>(0.0F);
    }
    fft.forward(work.data());
    // From bin to bin the phase of the delay turns by a constant step.
    const double lag = time - baseband_.start - static_cast<double>(first_sample) / rate -
                       look.dot(phones_[n]) / sound_speed_;  // [s]
    const double cycles = spacing * lag;
    const std::complex<double> step = std::polar(1.0, 2.0 * pi * cycles);
    std::complex<double> rotation =
        std::polar(1.0, 2.0 * pi * std::remainder(cycles * static_cast<double>(first), 1.0));
    std::ptrdiff_t k = first;
    for (std::size_t part = 0; part < ends.size(); ++part) {
      std::complex<double> sum = 0.0;
      for (; k < ends[part]; ++k) {
        const auto at = static_cast<std::size_t>(k < 0 ? k + static_cast<std::ptrdiff_t>(cut_) : k);
        sum += weights[static_cast<std::size_t>(k - first)] * std::complex<double>(work[at]) *
               rotation;
        rotation *= step;
      }
      // by its own energy
      sums[part].push_back(sum *
                           (ends.size() > 1 ? scale * static_cast<double>(ends.size()) : scale));
    }
  }
  return sums;
}

std::complex<double> EchoPointing::beam_of(const std::vector<std::complex<double>>& x,
                                           const Vec3& look) const {
  std::complex<double> sum = 0.0;
  for (std::size_t n = 0; n < phones_.size(); ++n)
    sum += weights_[n] * x[n] *
           std::polar(1.0, -2.0 * pi * baseband_.carrier * look.dot(phones_[n]) / sound_speed_);
  return sum;
}

double EchoPointing::power_at(const Detection& d) const {
  const auto x = snapshot(d.time, d.doppler, d.look);
  double sum = 0.0;
  for (const auto& part : x) sum += std::norm(beam_of(part, d.look));
  return sum / static_cast<double>(x.size());
}

void EchoPointing::point(Detection& d, const Vec3& beam) const {
  d.cosine = std::nan("");
  d.bearing = std::nan("");
  d.elevation = std::nan("");
  d.look = beam;
  if (shape_.kind == ArrayKind::point) return;
  auto parts = snapshot(d.time, d.doppler, beam);
  const auto loudest =
      std::max_element(parts.begin(), parts.end(), [&](const auto& a, const auto& b) {
        return std::norm(beam_of(a, beam)) < std::norm(beam_of(b, beam));
      });
  auto& x = *loudest;
  // The envelopes are aligned by the beam's delays; the carrier's phases are still the wave's.
  // What is left of the delays' differences turns at the pulse's frequency.
  double wavelength = wavelength_;
  if (parts.size() > 1) {
    const auto part = static_cast<std::size_t>(loudest - parts.begin());
    const double low = part == 0 ? replica_.lowest_frequency() : cuts_[part - 1],
                 high = part == cuts_.size() ? replica_.highest_frequency() : cuts_[part];
    wavelength = sound_speed_ / (0.5 * (low + high));
  }
  const double k = 2.0 * pi / wavelength * d.doppler,
               carrier = 2.0 * pi * baseband_.carrier / sound_speed_;
  for (std::size_t n = 0; n < phones_.size(); ++n)
    x[n] *= std::polar(1.0, (k - carrier) * beam.dot(phones_[n] - shape_.centre));
  d.look = refine_direction(x, phones_, shape_, weights_, beam, spacing_, k);
  const double elevation = std::asin(std::clamp(-d.look.z(), -1.0, 1.0));
  const double bearing = std::atan2(d.look.x(), d.look.y());
  if (shape_.kind == ArrayKind::line) {
    d.cosine = d.look.dot(shape_.axis);
    if (shape_.upright())
      d.elevation = std::asin(std::clamp(shape_.axis.z() < 0.0 ? d.cosine : -d.cosine, -1.0, 1.0));
    else
      d.bearing = bearing;
    return;
  }
  d.bearing = bearing;
  if (shape_.bent)
    d.cosine = d.look.dot(shape_.axis);
  else
    d.elevation = elevation;
}

}  // namespace asdic::detail
