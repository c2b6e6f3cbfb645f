#pragma once
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "raytrace/layered/branch.h"
#include "raytrace/layered/column.h"
#include "raytrace/layered/ocean_fan.h"
#include "raytrace/layered/ocean_series.h"
#include "raytrace/math/hermite.h"
#include "raytrace/ocean/path_limits.h"

namespace asdic::detail {

/// Rays between two depths as functions of their parameter: what a fan of rays would find,
/// tabulated.
///
/// The fan is split at the singular rays of a piecewise profile (those that turn at a knot, graze a
/// boundary, or are horizontal at source or receiver): within an interval all ranges are smooth
/// functions of σ, the sine of the ray's angle at the slower of the interval's two singular depths.
struct FanInterval {
  double reference_speed = 0.0;  ///< σ = sin θ where the speed is this [m/s]
  bool turns_above = false, turns_below = false;
  std::span<const double> sigma;                   ///< [n] increasing nodes
  std::span<const double> up, middle, down;        ///< [n] ranges of the three pieces [m]
  std::span<const double> d_up, d_middle, d_down;  ///< [n] their derivatives with respect to σ [m]
  std::vector<int> loudest_vertices;  ///< [n − 1] vertices after which bounces have left less than
                                      ///< PathLimits::faintest of a ray between two nodes; empty
                                      ///< where none is so faint
  std::unique_ptr<double[]> numbers;  ///< what the spans show
};

/// Steep rays have r like k = cos θ = √(1 − σ²), and no cubic in σ follows that to the vertical:
/// from this σ on −k is the variable of cubics.
inline constexpr double steep_sigma = 0.5;

/// A point of r(σ) as one of r(−k), and back.
[[nodiscard]] inline HermiteNode in_cosine(const HermiteNode& node) noexcept {
  const double k = std::sqrt((1.0 - node.x) * (1.0 + node.x));
  return {-k, node.value, node.slope * k / node.x};  // dσ/d(−k) = k/σ
}
[[nodiscard]] inline double sine_of_cosine(double minus_k) noexcept {
  return std::sqrt((1.0 - minus_k) * (1.0 + minus_k));
}

/// A piece of an interval over which a branch's range is monotone in σ.
struct MonotonePiece {
  const FanInterval* interval = nullptr;
  std::size_t cell = 0;  ///< between nodes cell and cell + 1
  Branch branch;
  double sigma_begin = 0.0, sigma_end = 0.0;
  double range_begin = 0.0, range_end = 0.0;        ///< r at the two ends [m]
  double slope_begin = 0.0, slope_end = 0.0;        ///< dr/dσ there [m]; 0 at a caustic
  bool caustic_begin = false, caustic_end = false;  ///< the end is an extremum of r
};

/// What is kept of an ocean, if anything: of its uncut layers.
struct KeptOcean {
  std::span<const Layer> layers = {};
  const OceanFan* fan = nullptr;
  const OceanSeries* series = nullptr;
};

class BranchTable {
 public:
  /// \param boundaries  whose losses make paths too faint; needed if limits.faintest > 0
  /// \param kept  of the ocean, if it is
  BranchTable(Column column, const PathLimits& limits, const Environment* boundaries = nullptr,
              const KeptOcean& kept = {});

  [[nodiscard]] const Column& column() const noexcept { return column_; }
  /// The column's legs out of the ocean's series, or nullptr.
  [[nodiscard]] const OceanLegs* kept() const noexcept { return legs_ ? &*legs_ : nullptr; }
  [[nodiscard]] const PathLimits& limits() const noexcept { return limits_; }
  /// By growing reference speed.
  [[nodiscard]] std::span<const FanInterval> intervals() const noexcept { return intervals_; }

  /// Exact r and dr/dσ of a branch.
  struct RangeSlope {
    double range, slope;
  };
  [[nodiscard]] RangeSlope evaluate(const FanInterval& interval, const Branch& branch,
                                    double sigma) const noexcept;

  /// Calls `visit` for every monotone piece of every branch within the limits. With a non-empty
  /// [low, high] only pieces whose ranges may meet it are split and visited.
  void for_each_piece(double low, double high,
                      const std::function<void(const MonotonePiece&)>& visit) const;

  /// The same where only these ranges matter. \param ranges  [n] increasing, n > 0. Extrema between
  /// them need not be exact: a piece may go on past one by less than the distance to the next
  /// range.
  void for_each_piece(std::span<const double> ranges,
                      const std::function<void(const MonotonePiece&)>& visit) const;

 private:
  void for_each_piece(double low, double high, std::span<const double> ranges,
                      const std::function<void(const MonotonePiece&)>& visit) const;
  class Parts;
  void add_interval(const CriticalSpeed& slow, const CriticalSpeed& fast, double bend,
                    const Parts* parts);
  void limit_by_loss(FanInterval& interval) const;

  Column column_;
  PathLimits limits_;
  const Environment* boundaries_;
  std::optional<OceanLegs> legs_;
  std::vector<FanInterval> intervals_;
};

}  // namespace asdic::detail
