#pragma once
#include <array>
#include <optional>
#include <vector>

#include "raytrace/layered/column.h"

namespace asdic {

/// Column::all as Chebyshev series in σ between two nodes of the fan, for stretches with many
/// receivers: twelve walks through the column serve them all.
///
/// Ranges, their slopes dr/dσ, intercept times τ − ξr (whose error is of second order in that of σ)
/// and lengths of the three pieces are smooth there. Whether the series are right to rounding is
/// told by their last terms.
class ColumnFit {
 public:
  /// \param c_ref  of σ [m/s]   \param low, high  σ of the two nodes
  ColumnFit(const Column& column, double c_ref, double low, double high);

  /// Ranges right to a micrometre, times to a picosecond, slopes to 3e-8 of themselves.
  [[nodiscard]] bool good() const noexcept { return good_; }
  [[nodiscard]] ColumnSums sums(const RayParameter& ray) const noexcept;
  [[nodiscard]] Column::All all(const RayParameter& ray) const noexcept;

 private:
  static constexpr int terms = 12, lanes = 8;
  using Lanes = std::array<double, lanes>;
  using Series = std::array<Lanes, terms>;

  [[nodiscard]] Lanes sum(const Series& series, double sigma) const noexcept;
  [[nodiscard]] bool holds(const Series& series, std::size_t lane, double relative,
                           double absolute) const noexcept;

  double middle_, per_half_;
  Series sums_{}, details_{};  // up, middle, down: range, then slope; time, then length
  bool turns_above_ = false, turns_below_ = false, good_ = false;
};

/// Series over halves, quarters … of the stretch between two nodes, where they are needed and as
/// fine as they must be.
class ColumnFits {
 public:
  ColumnFits(const Column& column, double c_ref, double low, double high)
      : column_(&column), c_ref_(c_ref), pieces_{{low, high}} {}

  /// What the column gives, from a series that is right to rounding, or from the walk itself.
  [[nodiscard]] ColumnSums sums(const RayParameter& ray) {
    const ColumnFit* fit = fit_at(ray.sigma);
    return fit != nullptr ? fit->sums(ray) : column_->sums(ray);
  }
  [[nodiscard]] Column::All all(const RayParameter& ray) {
    const ColumnFit* fit = fit_at(ray.sigma);
    return fit != nullptr ? fit->all(ray) : column_->all(ray);
  }

 private:
  static constexpr int deepest = 6;
  struct Piece {
    double low, high;
    int depth = 0;
    std::size_t halves = 0;  ///< index of the first of two, or 0
    std::optional<ColumnFit> fit = std::nullopt;
  };

  [[nodiscard]] const ColumnFit* fit_at(double sigma);

  const Column* column_;
  double c_ref_;
  std::vector<Piece> pieces_;
};

}  // namespace asdic
