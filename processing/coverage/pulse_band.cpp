#include "processing/coverage/pulse_band.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/units.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {

PulseBand::PulseBand(const Pulse& pulse)
    : centre_(pulse.centre_frequency()), duration_(pulse.duration()) {
  const double rate = 2.0 * pulse.bandwidth_40db();
  const auto samples =
      static_cast<std::size_t>(std::clamp(pulse.duration() * rate, 64.0, 1048576.0));
  // Four lengths of the pulse: its spectrum squared is smooth between such steps.
  const ComplexFft<double> transform(fast_fft_length(4 * samples));
  const std::size_t length = transform.length();
  FftBuffer<std::complex<double>> x(length);
  const double dt = pulse.duration() / static_cast<double>(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = (static_cast<double>(k) + 0.5) * dt;
    x[k] = pulse.analytic(t) * std::polar(1.0, -2.0 * pi * centre_ * t);
  }
  transform.forward(x.data());
  step_ = 1.0 / (dt * static_cast<double>(length));
  power_.resize(length);
  for (std::size_t k = 0; k < length; ++k) power_[(k + length / 2) % length] = std::norm(x[k]);
  for (const double power : power_) fourth_ += power * power;
  // What passes is a correlation: that of the power's transform.
  for (std::size_t k = 0; k < length; ++k) x[k] = power_[k];
  transform.forward(x.data());
  for (std::size_t k = 0; k < length; ++k) x[k] = std::norm(x[k]);
  transform.inverse(x.data());
  passes_.resize(length / 2);
  for (std::size_t k = 0; k < passes_.size(); ++k)
    passes_[k] = std::max(0.0, x[k].real() / x[0].real());
  half_ = step_ * static_cast<double>(passes_.size());
  for (std::size_t k = 0; k < passes_.size(); ++k)
    if (passes_[k] < 0.5) {
      half_ = step_ * static_cast<double>(k);
      break;
    }
}

std::vector<PulseBand::Line> PulseBand::lines(double delay, int most) const {
  // Between those outside which a thousandth lies.
  constexpr double outside = 5e-4;
  double lowest = frequency(0), highest = -lowest, part = 0.0;
  for (std::size_t k = 0; k < power_.size(); ++k) {
    const double before = part;
    part += power_[k] * power_[k] / fourth_;
    if (before < outside && part >= outside) lowest = frequency(k) - 0.5 * step_;
    if (before < 1.0 - outside && part >= 1.0 - outside) highest = frequency(k) + 0.5 * step_;
  }
  constexpr double dense = 2.0;
  const double wanted = std::ceil(dense * delay * (highest - lowest));
  const auto count = static_cast<std::size_t>(std::clamp(wanted, 1.0, double(most)));
  std::vector<Line> found(count);
  for (std::size_t i = 0; i < count; ++i) {
    Line& line = found[i];
    line.lowest = std::lerp(lowest, highest, static_cast<double>(i) / static_cast<double>(count));
    line.highest =
        std::lerp(lowest, highest, static_cast<double>(i + 1) / static_cast<double>(count));
    line.ratio = 1.0 + 0.5 * (line.lowest + line.highest) / centre_;
  }
  return found;
}

/// Between two steps of the spectrum.
double PulseBand::power_at(double place) const noexcept {
  const auto i = static_cast<std::size_t>(std::max(0.0, place));
  if (!(place >= 0.0) || i + 1 >= power_.size()) return 0.0;
  return std::lerp(power_[i], power_[i + 1], place - static_cast<double>(i));
}

std::vector<double> PulseBand::shares(const std::vector<Line>& lines, double shift) const {
  std::vector<double> found(lines.size(), 0.0);
  const double lowest = lines.front().lowest,
               in_lines = static_cast<double>(lines.size()) / (lines.back().highest - lowest);
  double sum = 0.0;
  for (std::size_t k = 0; k < power_.size(); ++k) {
    const double place = (frequency(k) - lowest) * in_lines;
    if (!(place >= 0.0 && place < static_cast<double>(lines.size()))) continue;
    const double share = power_at(static_cast<double>(k) + 0.5 * shift / step_) *
                         power_at(static_cast<double>(k) - 0.5 * shift / step_);
    found[static_cast<std::size_t>(place)] += share;
    sum += share;
  }
  // All of them are what passes at all.
  for (double& share : found) share *= sum > 0.0 ? passes(shift) / sum : 0.0;
  return found;
}

double PulseBand::passes(double shift) const noexcept {
  const double at = std::abs(shift) / step_;
  const auto i = static_cast<std::size_t>(at);
  if (i + 1 >= passes_.size()) return passes_.back();
  return std::lerp(passes_[i], passes_[i + 1], at - static_cast<double>(i));
}

double PulseBand::later(double shift) const noexcept {
  // A sweep over 2·half() answers a shift later by its share of that.
  return std::min(duration_, duration_ * std::abs(shift) / std::max(half_, 1e-9) * 0.5);
}

}  // namespace asdic::detail
