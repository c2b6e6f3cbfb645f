#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace asdic::detail {

/// Sound speed at a point of the (range, depth) plane, with its derivatives.
struct SoundSpeed2D {
  double c = 0.0;     ///< [m/s]
  double c_r = 0.0;   ///< ∂c/∂r [1/s]
  double c_z = 0.0;   ///< ∂c/∂z [1/s]
  double c_rr = 0.0;  ///< [1/(m·s)]
  double c_rz = 0.0;
  double c_zz = 0.0;
};

/// Range-dependent water: the speed on a grid of ranges and depths, bilinear in every cell, so that
/// c is continuous and its gradient jumps across grid lines. Beyond the first and last range the
/// outer profile goes on unchanged; above and below the grid the first and last depth interval go
/// on. A cell index names the law, whether the point lies inside the cell or not, so that the
/// gradient on either side of a grid line can be had.
class SoundSpeedSection {
 public:
  /// \param range  [m] strictly increasing, m ≥ 1 [m]   \param depth  [n] strictly increasing, n ≥
  /// 2 [m] \param speed  [m × n] row by row: speed[i·n + j] at range i, depth j [m/s], each above
  /// zero \throws InputError naming the first number at fault ("range[3]", "depth[1]",
  /// "speed[2][7]")
  SoundSpeedSection(std::span<const double> range, std::span<const double> depth,
                    std::span<const double> speed);

  /// Which cell holds a point. Columns 0 and m are the uniform water before the first and after the
  /// last range, column i lies between ranges i − 1 and i; row j lies between depths j and j + 1.
  /// On a grid line: the cell beyond it (greater range, greater depth).
  struct Cell {
    std::size_t column = 0, row = 0;
  };
  [[nodiscard]] Cell cell(double range, double depth) const noexcept;
  [[nodiscard]] SoundSpeed2D at(double range, double depth, Cell cell) const noexcept;
  [[nodiscard]] SoundSpeed2D at(double range, double depth) const noexcept {
    return at(range, depth, cell(range, depth));
  }

  [[nodiscard]] std::span<const double> ranges() const noexcept { return range_; }  ///< [m]
  [[nodiscard]] std::span<const double> depths() const noexcept { return depth_; }  ///< [n]
  /// [m × n], as given.
  [[nodiscard]] std::span<const double> speeds() const noexcept { return speed_; }

  [[nodiscard]] bool operator==(const SoundSpeedSection&) const = default;

 private:
  std::vector<double> range_, depth_, speed_;
};

}  // namespace asdic::detail
