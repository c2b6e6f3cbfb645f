#pragma once
#include <cmath>
#include <limits>
#include <variant>

namespace asdic::detail::study {

/// An interval, or one value.
struct Span {
  double low = 0.0, high = 0.0;
  [[nodiscard]] bool single() const noexcept { return low == high; }
  [[nodiscard]] double at(double u) const noexcept { return std::lerp(low, high, u); }
};

/// How a number is distributed: lower and upper tail and their inverses. Each tail is computed by
/// itself, so that a law cut off far out keeps its digits. docs/theory/designs.md
struct Uniform {
  double low = 0.0, high = 1.0;
};
struct Normal {
  double mean = 0.0, deviation = 1.0;
};
/// exp of a normal: `median`, and the standard deviation of the natural logarithm.
struct LogNormal {
  double median = 1.0, log_deviation = 1.0;
};
struct Triangular {
  double low = 0.0, mode = 0.5, high = 1.0;
};
/// 1 − exp(−(x/scale)^shape), x ≥ 0. Of winds: shape about 2.
struct Weibull {
  double shape = 2.0, scale = 1.0;
  /// Weibull's law of shape 2; its mean is √π/2 of the scale.
  [[nodiscard]] static Weibull rayleigh(double mean);
  [[nodiscard]] static Weibull of_mean(double shape, double mean);
};

using ContinuousLaw = std::variant<Uniform, Normal, LogNormal, Triangular, Weibull>;

/// Two complementary probabilities, P(X ≤ x) and P(X > x).
struct Tails {
  double lower = 0.0, upper = 1.0;
};
[[nodiscard]] Tails tails(const ContinuousLaw& law, double x) noexcept;
/// The x of given tails: by the smaller of the two. \param t  lower + upper = 1
[[nodiscard]] double quantile(const ContinuousLaw& law, const Tails& t) noexcept;

/// dP(X ≤ x)/dx; 0 beyond the law's ends.
[[nodiscard]] double density(const ContinuousLaw& law, double x) noexcept;

/// A law cut off at both ends: X given that low ≤ X ≤ high.
class CutLaw {
 public:
  CutLaw() : CutLaw(Uniform{}) {}
  explicit CutLaw(ContinuousLaw law, double low = -std::numeric_limits<double>::infinity(),
                  double high = std::numeric_limits<double>::infinity()) noexcept;

  /// The value below which a share u of the draws lies. \param u  in (0, 1)
  [[nodiscard]] double quantile(double u) const noexcept;
  [[nodiscard]] double distribution(double x) const noexcept;  ///< P(X ≤ x)
  [[nodiscard]] double density(double x) const noexcept;       ///< dP(X ≤ x)/dx
  /// How much of the law lies within the limits; 0: nothing, and no value can be drawn.
  [[nodiscard]] double share() const noexcept;
  [[nodiscard]] const ContinuousLaw& law() const noexcept { return law_; }
  [[nodiscard]] double low() const noexcept { return low_; }
  [[nodiscard]] double high() const noexcept { return high_; }
  /// Where what is drawn ends: at a limit or where the law itself does; infinite where neither.
  [[nodiscard]] Span ends() const noexcept;

 private:
  ContinuousLaw law_;
  double low_, high_;
  Tails at_low_, at_high_;
};

/// Inverse of the standard normal distribution by its smaller tail. \param p  P(Z > z), 0 < p ≤ ½
[[nodiscard]] double normal_upper_quantile(double p) noexcept;
/// Φ⁻¹(u), by the smaller tail.
[[nodiscard]] double normal_score(double u) noexcept;
/// Φ(z), never 0 or 1.
[[nodiscard]] double normal_share(double score) noexcept;

}  // namespace asdic::detail::study
