#include "processing/pulse_ambiguity.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <variant>

#include "core/units.h"
#include "raytrace/parallel/parallel.h"
#include "sonar/signal/complex_product.h"
#include "sonar/signal/fft.h"

namespace asdic::detail {
namespace {

constexpr int columns_aside = 120, rows_aside = 60;  // of the middle
constexpr double greatest_offset = 0.05;             // of a Doppler factor from 1
constexpr double most_work = 1e8;                    // samples in all rows

struct Extent {
  double reach;  // [s]
  double shift;  // [Hz]
};

/// What there is to see of each kind, in units of its own structure.
Extent extent_of(const Pulse& pulse) {
  const double whole = pulse.duration(), fine = 1.0 / whole;
  const PulseSettings& s = pulse.settings();
  const auto of_nails = [&](double shift) {
    return Extent{whole, std::clamp(shift, 4.0 * fine, 100.0 * fine)};
  };
  struct {
    const Pulse& pulse;
    const PulseSettings& s;
    double fine;
    decltype(of_nails)& nails;

    [[nodiscard]] Extent sweep() const {
      const double cell = 1.0 / std::max(pulse.bandwidth_99(), fine);
      return {std::min(pulse.duration(), 15.0 * cell), 10.0 * fine};
    }
    Extent operator()(const Cw&) const { return nails(0.0); }
    Extent operator()(const SampledPulse&) const { return nails(0.0); }
    Extent operator()(const Lfm&) const { return sweep(); }
    Extent operator()(const Hfm&) const { return sweep(); }
    Extent operator()(const Sfm& w) const { return nails(3.5 * w.modulation_frequency); }
    Extent operator()(const Costas& w) const {
      const PulseFrequencies f = w.frequencies(s.duration);
      return nails(1.1 * (f.highest - f.lowest));
    }
    Extent operator()(const Ptfm& w) const { return nails(3.5 * w.sweeps * fine); }
    Extent operator()(const PulseTrain& w) const {
      return nails(3.5 / w.repeats(s.duration).interval);
    }
    Extent operator()(const GeometricComb& w) const {
      return nails(1.1 * std::abs(w.end_frequency - w.start_frequency));
    }
  } const of{pulse, s, fine, of_nails};
  return std::visit(of, s.waveform);
}

}  // namespace

PulseAmbiguity pulse_ambiguity(const Pulse& pulse) {
  const Extent extent = extent_of(pulse);
  return pulse_ambiguity(pulse, extent.reach, extent.shift);
}

PulseAmbiguity pulse_ambiguity(const Pulse& pulse, double reach, double shift) {
  const double centre = pulse.centre_frequency(), length = pulse.duration();
  const double offset = std::min(shift / centre, greatest_offset);
  const double column = reach / columns_aside, row = offset / rows_aside;
  const double band = pulse.bandwidth_40db() + 2.4 * offset * centre;
  const double rate = std::max(2.0 * band, 2.0 / column);
  const auto samples = static_cast<std::size_t>(std::ceil(length * rate)) + 1;
  const auto longest = static_cast<std::size_t>(std::ceil(length / (1.0 - offset) * rate)) + 1;
  const std::size_t n = fast_fft_length(samples + longest);
  // Rows between the rows, half a cycle over the pulse apart: no line is missed.
  constexpr double rows = 2.0 * rows_aside + 1.0;
  const double wanted = std::ceil(2.0 * row * centre * length);
  const auto between =
      static_cast<int>(
          std::clamp(std::min(wanted, most_work / (rows * static_cast<double>(n))), 1.0, 63.0)) |
      1;

  const auto spectrum_of = [&](double doppler) {
    FftBuffer<std::complex<double>> x(n);
    const auto count =
        std::min(n, static_cast<std::size_t>(std::ceil(length / doppler * rate)) + 1);
    for (std::size_t i = 0; i < count; ++i) {
      const double t = static_cast<double>(i) / rate;
      x[i] = pulse.analytic(doppler * t) *
             std::polar(1.0, -2.0 * pi * std::remainder(centre * t, 1.0));
    }
    ComplexFft<double>(n).forward(x.data());
    return x;
  };
  const FftBuffer<std::complex<double>> filter = spectrum_of(1.0);
  double energy = 0.0;  // n·Σ|x|² by Parseval's theorem
  for (std::size_t i = 0; i < n; ++i) energy += std::norm(filter[i]);

  PulseAmbiguity found;
  for (int i = -columns_aside; i <= columns_aside; ++i) found.delays.push_back(i * column);
  for (int i = -rows_aside; i <= rows_aside; ++i) found.dopplers.push_back(1.0 + i * row);
  const std::size_t width = found.delays.size();
  found.power.assign(found.dopplers.size() * width, 0.0);
  in_parallel(found.dopplers.size(), [&](std::size_t r) {
    for (int k = 0; k < between; ++k) {
      const double doppler = found.dopplers[r] + row * ((k + 0.5) / between - 0.5);
      FftBuffer<std::complex<double>> cross = spectrum_of(doppler);
      for (std::size_t i = 0; i < n; ++i) cross[i] = finite_product(cross[i], std::conj(filter[i]));
      ComplexFft<double>(n).inverse(cross.data());
      for (std::size_t c = 0; c < width; ++c) {
        // An echo that is late by τ meets the filter where it is shifted back by τ.
        const auto first =
            static_cast<std::ptrdiff_t>(std::floor((found.delays[c] - 0.5 * column) * rate));
        const auto last =
            static_cast<std::ptrdiff_t>(std::ceil((found.delays[c] + 0.5 * column) * rate));
        double most = 0.0;
        for (std::ptrdiff_t m = first; m <= last; ++m) {
          const auto at =
              static_cast<std::size_t>(m <= 0 ? -m : static_cast<std::ptrdiff_t>(n) - m);
          if (at < n) most = std::max(most, std::norm(cross[at]));
        }
        double& cell = found.power[r * width + c];
        cell = std::max(cell, most * doppler / (energy * energy));
      }
    }
  });
  return found;
}

}  // namespace asdic::detail
