#pragma once
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "raytrace/layered/column_lanes.h"

namespace asdic {

/// The legs of an interval of the fan as Chebyshev series in σ, for stretches with many roots: a
/// few walks through the column serve them all. They are evaluated as polynomials: terms that fall
/// as 4^(−n), as those of a good series do, make coefficients that do not grow (2^(n − 1) each).
///
/// r/ξ, σ·dr/dξ, τ − ξr (whose error is of second order in that of σ) and the length of the three
/// pieces are smooth in σ. Whether the series are right to rounding is told by their last terms.
class LegSeries {
 public:
  /// \param c_ref  of σ [m/s]   \param low, high  σ between two nodes of the fan
  LegSeries(const Column& column, double c_ref, double low, double high);

  /// Ranges right to a micrometre, times to a picosecond, slopes to 3e-8 of themselves.
  [[nodiscard]] bool good() const noexcept { return good_; }
  [[nodiscard]] ColumnLanes sums(const RayLanes& rays) const noexcept;
  [[nodiscard]] ColumnLanes all(const RayLanes& rays) const noexcept;

 private:
  static constexpr std::size_t terms = 16;
  enum Quantity : std::size_t { per_slowness, d_range, intercept, length, quantities };
  /// Of up, middle and down.
  using Series = std::array<std::array<double, 3>, terms>;

  void to_polynomials() noexcept;
  /// Of two quantities of three legs each, at once: a quantity by itself would wait for its own
  /// last product.
  [[nodiscard]] std::array<std::array<Rays, 3>, 2> values(Quantity first, Quantity second,
                                                          const RayLanes& rays) const noexcept;
  [[nodiscard]] bool holds(Quantity of, double relative, double absolute) const noexcept;

  double middle_, per_half_;
  std::array<Series, quantities> series_{};
  bool turns_above_ = false, turns_below_ = false, good_ = false;
};

/// Series over stretches of an interval, from node to node, made where they are wanted and as short
/// as they must be.
class IntervalSeries {
 public:
  /// \param nodes  [n] increasing σ of the interval's nodes
  IntervalSeries(const Column& column, double c_ref, std::span<const double> nodes);

  /// One that holds between nodes `cell` and `cell` + 1, or nullptr if none does.
  [[nodiscard]] const LegSeries* at(std::size_t cell);
  /// Cells [first, last) that share a series with this one, as far as is known.
  struct Cells {
    std::size_t first, last;
  };
  [[nodiscard]] Cells around(std::size_t cell) const noexcept;

 private:
  struct Piece {
    std::size_t first, last;  ///< cells
    std::unique_ptr<LegSeries> series = nullptr;
  };
  [[nodiscard]] std::size_t piece_of(std::size_t cell) const noexcept;

  const Column& column_;
  double c_ref_;
  std::span<const double> nodes_;
  std::vector<Piece> pieces_;  ///< in order
};

}  // namespace asdic
