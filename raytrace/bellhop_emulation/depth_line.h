#pragma once
#include <algorithm>
#include <cmath>

#include "raytrace/bellhop_emulation/beam.h"

namespace asdic::detail::bellhop_emulation {

/// A segment of a ray as a line of receivers at one depth sees it: where the normals at its ends
/// meet the line, and how far along the normal.
struct LineSegment {
  std::size_t index;  ///< from point index − 1 to point index
  const LiteralPoint &a, &b;
  double ra, rb;  ///< ranges where the normals meet the line [m]; infinite where they do not
  double na, nb;  ///< lengths of the normals [m], signed
  const ReceiverBlock& block;

  /// Calls visit(column, share of the way from a to b) for the receivers between the normals.
  /// Ranges are taken as equally spaced: index = (r − r₁)/Δr.
  void over_columns(auto&& visit) const {
    if (!std::isfinite(ra) || !std::isfinite(rb) || ra == rb) return;
    const long from = index_of(ra), to = index_of(rb);
    const long step = from < to ? 1 : -1;
    for (long i = from < to ? from + 1 : from; from < to ? i <= to : i > to; i += step) {
      if (i < static_cast<long>(block.column_begin) || i >= static_cast<long>(block.column_end))
        continue;
      const auto column = static_cast<std::size_t>(i);
      visit(column, (block.grid.ranges[column] - ra) / (rb - ra));
    }
  }

 private:
  /// The last receiver at or before a range. If all lie beyond, the first of several, which so
  /// never lies between two: it gets nothing, as BELLHOP has it.
  [[nodiscard]] long index_of(double range) const noexcept {
    const std::vector<double>& r = block.grid.ranges;
    const double spacing = (r.back() - r.front()) / static_cast<double>(r.size());
    const double nearly = range + 1e-6 * spacing;  // on a receiver but for rounding
    const long index =
        static_cast<long>(std::upper_bound(r.begin(), r.end(), nearly) - r.begin()) - 1;
    return r.size() > 1 ? std::max(index, 0L) : index;
  }
};

/// Calls visit(depth, row, block) for every line of receivers at one depth; on an irregular grid
/// each receiver is a line of its own.
void for_each_depth_line(const ReceiverBlock& block, auto&& visit) {
  if (!block.grid.irregular) {
    for (std::size_t row = block.row_begin; row < block.row_end; ++row)
      visit(block.grid.depths[row], row, block);
    return;
  }
  for (std::size_t column = block.column_begin; column < block.column_end; ++column)
    visit(block.grid.depths[column], std::size_t{0},
          ReceiverBlock{block.grid, column, column + 1, 0, 1});
}

/// Calls visit(LineSegment) for the segments of a ray in turn, the reflections left out. Where a
/// ray is almost vertical its normals run along the line and do not meet it.
/// \param side  1: the normals as they are; −1: leaning the other way in range
void follow_depth_line(const LiteralRay& ray, double depth, double side, const ReceiverBlock& block,
                       auto&& visit) {
  const auto& points = ray.points;
  struct Foot {
    double range, length;
  };
  const auto foot = [depth, side](const LiteralPoint& y) {
    const Vec2 normal(-y.c * y.t.y(), y.c * y.t.x());
    if (std::abs(normal.y()) < 1e-10) return Foot{infinity, 0.0};
    const double length = (depth - y.x.y()) / normal.y();
    return Foot{y.x.x() + side * length * normal.x(), length};
  };
  for (std::size_t i = 1; i < points.size(); ++i) {
    const LiteralPoint &a = points[i - 1], &b = points[i];
    const Foot fa = foot(a), fb = foot(b);
    visit(LineSegment{.index = i,
                      .a = a,
                      .b = b,
                      .ra = fa.range,
                      .rb = a.x == b.x ? fa.range : fb.range,
                      .na = fa.length,
                      .nb = fb.length,
                      .block = block});
  }
}

}  // namespace asdic::detail::bellhop_emulation
