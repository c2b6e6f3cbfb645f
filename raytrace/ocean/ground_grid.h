#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace asdic::detail {

/// The cells of a ground: rings around the source, `spacing` wide; beyond the first of them wider,
/// and right at a source that is near to the ground finer.
class GroundGrid {
 public:
  GroundGrid() = default;
  GroundGrid(double spacing) : spacing_(spacing), wide_(spacing) {}  // NOLINT: all alike
  /// \param wide  at least the spacing   \param near  up to which cells are no wider [m]
  GroundGrid(double spacing, double wide, double near)
      : spacing_(spacing),
        wide_(wide),
        near_cells_(wide > spacing ? std::ceil(near / spacing) : 0.0) {}

  /// The first rings, up to four times a source's height over the ground, no wider than an eighth
  /// of that. \param height  [m]
  [[nodiscard]] GroundGrid fine_below(double height) const noexcept {
    constexpr double per_height = 8.0, heights = 4.0, most = 64.0;
    GroundGrid grid = *this;
    const double parts = std::min(most, std::ceil(per_height * spacing_ / std::max(height, 1e-3)));
    if (!(parts > 1.0)) return grid;
    grid.divided_ = std::ceil(heights * height / spacing_);
    grid.parts_ = parts;
    return grid;
  }

  [[nodiscard]] double spacing() const noexcept { return spacing_; }  ///< [m]
  [[nodiscard]] double wide() const noexcept { return wide_; }        ///< [m]
  /// Of the cells about a range, but for wide ones [m].
  [[nodiscard]] double spacing_at(double range) const noexcept {
    return range < divided_ * spacing_ ? spacing_ / parts_ : spacing_;
  }
  /// The same grid without the fine cells.
  [[nodiscard]] GroundGrid without_fine() const noexcept {
    GroundGrid grid = *this;
    grid.divided_ = 0.0;
    grid.parts_ = 1.0;
    return grid;
  }
  /// Of the cells about a range, wide ones too [m].
  [[nodiscard]] double width_at(double range) const noexcept {
    return range < near_cells_ * spacing_ || !(wide_ > spacing_) ? spacing_at(range) : wide_;
  }
  /// The centre of a cell [m].
  [[nodiscard]] double range(std::size_t cell) const noexcept {
    const double fine = divided_ * parts_;
    if (double(cell) < fine) return (double(cell) + 0.5) * (spacing_ / parts_);
    const double i = double(cell) - fine + divided_;
    return i < near_cells_ ? (i + 0.5) * spacing_
                           : near_cells_ * spacing_ + (i - near_cells_ + 0.5) * wide_;
  }
  /// The cell that a range lies in, with what it lies beyond the cell's inner edge as a fraction.
  [[nodiscard]] double at(double range) const noexcept {
    const double cells = range / spacing_;
    if (cells < divided_) return cells * parts_;
    return divided_ * (parts_ - 1.0) +
           (cells < near_cells_ ? cells : near_cells_ + (range - near_cells_ * spacing_) / wide_);
  }
  /// How many cells have their centres before a range: the first of the others.
  [[nodiscard]] std::size_t count(double range) const noexcept {
    return std::size_t(std::max(0.0, std::ceil(at(range) - 0.5)));
  }

 private:
  double spacing_ = 1.0, wide_ = 1.0, near_cells_ = 0.0;
  double divided_ = 0.0, parts_ = 1.0;  // the first cells of `spacing`, each into so many
};

}  // namespace asdic::detail
