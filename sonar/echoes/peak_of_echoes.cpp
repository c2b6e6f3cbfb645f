#include "sonar/echoes/peak_of_echoes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/rotate_back.h"
#include "core/units.h"
#include "sonar/signal/complex_product.h"

namespace asdic::detail {
namespace {

/// Sums of the envelope in blocks of even steps, loudest first.
class PeakSearch {
 public:
  PeakSearch(const Pulse& pulse, std::span<const EchoPath> echoes, const BandLimitedPulse& recorded)
      : recorded_(recorded),
        half_pulse_(0.5 * pulse.duration()),
        frequency_(pulse.centre_frequency()) {
    const double half_duration = recorded.half_duration();
    double lowest = infinity, highest = 0.0;
    for (const EchoPath& echo : echoes) {
      const Return& received = echo.received;
      lowest = std::min(lowest, received.doppler);
      highest = std::max(highest, received.doppler);
      const double beside = (half_duration - half_pulse_) / received.doppler;
      const double last = received.delay + 2.0 * half_pulse_ / received.doppler;
      const auto& curve = echo.curve;
      echoes_.push_back({.path = &echo,
                         .begin = (curve ? curve->first_received() : received.delay) - beside,
                         .end = (curve ? curve->last_received() : last) + beside});
      longest_ = std::max(longest_, echoes_.back().end - echoes_.back().begin);
    }
    std::sort(echoes_.begin(), echoes_.end(),
              [](const Echo& a, const Echo& b) { return a.begin < b.begin; });
    // The envelope has frequencies up to the band of one echo plus the difference of the Doppler
    // shifts.
    step_ = 0.25 / (recorded.half_band() * highest + 0.5 * frequency_ * (highest - lowest));
    weigh();
  }

  [[nodiscard]] double largest() const {
    constexpr double close = 1.002;  // 0.02 dB
    double peak = 0.0;
    for (const Block& block : blocks()) {
      if (block.bound <= close * peak) break;
      peak = std::max(peak, largest_in(block.number));
    }
    return peak;
  }

 private:
  static constexpr std::size_t width = 64;             // samples per block
  static constexpr std::size_t looked_at = width + 2;  // and a neighbour on either side

  struct Echo {
    const EchoPath* path;
    double begin, end;  // times between which it is received [s]
    double most = 0.0;  // bound of its envelope
  };
  struct Block {
    double bound;
    std::int64_t number;
  };

  /// Bounds every echo by the largest envelope of the pulse.
  void weigh() {
    constexpr double between = 1.05;  // allowance for peaks between samples 0.25/half_band apart
    double largest = 0.0;
    for (double u = -recorded_.half_duration(); u < recorded_.half_duration(); u += step_)
      largest = std::max(largest, between * std::abs(recorded_.at(u)));
    for (Echo& echo : echoes_) echo.most = largest * std::abs(echo.path->received.amplitude);
  }

  [[nodiscard]] double time(std::int64_t sample) const {
    return echoes_.front().begin + static_cast<double>(sample) * step_;
  }
  [[nodiscard]] std::int64_t block_at(double t) const {
    return static_cast<std::int64_t>((t - echoes_.front().begin) / (step_ * double(width)));
  }

  /// Calls f with each echo that is received in a block.
  template <class F>
  void received_in(std::int64_t block, F&& f) const {
    const double first = time(block * std::int64_t(width) - 1),
                 last = time((block + 1) * std::int64_t(width));
    auto echo = std::lower_bound(echoes_.begin(), echoes_.end(), first - longest_,
                                 [](const Echo& e, double t) { return e.begin < t; });
    for (; echo != echoes_.end() && echo->begin <= last; ++echo)
      if (echo->end >= first) f(*echo);
  }

  /// Blocks in which an echo is received, by falling bound of their envelope.
  [[nodiscard]] std::vector<Block> blocks() const {
    std::vector<Block> found;
    std::int64_t next = 0;
    for (const Echo& echo : echoes_) {
      const std::int64_t last = block_at(echo.end);
      for (next = std::max(next, block_at(echo.begin)); next <= last; ++next) {
        double bound = 0.0;
        received_in(next, [&](const Echo& one) { bound += one.most; });
        found.push_back({bound, next});
      }
    }
    std::sort(found.begin(), found.end(), [](const Block& a, const Block& b) {
      return a.bound != b.bound ? a.bound > b.bound : a.number < b.number;
    });
    return found;
  }

  [[nodiscard]] double largest_in(std::int64_t block) const {
    const std::int64_t first = block * std::int64_t(width) - 1;
    std::array<double, looked_at> t, since, cosine, sine, re, im;
    std::array<std::complex<double>, looked_at> sum{};
    for (std::size_t j = 0; j < looked_at; ++j) t[j] = time(first + std::int64_t(j));
    received_in(block, [&](const Echo& echo) {
      const Return& received = echo.path->received;
      if (echo.path->curve)
        echo.path->curve->sent_at(t, since);
      else
        for (std::size_t j = 0; j < looked_at; ++j)
          since[j] = received.doppler * (t[j] - received.delay);
      for (std::size_t j = 0; j < looked_at; ++j) {
        cosine[j] = 1.0;
        sine[j] = 0.0;
        rotate_back(frequency_ * (t[j] - since[j]), cosine[j], sine[j]);
        since[j] -= half_pulse_;
      }
      recorded_.at(since, re, im);
      for (std::size_t j = 0; j < looked_at; ++j)
        sum[j] += finite_product(received.amplitude,
                                 finite_product<double>({re[j], im[j]}, {cosine[j], sine[j]}));
    });
    double power = 0.0;
    for (std::size_t j = 1; j + 1 < looked_at; ++j) {
      const double before = std::norm(sum[j - 1]), here = std::norm(sum[j]),
                   after = std::norm(sum[j + 1]), bend = before - 2.0 * here + after;
      power = std::max(power, here);
      if (here >= before && here >= after && bend < 0.0)  // top of a parabola
        power = std::max(power, here - 0.125 * (before - after) * (before - after) / bend);
    }
    return std::sqrt(power);
  }

  const BandLimitedPulse& recorded_;
  double half_pulse_, frequency_;
  std::vector<Echo> echoes_;
  double longest_ = 0.0, step_ = 1.0;  // longest echo and step of the samples [s]
};

}  // namespace

double peak_of_echoes(const Pulse& pulse, std::span<const EchoPath> echoes,
                      const BandLimitedPulse& recorded) {
  return echoes.empty() ? 0.0 : PeakSearch(pulse, echoes, recorded).largest();
}

}  // namespace asdic::detail
