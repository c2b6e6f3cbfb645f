#include "sonar/scenario/target.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

double full_circle(double angle) noexcept {  // [0, 2π)
  const double turn = std::fmod(angle, 2.0 * pi);
  return turn < 0.0 ? turn + 2.0 * pi : turn;
}

}  // namespace

double AspectTable::at(double angle) const noexcept {
  const bool both_sides = aspect.back() <= pi;
  double a = full_circle(angle);
  if (both_sides) a = std::min(a, 2.0 * pi - a);
  const auto above = std::upper_bound(aspect.begin(), aspect.end(), a) - aspect.begin();
  const auto n = static_cast<std::ptrdiff_t>(aspect.size());
  const auto angle_of = [&](std::ptrdiff_t i) { return aspect[static_cast<std::size_t>(i)]; };
  const auto level_of = [&](std::ptrdiff_t i) { return strength_db[static_cast<std::size_t>(i)]; };
  if (above > 0 && above < n) {
    const double share = (a - angle_of(above - 1)) / (angle_of(above) - angle_of(above - 1));
    return std::lerp(level_of(above - 1), level_of(above), share);
  }
  if (both_sides) return above == 0 ? strength_db.front() : strength_db.back();
  const double gap = angle_of(0) + 2.0 * pi - angle_of(n - 1);  // from the last to the first
  if (gap <= 0.0) return strength_db.back();
  const double since = above == 0 ? a + 2.0 * pi - angle_of(n - 1) : a - angle_of(n - 1);
  return std::lerp(level_of(n - 1), level_of(0), since / gap);
}

double heading_of(const Target& target, double time) {
  return target.heading ? *target.heading : target.track.course_at(time).value_or(0.0);
}

Vec3 from_body(const Vec3& offset, double heading) noexcept {
  const double s = std::sin(heading), c = std::cos(heading);
  return {s * offset.x() + c * offset.y(), c * offset.x() - s * offset.y(), offset.z()};
}

double aspect_of(const Vec3& in, const Vec3& out, double heading) noexcept {
  const Vec2 from = -in.head<2>().normalized(), to = out.head<2>().normalized();
  Vec2 bisector = from + to;
  if (bisector.norm() < 1e-6) bisector = from;
  return full_circle(std::atan2(bisector.x(), bisector.y()) - heading);
}

/// The line x + t·d leaves the ellipse |D·x|² = 1, D = diag(2/length, 2/beam), at the larger root
/// of |D(x + t·d)|² = 1; from outside it may cross between two positive roots.
bool hidden(const Hull& hull, const Vec3& offset, double aspect) noexcept {
  const Vec2 scale(2.0 / hull.length, 2.0 / hull.beam);
  const Vec2 x = scale.cwiseProduct(offset.head<2>());
  const Vec2 d = scale.cwiseProduct(Vec2(std::cos(aspect), std::sin(aspect)));
  const double a = d.squaredNorm(), b = x.dot(d), c = x.squaredNorm() - 1.0;
  const double discriminant = b * b - a * c;
  if (discriminant <= 0.0) return false;
  const double root = std::sqrt(discriminant);
  const double enter = std::max(0.0, (-b - root) / a), leave = (-b + root) / a;
  return leave - enter > 0.75 * hull.beam;
}

double strength_db(const Target& target, double aspect) {
  if (target.highlights.empty())
    return target.aspect ? target.aspect->at(aspect) : target.strength_db;
  double power = 0.0;
  for (const Highlight& one : target.highlights)
    if (!target.hull || !hidden(*target.hull, one.offset, aspect))
      power += power_from_db(one.aspect ? one.aspect->at(aspect) : one.strength_db);
  return db_from_power(power);
}

double strength_towards(const Target& target, const Vec3& place, double time) {
  const Vec3 towards = place - target.track.at(time).position;
  return strength_db(target, aspect_of(-towards, towards, heading_of(target, time)));
}

}  // namespace asdic::detail
