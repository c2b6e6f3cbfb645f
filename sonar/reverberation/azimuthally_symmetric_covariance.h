#pragma once
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/units.h"
#include "raytrace/math/bessel_table.h"

namespace asdic::detail {

/// What one circle of places sends back by one pair of paths and, where the delay is the same, by
/// its reciprocal: from all bearings alike.
struct ReceivedAzimuthally {
  double one = 0.0, other = 0.0;    ///< |a|², |b|²
  std::complex<double> both = 0.0;  ///< a·b*
  /// Arriving: horizontally towards the array, and downwards [s/m].
  double level_one = 0.0, down_one = 0.0, level_other = 0.0, down_other = 0.0;
};

/// An array as sound from all bearings meets it: component (k, m), phone m at f_k, is number
/// k·phones + m. Private to the reverberation's covariance, as is all of this file.
///
/// The mean over bearings of e^{−i2π(f_k s_a·x_m − f_l s_b·x_n)}, s_a and s_b in one vertical plane
/// with level parts ξ and downward parts ζ, is J₀(2π|ξ_a f_k x_m − ξ_b f_l x_n|)·e^{−i2π(ζ_a f_k
/// z_m − ζ_b f_l z_n)}.
class AzimuthallySymmetricArray {
 public:
  /// \param phones  [m]   \param frequencies  f_k [Hz]   \param fastest  level slowness [s/m]
  AzimuthallySymmetricArray(std::span<const Vec3> phones, std::span<const double> frequencies,
                            double fastest);
  [[nodiscard]] std::size_t components() const noexcept { return components_; }
  /// Mean over components of what they receive.
  [[nodiscard]] double power(const ReceivedAzimuthally& received) const noexcept;

 private:
  friend class AzimuthallySymmetricSum;
  /// By what two components differ.
  struct Apart {
    double level = 0.0;  // 2π|f_k x_m − f_l x_n| [rad m/s]
    double down = 0.0;   // f_k z_m − f_l z_n [m/s]
    auto operator<=>(const Apart&) const = default;
  };
  std::size_t components_;
  bool flat_ = true;      // all phones at the depth of the reference
  bool mirrored_ = true;  // (m, n) differ as their opposite numbers do, counted from the end
  double alike_level_ = 0.0, alike_down_ = 0.0;  // what differs no more is received alike [s/m]
  std::vector<double> gram_;           // [components²] (2π)²·f_k x_m·f_l x_n, horizontal parts
  std::vector<double> reach_, depth_;  // [components] 2π·|f_k x_m|, f_k z_m
  std::vector<Apart> apart_;           // those that differ from one another
  std::vector<std::uint32_t> which_;   // [components × components], lower triangle: of these
  BesselTable bessel_;
};

/// A sum of covariances of what is received from all bearings. Sounds that arrive so alike that no
/// phone's phase against the reference differs by more than 0.05 rad are one sound of their mean
/// slowness: the covariance is right to ½·0.1²/12 = 4e-4 of theirs.
class AzimuthallySymmetricSum {
 public:
  explicit AzimuthallySymmetricSum(const AzimuthallySymmetricArray& array);
  void add(const ReceivedAzimuthally& received);
  /// Adds it to a Hermitian matrix. \param into  [components²] column by column
  void add_to(std::span<std::complex<double>> into) const;
  /// The same of a sum that is real().
  void add_to(std::span<double> into) const;
  /// Nothing but real numbers was added up.
  [[nodiscard]] bool real() const noexcept { return array_.flat_ && real_; }

 private:
  /// Two slownesses, level and downward part of each [s/m]; of a sound's own power twice the same.
  using Slownesses = std::array<double, 4>;
  struct Sound {
    std::complex<double> power;
    double weight;               // Σ|power|
    Slownesses first, weighted;  // of the first; Σ|power|·slowness
    [[nodiscard]] Slownesses mean() const noexcept;
  };
  void add_sound(std::complex<double> power, const Slownesses& s, std::vector<Sound>& sounds) const;
  void add_own(const Sound& sound, std::span<double> re, std::span<double> im) const;
  void add_between(const Sound& sound, std::span<double> re, std::span<double> im,
                   std::span<double> arguments) const;
  template <class Number>
  void add_all_to(std::span<Number> into) const;

  const AzimuthallySymmetricArray& array_;
  std::vector<Sound> own_, between_;  // |a|² and |b|²; a·b*
  bool real_ = true;
};

}  // namespace asdic::detail
