#pragma once
#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "core/level_namespace.h"
#include "reverb/power/received_places.h"
#include "sonar/reverberation/azimuthally_symmetric_covariance.h"

namespace asdic::detail {

/// What is received of a circle. Both slownesses lie in one vertical plane.
[[nodiscard]] inline ReceivedAzimuthally from_azimuthally_symmetric(const Received& h) noexcept {
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

/// The covariance of what is received in one segment of delays, and its factor.
class SegmentSum {
 public:
  SegmentSum(const Steering& steering, const AzimuthallySymmetricArray& azimuthally_symmetric);
  ~SegmentSum();  // matrices are given back by the code that made them: alignment goes with levels

  /// Adds what one place sends back, and finds its power.
  void add(Received& h);
  /// F with F F^H = C but for a millionth of its trace, C the sum over its mean diagonal: columns
  /// of Cholesky's factorisation with pivots, until no more than that is left. \param columns  that
  /// F's are appended to \return rank; 0: nothing is received
  [[nodiscard]] std::size_t factor(std::vector<std::complex<float>>& columns);

 private:
  using Matrix = Eigen::MatrixXcd;
  static constexpr Eigen::Index block = 64;  // columns that are added up at one time
  void take();

  const Steering& steering_;
  const AzimuthallySymmetricArray& array_;
  AzimuthallySymmetricSum azimuthally_symmetric_;
  Matrix columns_, sum_;
  Eigen::Index used_ = 0;
};

}  // namespace asdic::detail
