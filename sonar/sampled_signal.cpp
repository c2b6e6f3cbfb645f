#include "sonar/sampled_signal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "sonar/kaiser_window.h"

namespace asdic {
namespace {

constexpr int half_width = 12;            // samples on either side
constexpr int table_steps = 1024;         // of the window between its centre and its edge
constexpr double kaiser_beta = 4.0 * pi;  // stop band of −110 dB, reached within half the spectrum

using WindowTable = std::array<double, table_steps + 3>;

/// x = 0…1.
WindowTable make_window() {
  WindowTable table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double x = std::min(1.0, static_cast<double>(i) / table_steps);
    table[i] = kaiser_window(x, kaiser_beta);
  }
  return table;
}

/// Quadratic interpolation in the table: an error of h³/16·|w‴| < 1e-8.
double window(double distance) noexcept {
  static const WindowTable table = make_window();
  const double position = distance * (table_steps / static_cast<double>(half_width));
  const auto i = static_cast<std::size_t>(position);
  if (i >= table_steps) return 0.0;
  const double f = position - static_cast<double>(i);
  const double a = table[i], b = table[i + 1], c = table[i + 2];
  return a + f * ((b - a) - 0.5 * (1.0 - f) * (c - 2.0 * b + a));
}

}  // namespace

SampledSignal::SampledSignal(std::vector<std::complex<double>> samples, double first, double rate)
    : samples_(std::move(samples)), first_(first), rate_(rate) {}

std::complex<double> SampledSignal::at(double t) const noexcept {
  const double position = (t - first_) * rate_;
  const auto count = static_cast<double>(samples_.size());
  if (!(position > -half_width && position < count - 1.0 + half_width)) return 0.0;
  const double nearest = std::round(position);
  const double offset = position - nearest;  // −½ … ½
  const auto centre = static_cast<std::ptrdiff_t>(nearest);
  if (std::abs(offset) < 1e-12)
    return centre >= 0 && centre < std::ssize(samples_) ? samples_[static_cast<std::size_t>(centre)]
                                                        : 0.0;
  // sin(π(offset − j)) = (−1)^j sin(π offset): one sine serves all taps.
  const double sine = std::sin(pi * offset) / pi;
  std::complex<double> sum = 0.0;
  const std::ptrdiff_t first = std::max<std::ptrdiff_t>(centre - half_width, 0);
  const std::ptrdiff_t last = std::min(centre + half_width, std::ssize(samples_) - 1);
  for (std::ptrdiff_t i = first; i <= last; ++i) {
    const double x = position - static_cast<double>(i);
    const double sinc = ((i - centre) % 2 == 0 ? sine : -sine) / x;
    sum += sinc * window(std::abs(x)) * samples_[static_cast<std::size_t>(i)];
  }
  return sum;
}

}  // namespace asdic
