#include "raytrace/bellhop_emulation/boundary_line.h"

#include <cmath>
#include <span>

namespace asdic::detail::bellhop_emulation {
namespace {
constexpr double far_away = 1e30;  // where the flat ends of a boundary stop [m]
}

BoundaryLine::BoundaryLine(const Boundary& boundary, BoundaryKind kind, bool unit_normals)
    : kind_(kind), unit_normals_(unit_normals) {
  const bool flat = !boundary.shape;
  const std::vector<double> flat_depth = {boundary.depth};
  const auto r = flat ? std::span<const double>{} : boundary.shape->ranges();
  const auto z = flat ? std::span<const double>(flat_depth) : boundary.shape->depths();
  curvilinear_ = !flat && boundary.shape->interpolation() != ShapeInterpolation::piecewise_linear;
  const auto add = [this](double range, double depth) {
    range_.push_back(range);
    depth_.push_back(depth);
  };
  add(-far_away, z.front());
  for (std::size_t i = 0; i < r.size(); ++i) add(r[i], z[i]);
  add(far_away, z.back());
  for (std::size_t i = 0; i + 1 < range_.size(); ++i) {
    // the material of a facet is that of its first node; before the first node, that node's
    const auto m = flat ? std::span<const BoundaryMaterial>{} : boundary.shape->materials();
    material_.push_back(m.empty() ? boundary.material : m[i == 0 ? 0 : i - 1]);
  }

  for (std::size_t i = 0; i + 1 < range_.size(); ++i) {
    const Vec2 t = Vec2(range_[i + 1] - range_[i], depth_[i + 1] - depth_[i]).normalized();
    tangent_.push_back(t);
    normal_.push_back(kind == BoundaryKind::bottom ? Vec2(-t.y(), t.x()) : Vec2(t.y(), -t.x()));
  }
  if (!curvilinear_) return;
  node_tangent_.push_back({1.0, 0.0});
  for (std::size_t i = 1; i + 1 < range_.size(); ++i)
    node_tangent_.push_back(0.5 * (tangent_[i - 1] + tangent_[i]));  // not made a unit vector
  node_tangent_.push_back({1.0, 0.0});
  // A segment's curvature is that of the corner at its end: it lags half a segment behind.
  const auto slope = [this](std::size_t i) { return tangent_[i].y() / tangent_[i].x(); };
  for (std::size_t i = 0; i < tangent_.size(); ++i) {
    const double next = i + 1 < tangent_.size() ? slope(i + 1) : slope(i);
    const double cosine = tangent_[i].x();
    curvature_.push_back((next - slope(i)) / (range_[i + 1] - range_[i]) * cosine * cosine *
                         cosine);
  }
}

void BoundaryLine::locate(double range, double direction, std::size_t& i) const noexcept {
  const std::size_t last = range_.size() - 2;
  while (i > 0 && (range < range_[i] || (range == range_[i] && direction < 0.0))) --i;
  while (i < last && (range > range_[i + 1] || (range == range_[i + 1] && direction > 0.0))) ++i;
}

BoundaryLine::Facet BoundaryLine::facet(const Vec2& x, std::size_t i) const noexcept {
  if (!curvilinear_) return {.tangent = tangent_[i], .normal = normal_[i]};
  const double length = (node(i + 1) - node(i)).norm();
  const double s = (x - node(i)).dot(tangent_[i]) / length;
  Vec2 t = (1.0 - s) * node_tangent_[i] + s * node_tangent_[i + 1];
  double curvature = curvature_[i];
  if (unit_normals_) {
    const Vec2 &a = node_tangent_[i], &b = node_tangent_[i + 1];
    curvature = (a.x() * b.y() - a.y() * b.x()) / t.squaredNorm() / length;
    t.normalize();
  }
  const Vec2 n = kind_ == BoundaryKind::bottom ? Vec2(-t.y(), t.x()) : Vec2(t.y(), -t.x());
  return {.tangent = t, .normal = n, .curvature = curvature};
}

}  // namespace asdic::detail::bellhop_emulation
