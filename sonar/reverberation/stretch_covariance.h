#pragma once
#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "core/level_namespace.h"
#include "sonar/reverberation/all_round_covariance.h"
#include "sonar/reverberation/heard_places.h"

namespace asdic {

/// What is heard of a circle. Both slownesses lie in one vertical plane.
[[nodiscard]] inline HeardAllRound from_all_round(const Heard& h) noexcept {
  return {.one = std::norm(h.one),
          .other = std::norm(h.other),
          .both = h.one * std::conj(h.other),
          .level_one = h.one_slowness.head<2>().norm(),
          .down_one = h.one_slowness.z(),
          .level_other = h.other_slowness.head<2>().norm(),
          .down_other = h.other_slowness.z()};
}

/// Phases of a direction at every component: k·phones + n is phone n at frequency f_k. Private to
/// the reverberation's covariance, as is all of this file.
class Steering {
 public:
  /// \param phones  [m]   \param frequencies  f_k [Hz]
  Steering(std::span<const Vec3> phones, std::span<const double> frequencies);
  [[nodiscard]] std::size_t components() const noexcept { return x_.size(); }
  /// column += amplitude·e^{−i2πf_k s·x_n}. \param s  slowness [s/m]   \param column  [components]
  void add(std::complex<double> amplitude, const Vec3& s, std::complex<double>* column) const;

 private:
  std::vector<double> x_, y_, z_;  // of phones, times the frequency [m/s]
};

/// The covariance of what is heard in one stretch of delays, and its factor.
class StretchSum {
 public:
  StretchSum(const Steering& steering, const AllRoundArray& all_round);
  ~StretchSum();  // matrices are given back by the code that made them: alignment goes with levels

  /// Adds what one place sends back, and finds its power.
  void add(Heard& h);
  /// F with F F^H = C but for a millionth of its trace, C the sum over its mean diagonal: columns
  /// of Cholesky's factorisation with pivots, until no more than that is left. \param columns  that
  /// F's are appended to \return rank; 0: nothing is heard
  [[nodiscard]] std::size_t factor(std::vector<std::complex<float>>& columns);

 private:
  using Matrix = Eigen::MatrixXcd;
  static constexpr Eigen::Index block = 64;  // columns that are added up at one time
  void take();

  const Steering& steering_;
  const AllRoundArray& array_;
  AllRoundSum all_round_;
  Matrix columns_, sum_;
  Eigen::Index used_ = 0;
};

}  // namespace asdic
