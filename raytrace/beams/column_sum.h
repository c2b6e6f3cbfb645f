#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raytrace/beams/beam.h"
#include "raytrace/beams/crossings.h"

namespace asdic {

/// Sums hat and Gaussian beams in Cartesian coordinates over a rectilinear grid of receivers: what
/// add_beam does, several receivers at a time in single precision (phases are reduced in double
/// before). Agrees with add_beam to some 1e-5 of a beam. docs/theory/fields.md
class ColumnSum {
 public:
  ColumnSum(const BeamSetting& setting, std::span<const double> depths, std::size_t columns);

  /// Adds one beam.
  void add(const BeamLaunch& launch, const Crossings& crossings);

  /// Pressure, or intensity in the real part.
  [[nodiscard]] std::complex<double> at(std::size_t column, std::size_t row) const noexcept {
    const std::size_t i = column * stride_ + row;
    return {static_cast<double>(real_[i]),
            imaginary_.empty() ? 0.0 : static_cast<double>(imaginary_[i])};
  }

 private:
  /// How a crossing is added.
  enum class Way : std::int8_t {
    none,   ///< reaches no receiver
    plain,  ///< one by one: so steep a ray that its beam widens as fast as it is left
    lanes,  ///< several at a time
  };

  void prepare(const BeamLaunch& launch, const Crossings& crossings);
  void find_rows(const Crossings& crossings);
  void find_rows_of_half(const Crossings& crossings);
  void find_even(std::size_t n);
  [[nodiscard]] Way way(std::size_t i) const noexcept;
  template <bool coherent, bool is_hat>
  void add_rows(const Crossings& crossings);
  template <bool coherent, bool is_hat>
  void add_crossing_rows(const Crossings& crossings, std::size_t i);
  template <bool coherent>
  void add_narrow_hats(const Crossings& crossings);
  void add_even_gaussians(const Crossings& crossings);
  void add_plainly(const Crossings& crossings, std::size_t i);

  /// The half of a hat that is being added.
  enum class Half : std::int8_t { both, higher, lower };
  void add_half(const BeamLaunch& launch, const Crossings& crossings, Half half);

  BeamSetting setting_;
  double spacing_of_fan_ = 0.0;
  Half half_ = Half::both;
  std::span<const double> depths_;
  std::vector<double> padded_depths_;  // [rows + lanes], the last ones far away
  std::size_t stride_ = 0;             // floats from column to column
  double first_depth_ = 0.0;
  double spacing_ = 0.0, per_spacing_ = 0.0;  // of evenly spaced depths [m], else 0
  std::vector<float> real_, imaginary_;       // [columns × stride]

  // Of one beam, [crossings].
  BeamLaunch launch_;
  double launched_ = 1.0;
  std::vector<float> amplitude_, phase_, wave_number_;  // at the ray; dφ/dz
  std::vector<float> cosine_, sine_, q_, growth_;       // |cos θ|, sin θ, q, dq/dz
  std::vector<float> least_;                            // least σ of a Gaussian
  std::vector<float> offset_;                           // of the first row from the ray [m]
  std::vector<double> above_, below_;                   // how far the beam reaches [m]
  std::vector<std::int32_t> first_, last_;              // rows within reach, [first, last)
  std::vector<std::int32_t> is_even_;                   // for add_even_gaussians
};

}  // namespace asdic
