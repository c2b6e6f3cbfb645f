#pragma once
#include <complex>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "raytrace/math/bessel_table.h"
#include "reverb/fields/scattering_field.h"

namespace asdic::detail {

/// Mean over an array's phones x of e^{−i2πf·a·x}, a the difference of two slownesses, by what the
/// array is built of:
///
///   n evenly around a ring about c:  e^{−i2πf·a·c}·J₀(2πf·a_h·R)
///   n evenly along a line about c:   e^{−i2πf·a·c}·sin(nφ/2)/(n·sin(φ/2)),  φ = 2πf·a·d
///   others:                          one by one
///
/// Of a ring's mean that leaves out 2·J_n(2πf·a_h·R) and higher orders (Jacobi and Anger), so it is
/// taken where that is below 1e-6.
class PhoneMean {
 public:
  /// \param phones  at least one, relative to any point [m]   \param frequency  [Hz]
  PhoneMean(std::span<const Vec3> phones, double frequency);
  /// \param apart  a [s/m], at most most_apart
  [[nodiscard]] std::complex<double> operator()(const Vec3& apart) const noexcept;
  /// The sum over every phone.
  [[nodiscard]] std::complex<double> plain(const Vec3& apart) const noexcept;

  /// No water carries sound so slowly that two slownesses differ by more [s/m].
  static constexpr double most_apart = 2.0 / slowest_sea;

 private:
  /// Places are times the frequency.
  struct Ring {
    Vec3 centre = Vec3::Zero();
    double radius = 0.0;
    double share = 0.0;          // of the phones
    double furthest = 0.0;       // argument of J₀ that the mean is good to
    std::vector<Vec3> phones{};  // beyond that
  };
  struct Line {
    Vec3 centre = Vec3::Zero(), step = Vec3::Zero();
    double count = 0.0;
  };
  [[nodiscard]] std::optional<Line> line() const;
  /// \param level  phones of one height
  [[nodiscard]] std::optional<Ring> ring(std::vector<Vec3> level) const;

  std::vector<Vec3> phones_;
  std::optional<Line> line_;
  std::vector<Ring> rings_;
  std::vector<Vec3> others_;
  std::optional<BesselTable> bessel_;
};

}  // namespace asdic::detail
