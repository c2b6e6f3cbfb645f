#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

namespace asdic::detail::support {

/// Kolmogorov's distance of samples from a law, sup|F_n − F|. P(√n·D > x) = 2·exp(−2x²): 1e-6 at x
/// = 2.69. \param law  F(x)
template <class Number, class Law>
double kolmogorov_distance(std::vector<Number> samples, Law&& law) {
  std::sort(samples.begin(), samples.end());
  const double n = double(samples.size());
  double furthest = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double f = law(double(samples[i]));
    furthest = std::max({furthest, (double(i) + 1.0) / n - f, f - double(i) / n});
  }
  return furthest;
}

/// F of an intensity of mean 1 whose envelope is Rayleigh's.
inline double exponential_law(double x) { return 1.0 - std::exp(-x); }

}  // namespace asdic::detail::support
