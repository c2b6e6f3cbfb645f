#include "raytrace/bellhop_emulation/step.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail::bellhop_emulation {
namespace {

constexpr double shortest_share = 1e-6;  // of the step: none is shorter
constexpr double parallel = 1e-300;      // a direction component below this reaches nothing

/// What cuts a step, nearest first.
struct StepCut {
  enum class By { nothing, row, column, surface, bottom, node, box_range, box_depth };
  double length;
  By by = By::nothing;
  double coordinate = 0.0;  // where a row, column, node or side of the box is [m]
  bool exact = true;        // the step ends on it
};

/// The largest part of a step of `length` along the unit vector u that crosses nothing.
StepCut cut_step(const LiteralOcean& ocean, const Vec2& x, const Vec2& u, const RayPlace& place,
                 double length) noexcept {
  StepCut cut{.length = length};
  const Vec2 end = x + length * u;
  const auto consider = [&cut](double h, StepCut::By by, double coordinate = 0.0) {
    if (h < cut.length) cut = {h, by, coordinate};
  };
  const auto vertical = [&](double line, StepCut::By by) {
    if (std::abs(u.x()) > parallel) consider((line - x.x()) / u.x(), by, line);
  };
  const auto horizontal = [&](double line, StepCut::By by) {
    if (std::abs(u.y()) > parallel) consider((line - x.y()) / u.y(), by, line);
  };
  const double upper = ocean.water.upper(place.cell), lower = ocean.water.lower(place.cell);
  if (end.y() < upper) horizontal(upper, StepCut::By::row);
  if (end.y() > lower) horizontal(lower, StepCut::By::row);
  const auto boundary = [&](const BoundaryLine& line, std::size_t segment, StepCut::By by) {
    if (line.outside(end, segment) <= 0.0) return;
    const double h = -line.outside(x, segment) / u.dot(line.normal(segment));
    // before a node at the same place
    if (h <= cut.length) cut = {h, by, line.is_flat(segment) ? line.node(segment).y() : 0.0};
  };
  boundary(ocean.surface, place.surface, StepCut::By::surface);
  boundary(ocean.bottom, place.bottom, StepCut::By::bottom);
  const double left = std::max(ocean.surface.left(place.surface), ocean.bottom.left(place.bottom));
  const double right =
      std::min(ocean.surface.right(place.surface), ocean.bottom.right(place.bottom));
  if (end.x() < left) vertical(left, StepCut::By::node);
  if (end.x() > right) vertical(right, StepCut::By::node);
  const double first = ocean.water.left(place.cell), last = ocean.water.right(place.cell);
  if (end.x() < first) vertical(first, StepCut::By::column);
  if (end.x() > last) vertical(last, StepCut::By::column);
  if (std::abs(end.x()) > ocean.box_range)
    vertical(std::copysign(ocean.box_range, end.x()), StepCut::By::box_range);
  if (std::abs(end.y()) > ocean.box_depth)
    horizontal(std::copysign(ocean.box_depth, end.y()), StepCut::By::box_depth);
  // A step that would be shorter goes past what cut it; what it was is still known.
  if (const double least = shortest_share * ocean.step; cut.length < least) {
    cut.length = least;
    cut.exact = false;
  }
  return cut;
}

/// The end of a cut step, exactly on what cut it.
Vec2 land(const Vec2& x, const Vec2& u, const StepCut& cut, const LiteralOcean& ocean,
          const RayPlace& place) noexcept {
  Vec2 end = x + cut.length * u;
  if (!cut.exact) return end;
  switch (cut.by) {
    case StepCut::By::row:
    case StepCut::By::box_depth:
      end.y() = cut.coordinate;
      break;
    case StepCut::By::surface:
      if (ocean.surface.is_flat(place.surface)) end.y() = cut.coordinate;
      break;
    case StepCut::By::bottom:
      if (ocean.bottom.is_flat(place.bottom)) end.y() = cut.coordinate;
      break;
    case StepCut::By::column:
    case StepCut::By::node:
    case StepCut::By::box_range:
      end.x() = cut.coordinate;
      break;
    case StepCut::By::nothing:
      break;
  }
  return end;
}

/// ∂²c/∂n²/c², with the scaled tangent: p' = −(this)·q.
double bending(const WaterPoint& w, const Vec2& t) noexcept {
  return w.c_rr * t.y() * t.y() - 2.0 * w.c_rz * t.x() * t.y() + w.c_zz * t.x() * t.x();
}

/// p jumps by −q·RN where the gradient of c does.
void cross(const Vec2& gradient_jump, bool range_line, LiteralPoint& y) noexcept {
  const Vec2 normal(-y.t.y(), y.t.x());
  const double cn = gradient_jump.dot(normal), cs = gradient_jump.dot(y.t);
  const double rm = range_line ? -y.t.y() / y.t.x() : y.t.x() / y.t.y();
  const double rn = rm * (2.0 * cn - rm * cs) / y.c;
  y.p1 -= y.q1 * rn;
  y.p2 -= y.q2 * rn;
}

}  // namespace

