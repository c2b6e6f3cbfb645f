#include "raytrace/like_bellhop/boundary_line.h"

#include <cmath>

namespace asdic::like_bellhop {
namespace {
constexpr double far_away = 1e30;  // where the flat ends of a boundary stop [m]
}

BoundaryLine::BoundaryLine(const Boundary& boundary, BoundaryKind kind) : kind_(kind) {
  if (boundary.shape) {
    const auto r = boundary.shape->ranges();
    const auto z = boundary.shape->depths();
    range_.assign(r.begin(), r.end());
    depth_.assign(z.begin(), z.end());
    curvilinear_ = boundary.shape->interpolation() != ShapeInterpolation::piecewise_linear;
    const auto m = boundary.shape->materials();
    if (!m.empty()) {
      material_.push_back(m.front());
      material_.insert(material_.end(), m.begin(), m.end());
    }
    range_.insert(range_.begin(), -far_away);
    depth_.insert(depth_.begin(), depth_.front());
    range_.push_back(far_away);
    depth_.push_back(depth_.back());
  } else {
    range_ = {-far_away, far_away};
    depth_ = {boundary.depth, boundary.depth};
  }
  if (material_.empty()) material_.push_back(boundary.material);

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
  for (std::size_t i = 0; i + 1 < range_.size(); ++i) {
    const Vec2 &a = node_tangent_[i], &b = node_tangent_[i + 1];
    const double cosine = tangent_[i].x();
    curvature_.push_back((b.y() / b.x() - a.y() / a.x()) / (range_[i + 1] - range_[i]) * cosine *
                         cosine * cosine);
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
  const Vec2 t = (1.0 - s) * node_tangent_[i] + s * node_tangent_[i + 1];
  const Vec2 n = kind_ == BoundaryKind::bottom ? Vec2(-t.y(), t.x()) : Vec2(t.y(), -t.x());
  return {.tangent = t, .normal = n, .curvature = curvature_[i]};
}

}  // namespace asdic::like_bellhop
