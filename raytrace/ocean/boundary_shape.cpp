#include "raytrace/ocean/boundary_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "raytrace/ocean/number_text.h"
#include "raytrace/ocean/samples.h"

namespace asdic::detail {
namespace {

void check_nodes(std::span<const double> range, std::span<const double> depth,
                 std::size_t materials) {
  check_count(range.size(), "range", 1);
  check_as_many(depth.size(), "depth", range.size(), "ranges");
  if (materials != 0 && materials != range.size())
    throw InputError({.where = "material",
                      .got = std::to_string(materials) + " materials",
                      .expected = "none, or as many as ranges: " + std::to_string(range.size())});
  for (std::size_t i = 0; i < range.size(); ++i) {
    check_place(range, i, "range", "a range beyond");
    if (!std::isfinite(depth[i]))
      throw InputError({.where = element("depth", i),
                        .got = with_unit(depth[i], "m"),
                        .expected = "a finite depth"});
  }
}

/// The cubic of a smooth facet in t = (r − r_a)/h: depth = z_a + t(m_a·h + t(b + t·d)).
struct Cubic {
  double z, m, b, d, h;

  Cubic(double width, double z_a, double z_b, double slope_a, double slope_b)
      : z(z_a),
        m(slope_a * width),
        b(3.0 * (z_b - z_a) - (2.0 * slope_a + slope_b) * width),
        d((slope_a + slope_b) * width - 2.0 * (z_b - z_a)),
        h(width) {}