LiteralPoint step(const LiteralOcean& ocean, const LiteralPoint& from, RayPlace& place,
                  Landing& landing) noexcept {
  ocean.water.locate(from.x, from.t, place.cell);
  const WaterCell begin_cell = place.cell;
  const WaterPoint w0 = ocean.water.at(from.x, place.cell);

  // Phase 1: half an Euler step.
  const Vec2 u0 = w0.c * from.t;
  const StepCut cut0 = cut_step(ocean, from.x, u0, place, ocean.step);
  const double half = 0.5 * cut0.length;
  const double bend0 = bending(w0, from.t);
  const Vec2 x1 = from.x + half * u0;
  const Vec2 t1 = from.t - half * w0.gradient() / (w0.c * w0.c);
  const double p11 = from.p1 - half * bend0 * from.q1, q11 = from.q1 + half * w0.c * from.p1;
  const double p21 = from.p2 - half * bend0 * from.q2, q21 = from.q2 + half * w0.c * from.p2;

  // Phase 2: the step may be cut again along the direction at its middle; the less of it is left,
  // the more the derivatives at the beginning weigh.
  ocean.water.locate(x1, t1, place.cell);
  const WaterPoint w1 = ocean.water.at(x1, place.cell);
  const Vec2 u1 = w1.c * t1;
  RayPlace at_begin = place;
  at_begin.cell = begin_cell;
  const double h = cut_step(ocean, from.x, u1, at_begin, cut0.length).length;
  const double weight1 = h / (2.0 * half), weight0 = 1.0 - weight1;
  const Vec2 u2 = weight0 * u0 + weight1 * u1;
  const StepCut cut = cut_step(ocean, from.x, u2, at_begin, ocean.step);  // anew from the full step
  const double h0 = cut.length * weight0, h1 = cut.length * weight1;
  const double bend1 = bending(w1, t1);

  LiteralPoint y = from;
  y.x = land(from.x, u2, cut, ocean, place);
  y.t = from.t - h0 * w0.gradient() / (w0.c * w0.c) - h1 * w1.gradient() / (w1.c * w1.c);
  y.p1 = from.p1 - h0 * bend0 * from.q1 - h1 * bend1 * q11;
  y.q1 = from.q1 + h0 * w0.c * from.p1 + h1 * w1.c * p11;
  y.p2 = from.p2 - h0 * bend0 * from.q2 - h1 * bend1 * q21;
  y.q2 = from.q2 + h0 * w0.c * from.p2 + h1 * w1.c * p21;
  y.tau = from.tau + h0 / std::complex<double>(w0.c, w0.c_loss) +
          h1 / std::complex<double>(w1.c, w1.c_loss);

  landing = cut.by == StepCut::By::surface  ? Landing::surface
            : cut.by == StepCut::By::bottom ? Landing::bottom
                                            : Landing::water;
  ocean.water.locate(y.x, y.t, place.cell);
  const WaterPoint w2 = ocean.water.at(y.x, place.cell);
  y.c = w2.c;
  y.gradient = w2.gradient();
  if (!(place.cell == begin_cell))
    cross(w2.gradient() - w0.gradient(), place.cell.row == begin_cell.row, y);
  return y;
}

}  // namespace asdic::detail::bellhop_emulation
