#pragma once
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/level_namespace.h"
#include "core/simd.h"
#include "raytrace/beams/beam.h"
#include "raytrace/beams/boundary_rows.h"
#include "raytrace/beams/crossings.h"

namespace asdic::detail {

inline namespace ASDIC_LEVEL {

/// Sums hat and Gaussian beams in Cartesian coordinates over a rectilinear grid of receivers: what
/// add_beam does, several receivers at a time in single precision (phases are reduced in double
/// before). Agrees with add_beam to some 1e-5 of a beam. docs/theory/fields.md
class ColumnSum {
 public:
  /// \param memory  [room(rows, columns)] for the sum, left as it is at the end
  ColumnSum(const BeamSetting& setting, std::span<const double> depths, std::span<float> memory);

  /// Numbers that a sum takes.
  [[nodiscard]] static std::size_t room(std::size_t rows, std::size_t columns) noexcept {
    return 2 * columns * stride_of(rows);
  }

  /// Adds one beam. \param walls  receivers on the boundaries, which its partner serves too; null:
  /// none
  void add(const BeamLaunch& launch, const Crossings& crossings,
           const BoundaryRows* walls = nullptr);

  /// Leaves nothing at receivers where there is nothing to be had (BoundaryRows::silent): add()
  /// left the partners out there.
  void silence(const BoundaryRows& walls);

  /// Adds what another sum of the same receivers has.
  void absorb(const ColumnSum& other);

  /// Pressure, or intensity in the real part.
  [[nodiscard]] std::complex<double> at(std::size_t column, std::size_t row) const noexcept {
    const std::size_t i = column * stride_ + row;
    if (paired_) return {static_cast<double>(sum_[2 * i]), static_cast<double>(sum_[2 * i + 1])};
    return {static_cast<double>(real_[i]),
            setting_.coherent ? static_cast<double>(imaginary_[i]) : 0.0};
  }

 private:
  /// How a crossing is added.
  enum class Way : std::int8_t {
    none,     ///< reaches no receiver
    plain,    ///< one by one: so steep a ray that its beam widens as fast as it is left
    several,  ///< several receivers at a time
  };
  /// From column to column: groups of rows may begin at the last row.
  [[nodiscard]] static std::size_t stride_of(std::size_t rows) noexcept {
    return (rows + 2 * simd_width - 1) / simd_width * simd_width;
  }

  template <bool is_hat>
  void prepare(const BeamLaunch& launch, const Crossings& crossings);
  void find_rows(const Crossings& crossings);
  void find_rows_of_half(const Crossings& crossings);
  void find_even(std::size_t n);
  [[nodiscard]] Way way(std::size_t i) const noexcept;
  template <bool coherent, bool is_hat>
  void add_rows(const Crossings& crossings);
  template <bool coherent, bool is_hat>
  void add_crossing_rows(const Crossings& crossings, std::size_t i);
  void find_places(const Crossings& crossings);
  template <bool coherent>
  std::size_t pack_hats(const Crossings& crossings);
  template <bool coherent>
  void add_hats(const Crossings& crossings);
  void add_even_gaussians(const Crossings& crossings);
  void add_simd(std::size_t at, const SimdFloats& re, const SimdFloats& im);
  void add_plainly(const Crossings& crossings, std::size_t i);
  void add_number(std::size_t at, const std::complex<double>& p);
  [[nodiscard]] Crossing crossing_at(const Crossings& x, std::size_t i) const;

  /// The half of a hat that is being added.
  enum class Half : std::int8_t { both, higher, lower };
  void add_half(const BeamLaunch& launch, const Crossings& crossings, Half half);
  void add_partners(const Crossings& crossings, const BoundaryRows& walls);
  void add_partner(const Crossings& crossings, std::size_t i, BoundaryKind kind, std::size_t row,
                   const BoundaryRows& walls);

  BeamSetting setting_;
  double spacing_of_fan_ = 0.0;
  Half half_ = Half::both;
  std::span<const double> depths_;
  std::vector<double> padded_depths_;  // [rows + lanes], the last ones far away
  std::size_t stride_ = 0;             // from column to column
  double first_depth_ = 0.0;
  double spacing_ = 0.0, per_spacing_ = 0.0;  // of evenly spaced depths [m], else 0
  bool paired_ = false;                // of narrow hats: real and imaginary parts side by side
  std::span<float> sum_;               // [columns × stride × 2] if paired, else
  std::span<float> real_, imaginary_;  // [columns × stride]

  // Of one beam, [crossings].
  BeamLaunch launch_;
  double launched_ = 1.0;
  std::vector<float> amplitude_, phase_, wave_number_;  // at the ray; dφ/dz
  std::vector<float> cosine_, sine_, q_, growth_;       // |cos θ|, sin θ, q, dq/dz
  std::vector<float> least_;                            // least σ of a Gaussian
  std::vector<float> offset_;                           // of the first row from the ray [m]
  std::vector<double> above_, below_;                   // how far the beam reaches [m]
  std::vector<std::int32_t> first_, last_;              // rows within reach, [first, last)
  std::vector<std::int32_t> place_, rows_;  // of add_hats: of the first row in the sum, how many
  std::vector<std::int32_t> is_even_;       // for add_even_gaussians
};

}  // namespace ASDIC_LEVEL

}  // namespace asdic::detail