  [[nodiscard]] double depth(double t) const noexcept { return z + t * (m + t * (b + t * d)); }
  [[nodiscard]] double slope(double t) const noexcept {
    return (m + t * (2.0 * b + t * 3.0 * d)) / h;
  }
  [[nodiscard]] double second(double t) const noexcept { return (2.0 * b + 6.0 * d * t) / (h * h); }
};

/// dφ/ds of a curve with these derivatives: z″·cos³φ.
double curvature_of(double slope, double second) noexcept {
  const double piece = 1.0 + slope * slope;
  return second / (piece * std::sqrt(piece));
}

/// Depths at which a cubic turns inside its facet; the ends again where it does not.
std::array<double, 2> turns(const Cubic& cubic) noexcept {
  const double a = 3.0 * cubic.d, b = 2.0 * cubic.b, c = cubic.m;  // a·t² + b·t + c = 0
  const double discriminant = b * b - 4.0 * a * c;
  std::array<double, 2> found = {cubic.depth(0.0), cubic.depth(1.0)};
  if (discriminant < 0.0) return found;
  const double w = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  const double first = a != 0.0 ? w / a : 0.0, second = w != 0.0 ? c / w : 0.0;
  if (first > 0.0 && first < 1.0) found[0] = cubic.depth(first);
  if (second > 0.0 && second < 1.0) found[1] = cubic.depth(second);
  return found;
}

}  // namespace

std::string_view name(ShapeInterpolation interpolation) noexcept {
  switch (interpolation) {
    case ShapeInterpolation::piecewise_linear:
      return "piecewise-linear";
    case ShapeInterpolation::smooth:
      return "smooth";
    case ShapeInterpolation::curvilinear:
      return "curvilinear";
  }
  return "";
}

BoundaryShape::BoundaryShape(std::span<const double> range, std::span<const double> depth,
                             ShapeInterpolation interpolation,
                             std::vector<BoundaryMaterial> material)
    : range_(range.begin(), range.end()),
      depth_(depth.begin(), depth.end()),
      material_(std::move(material)),
      interpolation_(interpolation) {
  check_nodes(range, depth, material_.size());
  const std::size_t n = range_.size();

  slope_.assign(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i)
    slope_[i] = (depth_[i + 1] - depth_[i - 1]) / (range_[i + 1] - range_[i - 1]);
  bend_facets();
  find_extremes();
}

BoundaryShape BoundaryShape::with_slopes(std::span<const double> range,
                                         std::span<const double> depth,
                                         std::span<const double> slope,
                                         std::vector<BoundaryMaterial> material) {
  BoundaryShape shape(range, depth, ShapeInterpolation::smooth, std::move(material));
  check_as_many(slope.size(), "slope", range.size(), "ranges");
  shape.slope_.assign(slope.begin(), slope.end());
  shape.find_extremes();
  return shape;
}

// Curvilinear: a node's tangent is the mean of both facets' unit tangents; the flat parts
// beyond the ends count.
void BoundaryShape::bend_facets() {
  const std::size_t n = range_.size();
  tangent_.assign(n, Vec2(1.0, 0.0));
  Vec2 before(1.0, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    Vec2 after(1.0, 0.0);
    if (i + 1 < n) after = Vec2(range_[i + 1] - range_[i], depth_[i + 1] - depth_[i]).normalized();
    tangent_[i] = 0.5 * (before + after);
    before = after;
  }
}

BoundaryShape BoundaryShape::along(double origin, double cosine) const {
  BoundaryShape line = *this;
  if (cosine < 0.0) {
    if (!material_.empty()) {
      // A facet keeps its material: the last one, beyond all nodes, is to come before all of them.
      // One more node on that flat part gives it a facet of its own.
      line.range_.push_back(range_.back() + 1.0);
      line.depth_.push_back(depth_.back());
      line.slope_.push_back(0.0);
      line.tangent_.emplace_back(1.0, 0.0);
      line.material_.assign(material_.rbegin(), material_.rend());
      line.material_.push_back(material_.front());
    }
    std::reverse(line.range_.begin(), line.range_.end());
    std::reverse(line.depth_.begin(), line.depth_.end());
    std::reverse(line.slope_.begin(), line.slope_.end());
    std::reverse(line.tangent_.begin(), line.tangent_.end());
  }
  for (double& range : line.range_) range = (range - origin) / cosine;
  for (double& slope : line.slope_) slope *= cosine;
  for (Vec2& tangent : line.tangent_) tangent.y() *= cosine;
  return line;
}

std::size_t BoundaryShape::facet(double range) const noexcept {
  return static_cast<std::size_t>(std::upper_bound(range_.begin(), range_.end(), range) -
                                  range_.begin());
}

double BoundaryShape::facet_begin(std::size_t facet) const noexcept {
  return facet == 0 ? -infinity : range_[facet - 1];
}

double BoundaryShape::facet_end(std::size_t facet) const noexcept {
  return facet >= range_.size() ? infinity : range_[facet];
}

double BoundaryShape::depth_at(double range, std::size_t facet) const noexcept {
  if (facet == 0) return depth_.front();
  if (facet >= range_.size()) return depth_.back();
  const double begin = range_[facet - 1], end = range_[facet], width = end - begin;
  const double above = depth_[facet - 1], below = depth_[facet];
  if (interpolation_ == ShapeInterpolation::smooth)
    return Cubic(width, above, below, slope_[facet - 1], slope_[facet])
        .depth((range - begin) / width);
  // Measured from the nearer node, so that it is met exactly from both sides.
  const double slope = (below - above) / width;
  return range - begin < end - range ? above + slope * (range - begin)
                                     : below + slope * (range - end);
}

BoundaryPoint BoundaryShape::at(double range, std::size_t facet) const noexcept {
  if (facet == 0 || facet >= range_.size()) return {.depth = depth_at(range, facet)};
  const double width = range_[facet] - range_[facet - 1];
  const double share = (range - range_[facet - 1]) / width;
  switch (interpolation_) {
    case ShapeInterpolation::smooth: {
      const Cubic cubic(width, depth_[facet - 1], depth_[facet], slope_[facet - 1], slope_[facet]);
      const double slope = cubic.slope(share);
      return {.depth = cubic.depth(share),
              .slope = slope,
              .curvature = curvature_of(slope, cubic.second(share))};
    }
    case ShapeInterpolation::curvilinear: {
      const Vec2 &a = tangent_[facet - 1], &b = tangent_[facet];
      const Vec2 tangent = (1.0 - share) * a + share * b;
      // κ = dφ/ds of the turning tangent along the facet
      const double length = std::hypot(width, depth_[facet] - depth_[facet - 1]);
      return {.depth = depth_at(range, facet),
              .slope = tangent.y() / tangent.x(),
              .curvature = (a.x() * b.y() - a.y() * b.x()) / tangent.squaredNorm() / length};
    }
    case ShapeInterpolation::piecewise_linear:
      break;
  }
  return {.depth = depth_at(range, facet), .slope = (depth_[facet] - depth_[facet - 1]) / width};
}

void BoundaryShape::find_extremes() {
  const auto [least, most] = std::minmax_element(depth_.begin(), depth_.end());
  shallowest_ = *least;
  deepest_ = *most;
  if (interpolation_ != ShapeInterpolation::smooth) return;
  for (std::size_t i = 1; i < range_.size(); ++i)
    for (const double depth : turns(Cubic(range_[i] - range_[i - 1], depth_[i - 1], depth_[i],
                                          slope_[i - 1], slope_[i]))) {
      shallowest_ = std::min(shallowest_, depth);
      deepest_ = std::max(deepest_, depth);
    }
}

}  // namespace asdic::detail
