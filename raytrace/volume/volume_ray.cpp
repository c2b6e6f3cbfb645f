#include "raytrace/volume/volume_ray.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/geometry.h"

namespace asdic::detail {
namespace {

using RayVector = Eigen::Matrix<double, 19, 1, Eigen::DontAlign>;  // x, p, X, P, length

constexpr double touching_boundary = 1e-9;  // [m]
constexpr int most_volume_steps = 200000;
constexpr double tolerable_nepers = 1e-6;  // of a piece of a step

RayVector packed_state(const VolumeState& s) noexcept {
  RayVector y;
  y.segment<3>(0) = s.x;
  y.segment<3>(3) = s.p;
  for (int k = 0; k < 2; ++k) {
    y.segment<3>(6 + 3 * k) = s.x_launch.col(k);
    y.segment<3>(12 + 3 * k) = s.p_launch.col(k);
  }
  y[18] = s.length;
  return y;
}

VolumeState unpacked_state(const RayVector& y, double time) noexcept {
  VolumeState s;
  s.x = y.segment<3>(0);
  s.p = y.segment<3>(3);
  for (int k = 0; k < 2; ++k) {
    s.x_launch.col(k) = y.segment<3>(6 + 3 * k);
    s.p_launch.col(k) = y.segment<3>(12 + 3 * k);
  }
  s.length = y[18];
  s.time = time;
  return s;
}

/// det(a, b, c), of the left-handed triple.
double triple_product(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  return a.x() * (b.y() * c.z() - b.z() * c.y()) + a.y() * (b.z() * c.x() - b.x() * c.z()) +
         a.z() * (b.x() * c.y() - b.y() * c.x());
}

/// How many zeros det(X + w·P, t) has in 0 < w ≤ end. In uniform water the tube's matrix is this
/// pencil, w = ∫c² dτ, and its roots are real, since wavefronts' curvatures are.
int tube_folds(const Mat32& x, const Mat32& p, const Vec3& t, double end) noexcept {
  const Vec3 x1 = x.col(0), x2 = x.col(1), p1 = p.col(0), p2 = p.col(1);
  const double a = triple_product(p1, p2, t);
  const double b = triple_product(x1, p2, t) + triple_product(p1, x2, t);
  const double e = triple_product(x1, x2, t);
  const auto inside = [&](double w) { return w > 1e-12 * end && w <= end; };
  if (std::abs(a) * end <= 1e-14 * std::abs(b)) return b != 0.0 && inside(-e / b) ? 1 : 0;
  const double root = std::sqrt(std::max(0.0, b * b - 4.0 * a * e));
  const double q = -0.5 * (b + std::copysign(root, b));
  const double first = q / a, second = q != 0.0 ? e / q : 0.0;
  return (inside(first) ? 1 : 0) + (inside(second) ? 1 : 0);
}

/// A cubic between two ends of a step, u = 0 … 1.
struct StepChord {
  Vec3 a, va, b, vb;  // places, and h·velocities
  [[nodiscard]] Vec3 at(double u) const noexcept {
    const double w = 1.0 - u;
    return w * w * (1.0 + 2.0 * u) * a + u * w * w * va + u * u * (3.0 - 2.0 * u) * b -
           u * u * w * vb;
  }
  [[nodiscard]] Vec3 slope(double u) const noexcept {
    const double w = 1.0 - u;
    return 6.0 * u * w * (b - a) + w * (1.0 - 3.0 * u) * va + u * (3.0 * u - 2.0) * vb;
  }
};

/// The first u in (from, to] where a room, positive before, is used up. \param room  gives {room,
/// its derivative over u} at u. A dip between both ends is looked for.
template <class Room>
std::optional<double> room_used_up(const Room& room, double from, double to) {
  struct Value {
    double room, slope;
  };
  const auto value = [&](double u) {
    const auto [r, s] = room(u);
    return Value{r, s};
  };
  double low = from, high = to;
  const Value at_high = value(high);
  if (at_high.room > 0.0) {
    const Value at_low = value(low);
    if (!(at_low.slope < 0.0 && at_high.slope > 0.0)) return {};
    double left = low, right = high;  // least room between
    Value middle = at_low;
    for (int i = 0; i < 60 && right - left > 1e-9 * (to - from); ++i) {
      const double u = 0.5 * (left + right);
      middle = value(u);
      if (middle.room <= 0.0) {
        high = u;
        break;
      }
      (middle.slope < 0.0 ? left : right) = u;
    }
    if (middle.room > 0.0) return {};
  }
  double u = high;
  Value at = value(u);
  for (int i = 0; i < 80; ++i) {
    double next = at.slope < 0.0 ? u - at.room / at.slope : 0.5 * (low + high);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - u) <= 1e-15 * std::max(1.0, std::abs(u)) || high - low < 1e-15) break;
    u = next;
    at = value(u);
    (at.room > 0.0 ? low : high) = u;
  }
  return u;
}

}  // namespace

Mat32 launch_basis(const Vec3& d) noexcept {
  const double level = std::hypot(d.x(), d.y());
  Mat32 basis;
  if (level < 1e-12) {
    basis.col(0) = Vec3(0.0, d.z() > 0.0 ? 1.0 : -1.0, 0.0);
    basis.col(1) = Vec3(1.0, 0.0, 0.0);
    return basis;
  }
  basis.col(0) = Vec3(d.z() * d.x() / level, d.z() * d.y() / level, -level);  // up
  basis.col(1) = Vec3(d.y() / level, -d.x() / level, 0.0);                    // clockwise
  return basis;
}

CoursePass course_pass(const VolumeCourse& course, std::size_t leg, const Vec3& receiver) {
  using Knot = VolumeCourse::Knot;
  const VolumeCourse::Leg& on = course.legs[leg];
  const auto closing = [&](const Vec3& x, const Vec3& v) {
    const Vec3 d = receiver - x;
    return d.x() * v.x() + d.y() * v.y() + on.steep * d.z() * v.z();
  };
  const auto spread = [](const std::array<float, 6>& of) {
    Mat32 m;
    for (int k = 0; k < 6; ++k) m(k % 3, k / 3) = double(of[std::size_t(k)]);
    return m;
  };
  CoursePass pass;
  double nearest = infinity;
  const Knot* a = course.knots.data() + on.begin;
  const Knot* const last = course.knots.data() + on.end - 1;
  for (double before = closing(a->x, a->p); a != last; ++a) {
    const Knot* b = a + 1;
    const double begin = before, end = before = closing(b->x, b->p);
    if (!(begin >= 0.0 && end <= 0.0) || begin == end) continue;
    const double h = b->time - a->time;
    const StepChord chord{a->x, h / a->p.squaredNorm() * a->p, b->x, h / b->p.squaredNorm() * b->p};
    double low = 0.0, high = 1.0, u = begin / (begin - end);
    for (int i = 0; i < 20; ++i) {  // false position and halves in turn
      const double rate = closing(chord.at(u), chord.slope(u));
      (rate > 0.0 ? low : high) = u;
      const Vec3 v = chord.slope(u);
      const double square = v.x() * v.x() + v.y() * v.y() + on.steep * v.z() * v.z();
      double next = square > 0.0 ? u + rate / square : 0.5 * (low + high);
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (std::abs(next - u) < 1e-6 || high - low < 1e-6) break;
      u = next;
    }
    const Vec3 x = chord.at(u), d = receiver - x;
    const double distance = d.x() * d.x() + d.y() * d.y() + on.steep * d.z() * d.z();
    if (distance >= nearest) continue;
    nearest = distance;
    pass.x = x;
    pass.tangent = chord.slope(u).normalized();
    // across the ray Ẋ = c²P
    const double w = 1.0 - u;
    pass.x_launch = w * w * (1.0 + 2.0 * u) * spread(a->x_launch) +
                    u * w * w * h / a->p.squaredNorm() * spread(a->p_launch) +
                    u * u * (3.0 - 2.0 * u) * spread(b->x_launch) -
                    u * u * w * h / b->p.squaredNorm() * spread(b->p_launch);
  }
  if (nearest < infinity) return pass;
  // It never comes closest: drawn out beyond its ends.
  const Knot& first = course.knots[on.begin];
  const Knot& end = closing(first.x, first.p) < 0.0 ? first : *last;
  const double square =
      end.p.x() * end.p.x() + end.p.y() * end.p.y() + on.steep * end.p.z() * end.p.z();
  const double w = square > 0.0 ? closing(end.x, end.p) / square : 0.0;
  pass.x = end.x + w * end.p;
  pass.tangent = end.p.normalized();
  pass.x_launch = spread(end.x_launch) + w * spread(end.p_launch);
  return pass;
}

double tube_area(const Mat32& x_launch, const Vec3& tangent) noexcept {
  return triple_product(x_launch.col(0), x_launch.col(1), tangent);
}

double tube_area(const VolumeState& state) noexcept {
  return tube_area(state.x_launch, state.p.normalized());
}

VolumeTracer::VolumeTracer(const VolumeOcean& ocean, double frequency)
    : ocean_(ocean),
      frequency_(frequency),
      attenuation_(ocean.attenuation(frequency)),
      steepest_(ocean.steepest_floor()),
      spacing_(ocean.floor_spacing()),
      shallowest_(ocean.shallowest_floor()),
      bending_(ocean.sideways_bending()) {}

/// One ray on its way.
class VolumeTracer::Run {
 public:
  Run(const VolumeTracer& tracer, const Vec3& receiver, const VolumeLimits& limits, VolumeRay& out,
      bool with_track)
      : tracer_(tracer),
        ocean_(tracer.ocean_),
        receiver_(receiver),
        limits_(limits),
        out_(out),
        with_track_(with_track) {}

  /// For many receivers: passes are left to course_pass().
  Run(const VolumeTracer& tracer, std::span<const Vec3> hull, const VolumeLimits& limits,
      VolumeRay& out, VolumeCourse& course)
      : Run(tracer, hull.front(), limits, out, false) {
    hull_ = hull;
    course_ = &course;
  }

  void follow(const Vec3& from, const Vec3& direction) {
    out_.legs.clear();
    out_.bounces.clear();
    out_.track.clear();
    out_.turned = 0.0;
    source_ = from;
    cell_ = ocean_.water_cell(from, direction);
    const double c = ocean_.speed(from, cell_.index).c;
    out_.source_speed = c;
    s_.x = from;
    s_.p = direction / c;
    first_ = Vec2(direction.x(), direction.y());
    s_.p_launch = launch_basis(direction) / c;
    if (with_track_) out_.track.push_back(from);
    begin_leg();
    for (int i = 0; i < most_volume_steps; ++i) {
      const bool on = cell_.uniform ? straight() : bent();
      if (!on) break;
      if (s_.length >= limits_.longest || cannot_return()) {
        end_leg();
        break;
      }
    }
    if (course_ != nullptr && course_->legs.back().end == 0) course_->legs.pop_back();
  }

 private:
  enum class Event { none, surface, floor, wall };
  struct Met {
    Event event = Event::none;
    double at = infinity;  // share of the step
    Vec3 normal = Vec3::Zero();
  };

  // ── legs and the receiver ────────────────────────────────────────────────────────────────────

  void begin_leg() {
    const double level = std::hypot(s_.p.x(), s_.p.y());
    steep_ = cell_.uniform || std::abs(s_.p.z()) > 1.2 * level ? 1.0 : 0.0;
    leg_begin_ = s_;
    passed_ = false;
    nearest_ = infinity;
    if (course_ == nullptr) return;
    course_->legs.push_back({.key = history_.key,
                             .facets = history_.facets,
                             .begin = course_->knots.size(),
                             .end = 0,
                             .left = std::sqrt(std::norm(history_.reflection) + history_.scattered),
                             .steep = steep_});
    add_knot();
  }

  void add_knot() {
    if (course_ == nullptr) return;
    VolumeCourse::Knot& knot = course_->knots.emplace_back();
    knot.x = s_.x;
    knot.p = s_.p;
    knot.time = s_.time;
    for (int k = 0; k < 6; ++k) {
      knot.x_launch[std::size_t(k)] = float(s_.x_launch(k % 3, k / 3));
      knot.p_launch[std::size_t(k)] = float(s_.p_launch(k % 3, k / 3));
    }
  }

  /// Rate at which the receiver comes closer: zero where it is closest. Of level rays the distance
  /// on the map counts, which has one minimum however often they turn.
  [[nodiscard]] double closing(const Vec3& x, const Vec3& v) const noexcept {
    return closing(receiver_, x, v);
  }
  [[nodiscard]] double closing(const Vec3& receiver, const Vec3& x, const Vec3& v) const noexcept {
    const Vec3 d = receiver - x;
    return d.x() * v.x() + d.y() * v.y() + steep_ * d.z() * v.z();
  }

  void add_pass(const VolumeState& state, double c, int caustics, double beyond) {
    const Vec3 d = receiver_ - state.x;
    const double distance =
        d.x() * d.x() + d.y() * d.y() + steep_ * d.z() * d.z() + beyond * beyond;
    if (distance >= nearest_) return;
    nearest_ = distance;
    passed_ = true;
    pass_.state = state;
    pass_.history = history_;
    pass_.history.caustics = caustics;
    pass_.c = c;
    pass_.beyond = beyond;
    pass_.bounces = out_.bounces.size();
  }

  /// Straight on from a state by so much of w = ∫c² dτ.
  [[nodiscard]] static VolumeState drawn_out(const VolumeState& from, double w, double c) {
    VolumeState s = from;
    s.x += w * from.p;
    s.x_launch += w * from.p_launch;
    s.time += w / (c * c);
    s.length += w / c;
    return s;
  }

  void note_bearing() {
    const double along = first_.x() * s_.p.x() + first_.y() * s_.p.y(),
                 aside = first_.x() * s_.p.y() - first_.y() * s_.p.x();
    out_.turned = std::max(out_.turned, std::abs(std::atan2(aside, along)));
  }

  /// The leg is whole: where it never came closest it is drawn out beyond its ends.
  void end_leg() {
    note_bearing();
    if (course_ != nullptr) {
      course_->legs.back().end = course_->knots.size();
      return;
    }
    if (!passed_) {
      const bool behind = closing(leg_begin_.x, leg_begin_.p) < 0.0;
      const VolumeState& end = behind ? leg_begin_ : s_;
      const double c = 1.0 / end.p.norm();
      const Vec3 weighted(end.p.x(), end.p.y(), steep_ * end.p.z());
      const double square = weighted.dot(end.p);
      const double w = square > 0.0 ? closing(end.x, end.p) / square : 0.0;
      if (std::isfinite(w)) add_pass(drawn_out(end, w, c), c, history_.caustics, std::abs(w) / c);
    }
    if (passed_) out_.legs.push_back(pass_);
  }

  /// Whether a ray that goes away from the receiver cannot be turned round any more: a bounce off
  /// a floor of slope m changes the horizontal slowness by 2m/c at most.
  /// What holds for all corners of a hull holds for all places in it.
  [[nodiscard]] bool cannot_return() const noexcept {
    if (course_ == nullptr) return (passed_ || steep_ == 0.0) && cannot_return_to(receiver_);
    return std::all_of(hull_.begin(), hull_.end(), [&](const Vec3& corner) {
      return (steep_ == 0.0 || closing(corner, s_.x, s_.p) < 0.0) && cannot_return_to(corner);
    });
  }

  [[nodiscard]] bool cannot_return_to(const Vec3& receiver) const noexcept {
    const Vec2 away(s_.x.x() - receiver.x(), s_.x.y() - receiver.y());
    const double distance = away.norm();
    if (distance == 0.0) return false;
    const double outward = (s_.p.x() * away.x() + s_.p.y() * away.y()) / distance;
    const double left =
        tracer_.bending_ > 0.0 ? tracer_.bending_ * (limits_.longest - s_.length) : 0.0;
    const int bounces = limits_.max_bottom_bounces - history_.bottom_bounces;
    const double turned = 2.1 * tracer_.steepest_ * double(bounces) * s_.p.norm() + left;
    return outward > turned + 1e-15;
  }

  // ── steps ────────────────────────────────────────────────────────────────────────────────────

  /// In uniform water: straight to whatever comes next. \return false: the ray ended
  bool straight() {
    const VolumeState from = s_;
    const double c = 1.0 / from.p.norm();
    const Vec3 v = from.p;  // per w
    double end = infinity;  // w of the next event
    Met met;
    const auto sooner = [&](double w, Event event, const Vec3& normal) {
      if (w >= end) return;
      end = w;
      met = {event, 1.0, normal};
    };
    if (v.z() < 0.0)
      sooner(std::max(0.0, (ocean_.surface_depth() - from.x.z()) / v.z()), Event::surface,
             Vec3::UnitZ());
    for (std::size_t i = 0; i < cell_.walls; ++i) {
      const WaterSlab& slab = cell_.slabs[i];
      const double rate = slab.normal.dot(v), at = slab.normal.dot(from.x);
      if (rate > 0.0 && slab.high < infinity)
        sooner(std::max(0.0, (slab.high - at) / rate), Event::wall, slab.normal);
      if (rate < 0.0 && slab.low > -infinity)
        sooner(std::max(0.0, (slab.low - at) / rate), Event::wall, slab.normal);
    }
    const double furthest = (limits_.longest - from.length) * c;
    if (const auto w = floor_ahead(from, v, std::min(end, furthest)))
      sooner(*w, Event::floor, Vec3::Zero());
    if (end > furthest) {
      end = furthest;
      met = {};
    }
    if (course_ == nullptr) note_closest_straight(from, v, c, end);
    if (std::isinf(end)) {
      end_leg();
      return false;
    }
    s_ = drawn_out(from, end, c);
    s_.nepers = from.nepers + absorbed(from.x.z(), s_.x.z(), end / c);
    history_.caustics += tube_folds(from.x_launch, from.p_launch, v * c, end);
    add_knot();
    if (with_track_) out_.track.push_back(s_.x);
    return at_event(met);
  }

  /// Whether all the floor about a straight way is deeper. \param beside  how far off it places are
  [[nodiscard]] bool above_floor(const Vec3& a, const Vec3& b, double beside) const {
    const Vec2 low(std::min(a.x(), b.x()) - beside, std::min(a.y(), b.y()) - beside),
        high(std::max(a.x(), b.x()) + beside, std::max(a.y(), b.y()) + beside);
    return std::max(a.z(), b.z()) + beside < ocean_.shallowest_within(low, high);
  }

  /// w of the first meeting with the floor up to `most`.
  [[nodiscard]] std::optional<double> floor_ahead(const VolumeState& from, const Vec3& v,
                                                  double most) const {
    const auto room = [&](double w) {
      const Vec3 x = from.x + w * v;
      const VolumeFloor floor = ocean_.floor(x.x(), x.y());
      return std::pair(floor.depth - x.z(),
                       floor.gradient.x() * v.x() + floor.gradient.y() * v.y() - v.z());
    };
    if (std::isinf(tracer_.spacing_)) {
      const auto [here, slope] = room(0.0);
      if (slope >= 0.0) return {};
      const double w = std::max(0.0, -here / slope);
      if (w > most) return {};
      return w;
    }
    const double level = std::hypot(v.x(), v.y());
    double w = 0.0;
    if (from.x.z() < tracer_.shallowest_) {  // none before it is as deep as any floor
      if (v.z() <= 0.0) return {};
      w = (tracer_.shallowest_ - from.x.z()) / v.z();
    }
    const double deepest = ocean_.deepest_floor();
    double last = most;
    if (v.z() > 0.0 && deepest < infinity)
      last = std::min(last, (deepest + 1.0 - from.x.z()) / v.z());
    if (v.z() < 0.0 && tracer_.shallowest_ > -infinity)
      last = std::min(last, (tracer_.shallowest_ - from.x.z()) / v.z());
    if (std::isinf(last)) last = w + 1e3 * tracer_.spacing_ / std::max(level, 1e-9 * v.norm());
    const double step = level > 0.0 ? std::min(0.5 * tracer_.spacing_ / level, last - w) : last - w;
    if (!(step > 0.0)) return {};
    for (int above = 0; w < last;) {
      // longer pieces the longer there was no floor near
      double next = std::min(w + step * double(1 << std::min(above, 4)), last);
      if (above_floor(from.x + w * v, from.x + next * v, 0.0)) {
        ++above;
        w = next;
        continue;
      }
      above = 0;
      next = std::min(w + step, last);
      if (const auto at = room_used_up(room, w, next)) return at;
      w = next;
    }
    return {};
  }

  void note_closest_straight(const VolumeState& from, const Vec3& v, double c, double end) {
    const Vec3 weighted(v.x(), v.y(), steep_ * v.z());
    const double square = weighted.dot(v);
    const double w = square > 0.0 ? closing(from.x, v) / square : 0.0;
    if (!(w >= 0.0 && w <= end)) return;
    VolumeState here = drawn_out(from, w, c);
    here.nepers = from.nepers + absorbed(from.x.z(), here.x.z(), w / c);
    add_pass(here, c, history_.caustics + tube_folds(from.x_launch, from.p_launch, v * c, w), 0.0);
  }

  /// ∫ attenuation ds along a straight line between two depths.
  [[nodiscard]] double absorbed(double from, double to, double length) const {
    const DepthFunction& loss = tracer_.attenuation_;
    if (loss.is_constant()) return loss.at(0.0) * length;
    if (std::abs(to - from) < 1e-6) return loss.at(0.5 * (from + to)) * length;
    // straight pieces between the samples: trapezes are exact
    const double top = std::min(from, to), bottom = std::max(from, to);
    double sum = 0.0, z = top;
    const std::span<const double> depths = loss.depths();
    for (auto sample = std::ranges::upper_bound(depths, z); sample != depths.end(); ++sample) {
      const double next = std::min(*sample, bottom);
      sum += 0.5 * (loss.at(z) + loss.just_above(next)) * (next - z);
      z = next;
      if (z >= bottom) break;
    }
    sum += loss.at(z) * (bottom - z);
    return sum / (bottom - top) * length;
  }

  /// ∫ attenuation ds along a step, up to a share of it: over straight pieces, halved until both
  /// halves agree with the whole. Attenuation may jump from layer to layer, as that of biology
  /// does. \param length  of that part of the step [m]
  [[nodiscard]] double absorbed(const StepChord& chord, double part, double length) const {
    if (tracer_.attenuation_.is_constant()) return absorbed(0.0, 0.0, length);
    double sum = 0.0, straight = 0.0;
    const auto over = [&](const Vec3& a, const Vec3& b) {
      return absorbed(a.z(), b.z(), (b - a).norm());
    };
    const auto add = [&](const auto& self, double u, const Vec3& a, double v, const Vec3& b,
                         double whole, int halvings) -> void {
      const double w = 0.5 * (u + v);
      const Vec3 middle = chord.at(w);
      const double first = over(a, middle), second = over(middle, b);
      if (halvings == 0 || std::abs(first + second - whole) < tolerable_nepers) {
        sum += first + second;
        straight += (middle - a).norm() + (b - middle).norm();
        return;
      }
      self(self, u, a, w, middle, first, halvings - 1);
      self(self, w, middle, v, b, second, halvings - 1);
    };
    constexpr int pieces = 4, most_halvings = 20;
    Vec3 from = chord.a;
    for (int i = 0; i < pieces; ++i) {
      const double u = part * i / pieces, v = part * (i + 1) / pieces;
      const Vec3 to = chord.at(v);
      add(add, u, from, v, to, over(from, to), most_halvings);
      from = to;
    }
    return straight > 0.0 ? sum * (length / straight) : 0.0;
  }

  [[nodiscard]] RayVector rate(const RayVector& y) const {
    const Vec3 x = y.segment<3>(0), p = y.segment<3>(3);
    const VolumeSpeed water = ocean_.speed(x, cell_.index);
    const double c = water.c, c2 = c * c;
    RayVector d;
    d.segment<3>(0) = c2 * p;
    d.segment<3>(3) = -water.gradient / c;
    for (int k = 0; k < 2; ++k) {
      const Vec3 dx = y.segment<3>(6 + 3 * k), dp = y.segment<3>(12 + 3 * k);
      const double dc = water.gradient.dot(dx);
      d.segment<3>(6 + 3 * k) = 2.0 * c * dc * p + c2 * dp;
      d.segment<3>(12 + 3 * k) = -(water.hessian * dx) / c + water.gradient * (dc / c2);
    }
    d[18] = c;
    return d;
  }

  /// One step of Dormand & Prince, J. Comp. Appl. Math. 6, 19 (1980). \param error  of the place
  /// and the tube, in tolerances
  [[nodiscard]] RayVector stepped(const RayVector& y, const RayVector& k1, double h, double* error,
                                  RayVector* last) const {
    const RayVector k2 = rate(y + h * (1.0 / 5.0) * k1);
    const RayVector k3 = rate(y + h * (3.0 / 40.0 * k1 + 9.0 / 40.0 * k2));
    const RayVector k4 = rate(y + h * (44.0 / 45.0 * k1 - 56.0 / 15.0 * k2 + 32.0 / 9.0 * k3));
    const RayVector k5 = rate(y + h * (19372.0 / 6561.0 * k1 - 25360.0 / 2187.0 * k2 +
                                       64448.0 / 6561.0 * k3 - 212.0 / 729.0 * k4));
    const RayVector k6 =
        rate(y + h * (9017.0 / 3168.0 * k1 - 355.0 / 33.0 * k2 + 46732.0 / 5247.0 * k3 +
                      49.0 / 176.0 * k4 - 5103.0 / 18656.0 * k5));
    const RayVector end = y + h * (35.0 / 384.0 * k1 + 500.0 / 1113.0 * k3 + 125.0 / 192.0 * k4 -
                                   2187.0 / 6784.0 * k5 + 11.0 / 84.0 * k6);
    if (error == nullptr) return end;
    *last = rate(end);
    const RayVector e = h * (71.0 / 57600.0 * k1 - 71.0 / 16695.0 * k3 + 71.0 / 1920.0 * k4 -
                             17253.0 / 339200.0 * k5 + 22.0 / 525.0 * k6 - 1.0 / 40.0 * *last);
    const double tube = std::max(1.0, y.segment<6>(6).norm());
    *error = std::max(e.segment<3>(0).norm() / limits_.tolerance,
                      e.segment<6>(6).norm() / (tube * std::max(1e-9, 1e-3 * limits_.tolerance)));
    return end;
  }

  /// Where speed varies: one step, or the part of it up to the first event. \return false: ended
  bool bent() {
    const RayVector y = packed_state(s_);
    const RayVector k1 = rate(y);
    const double c = 1.0 / s_.p.norm();
    if (step_ <= 0.0) step_ = 50.0 / c;
    double h = std::min(step_, (limits_.longest - s_.length) / c * 1.0001 + 1e-9);
    const Wall ahead = wall_ahead(k1);
    const bool to_wall = ahead.time < h;
    if (to_wall) h = ahead.time;
    RayVector end, k7;
    for (int i = 0; i < 60; ++i) {
      double error = 0.0;
      end = stepped(y, k1, h, &error, &k7);
      const double factor = error > 0.0 ? 0.9 * std::pow(error, -0.2) : 5.0;
      if (error <= 1.0) {
        const double next = h * std::clamp(factor, 0.3, 5.0);
        if (!to_wall || i > 0 || next < step_) step_ = next;
        break;
      }
      h *= std::clamp(factor, 0.1, 0.9);
    }
    const StepChord chord{y.segment<3>(0), h * k1.segment<3>(0), end.segment<3>(0),
                          h * k7.segment<3>(0)};
    Met met = first_met(chord);
    if (to_wall && (met.event == Event::none || met.event == Event::wall) &&
        std::abs(ahead.offset - ahead.normal.dot(chord.b)) < on_wall())
      met = {Event::wall, 1.0, ahead.normal};  // where it was aimed at
    double part = 1.0;
    RayVector now = end;
    if (met.event != Event::none && met.at < 1.0) {
      part = met.at;
      now = stepped(y, k1, part * h, nullptr, nullptr);
      for (int i = 0; i < 3; ++i) {  // onto the boundary itself
        const auto [room, slope] = room_of(met, now.segment<3>(0), rate(now).segment<3>(0));
        const double near = met.event == Event::wall ? on_wall() : touching_boundary;
        if (slope == 0.0 || std::abs(room) < near) break;
        part = std::clamp(part - room / slope / h, 0.0, 1.0);
        now = stepped(y, k1, part * h, nullptr, nullptr);
      }
    }
    if (course_ == nullptr) note_closest_bent(y, k1, chord, h, part);
    const VolumeState before = s_;
    s_ = unpacked_state(now, before.time + part * h);
    s_.nepers = before.nepers + absorbed(chord, part, s_.length - before.length);
    count_turns(before);
    history_.caustics += folds_on_step(before, s_, c);
    s_.p *= 1.0 / (s_.p.norm() * ocean_.speed(s_.x, cell_.index).c);
    add_knot();
    if (with_track_) out_.track.push_back(s_.x);
    return at_event(met);
  }

  /// How near a wall counts as on it: the speed is the same on both sides.
  [[nodiscard]] double on_wall() const noexcept { return std::max(1e-6, 0.1 * limits_.tolerance); }

  struct Wall {
    double time = infinity;  // to get there
    Vec3 normal = Vec3::Zero();
    double offset = 0.0;
  };
  /// The wall that a ray meets first, as it bends now: n·x + n·ẋ·t + ½n·ẍ·t² is there.
  [[nodiscard]] Wall wall_ahead(const RayVector& rate_now) const {
    Wall first;
    const Vec3 v = rate_now.segment<3>(0), force = rate_now.segment<3>(3);
    const double c2 = v.squaredNorm(), c = std::sqrt(c2);
    // ẍ = 2c(∇c·ẋ)p + c²ṗ, ∇c = −c·ṗ, ẋ = c²p
    const Vec3 a = c2 * force - (2.0 * c * c * force.dot(v) / c2) * v;
    for (std::size_t i = 0; i < cell_.walls; ++i) {
      const WaterSlab& slab = cell_.slabs[i];
      const double at = slab.normal.dot(s_.x), vn = slab.normal.dot(v), an = slab.normal.dot(a);
      for (const double offset : {slab.low, slab.high}) {
        const double left = offset - at;
        if (std::isinf(offset) || std::abs(left) < 2.0 * on_wall()) continue;
        const double under = vn * vn + 2.0 * an * left;
        if (under < 0.0) continue;
        // 2·left/(vn ± √…): the sooner of the positive roots
        const double root = std::sqrt(under);
        for (const double below : {vn + root, vn - root}) {
          const double t = below != 0.0 ? 2.0 * left / below : infinity;
          if (t > 0.0 && t < first.time) first = {t, slab.normal, offset};
        }
      }
    }
    return first;
  }

  [[nodiscard]] std::pair<double, double> room_of(const Met& met, const Vec3& x,
                                                  const Vec3& v) const {
    switch (met.event) {
      case Event::surface:
        return {x.z() - ocean_.surface_depth(), v.z()};
      case Event::floor: {
        const VolumeFloor floor = ocean_.floor(x.x(), x.y());
        return {floor.depth - x.z(),
                floor.gradient.x() * v.x() + floor.gradient.y() * v.y() - v.z()};
      }
      case Event::wall: {
        const double at = met.normal.dot(x), rate = met.normal.dot(v);
        return {wall_ - at, -rate};
      }
      case Event::none:
        break;
    }
    return {0.0, 0.0};
  }

  Met first_met(const StepChord& chord) {
    Met first;
    const auto take = [&](std::optional<double> u, Event event, const Vec3& normal) {
      if (u && *u < first.at) {
        first = {event, *u, normal};
        return true;
      }
      return false;
    };
    const auto plane = [&](const Vec3& normal, double offset, double sign) {
      return [&chord, normal, offset, sign](double u) {
        return std::pair(sign * (normal.dot(chord.at(u)) - offset),
                         sign * normal.dot(chord.slope(u)));
      };
    };
    const auto meets = [&](const Vec3& normal, double offset, double sign) {
      // A cubic lies between its control points.
      const auto room = [&](const Vec3& x) { return sign * (normal.dot(x) - offset); };
      const bool apart = room(chord.a) > 0.0 && room(chord.a + chord.va / 3.0) > 0.0 &&
                         room(chord.b - chord.vb / 3.0) > 0.0 && room(chord.b) > 0.0;
      return apart ? std::nullopt : room_used_up(plane(normal, offset, sign), 0.0, 1.0);
    };
    take(meets(Vec3::UnitZ(), ocean_.surface_depth(), 1.0), Event::surface, Vec3::UnitZ());
    for (std::size_t i = 0; i < cell_.walls; ++i) {
      const WaterSlab& slab = cell_.slabs[i];
      if (slab.low > -infinity && take(meets(slab.normal, slab.low, 1.0), Event::wall, slab.normal))
        wall_ = slab.low;
      if (slab.high < infinity &&
          take(meets(slab.normal, slab.high, -1.0), Event::wall, slab.normal))
        wall_ = slab.high;
    }
    const double bulge = 0.25 * (chord.vb - chord.va).norm();  // off the straight line, at most
    if (std::max(chord.a.z(), chord.b.z()) + bulge < tracer_.shallowest_ ||
        above_floor(chord.a, chord.b, bulge))
      return first;
    const auto room = [&](double u) {
      const Vec3 x = chord.at(u), v = chord.slope(u);
      const VolumeFloor floor = ocean_.floor(x.x(), x.y());
      return std::pair(floor.depth - x.z(),
                       floor.gradient.x() * v.x() + floor.gradient.y() * v.y() - v.z());
    };
    const double level = std::hypot(chord.b.x() - chord.a.x(), chord.b.y() - chord.a.y());
    const int parts = std::isinf(tracer_.spacing_)
                          ? 1
                          : std::clamp(int(std::ceil(2.0 * level / tracer_.spacing_)), 1, 10000);
    for (int i = 0; i < parts && double(i) / parts < first.at; ++i) {
      const double begin = double(i) / parts, end = double(i + 1) / parts;
      if (parts > 1 && above_floor(chord.at(begin), chord.at(end), bulge)) continue;
      if (take(room_used_up(room, begin, end), Event::floor, Vec3::Zero())) break;
    }
    return first;
  }

  void note_closest_bent(const RayVector& y, const RayVector& k1, const StepChord& chord, double h,
                         double part) {
    const double begin = closing(chord.a, chord.va);
    const double end = closing(chord.at(part), chord.slope(part));
    if (!(begin >= 0.0 && end <= 0.0) || begin == end) return;
    double low = 0.0, high = part;
    for (int i = 0; i < 50 && high - low > 1e-6; ++i) {
      const double u = 0.5 * (low + high);
      (closing(chord.at(u), chord.slope(u)) > 0.0 ? low : high) = u;
    }
    double u = 0.5 * (low + high);
    RayVector at = stepped(y, k1, u * h, nullptr, nullptr);
    VolumeState here = unpacked_state(at, s_.time + u * h);
    here.nepers = s_.nepers + absorbed(chord, u, here.length - s_.length);
    const double c = ocean_.speed(here.x, cell_.index).c;
    const VolumeState before = s_;
    add_pass(here, c, history_.caustics + folds_on_step(before, here, 1.0 / before.p.norm()), 0.0);
    if (passed_ && pass_.state.time == here.time) {
      pass_.history.upper_turns += before.p.z() < 0.0 && here.p.z() > 0.0 ? 1 : 0;
      pass_.history.lower_turns += before.p.z() > 0.0 && here.p.z() < 0.0 ? 1 : 0;
    }
  }

  void count_turns(const VolumeState& before) {
    if (before.p.z() < 0.0 && s_.p.z() > 0.0) ++history_.upper_turns;
    if (before.p.z() > 0.0 && s_.p.z() < 0.0) ++history_.lower_turns;
  }

  /// Caustics on a short step: one where the tube's area changes sign, two where both curvatures
  /// pass through theirs.
  [[nodiscard]] static int folds_on_step(const VolumeState& a, const VolumeState& b, double c) {
    const double before = tube_area(a), after = tube_area(b);
    if (before == 0.0 || after == 0.0) return 0;
    if ((before < 0.0) != (after < 0.0)) return 1;
    return tube_folds(a.x_launch, a.p_launch, a.p * c, c * c * (b.time - a.time)) == 2 ? 2 : 0;
  }

  // ── events ───────────────────────────────────────────────────────────────────────────────────

  bool at_event(const Met& met) {
    switch (met.event) {
      case Event::none:
        return true;
      case Event::wall:
        cross(met.normal);
        return true;
      case Event::surface:
        return reflect(BoundaryKind::surface);
      case Event::floor:
        return reflect(BoundaryKind::bottom);
    }
    return true;
  }

  /// Into the next cell: the gradient jumps where neighbours cross a moment sooner or later,
  /// P grows by (ṗ₊ − ṗ₋)(n·X)/(n·ẋ).
  void cross(const Vec3& normal) {
    const VolumeSpeed before = ocean_.speed(s_.x, cell_.index);
    cell_ = ocean_.water_cell(s_.x, s_.p);
    const VolumeSpeed after = ocean_.speed(s_.x, cell_.index);
    const double rate = before.c * before.c * normal.dot(s_.p);
    if (std::abs(rate) < 1e-9 * before.c) return;
    const Vec3 jump = (before.gradient - after.gradient) / before.c;
    for (int k = 0; k < 2; ++k)
      s_.p_launch.col(k) += jump * (normal.dot(s_.x_launch.col(k)) / rate);
    add_knot();
  }

  /// A mirror of slope and curvature, in water with a gradient. Neighbours meet it a moment sooner
  /// or later, elsewhere, where the normal is another. docs/theory/three-dimensional-rays.md
  bool reflect(BoundaryKind kind) {
    const bool surface = kind == BoundaryKind::surface;
    end_leg();
    int& bounces = surface ? history_.surface_bounces : history_.bottom_bounces;
    if (bounces >= (surface ? limits_.max_surface_bounces : limits_.max_bottom_bounces) ||
        out_.bounces.size() >= limits_.most_bounces)
      return false;
    Vec3 n = Vec3::UnitZ();    // into the water
    Mat3 bend = Mat3::Zero();  // ∇n along the boundary
    if (!surface) {
      const VolumeFloor floor = ocean_.floor(s_.x.x(), s_.x.y());
      const Vec3 f(floor.gradient.x(), floor.gradient.y(), -1.0);
      history_.facets = history_.facets * 0x9E3779B97F4A7C15ULL + floor.facet;
      const double size = f.norm();
      n = f / size;
      bend.topLeftCorner<2, 2>() = floor.hessian / size;
      bend -= n * (n.transpose() * bend);
    }
    const VolumeSpeed water = ocean_.speed(s_.x, cell_.index);
    const double c = water.c, c2 = c * c;
    const Vec3 p = s_.p;
    const double across = p.dot(n);
    if (!(across < 0.0)) return false;  // along the boundary: neither in nor out
    const Vec3 out = p - 2.0 * across * n;
    const Vec3 force = -water.gradient / c;
    for (int k = 0; k < 2; ++k) {
      const Vec3 x = s_.x_launch.col(k);
      const double later = -n.dot(x) / (c2 * across);
      const Vec3 where = x + c2 * p * later;  // along the boundary
      const Vec3 turned = bend * where;       // of the normal
      Vec3 dp = s_.p_launch.col(k) + force * later;
      // |p| = 1/c at the place of the meeting: kept by the mirror
      dp -= 2.0 * ((dp.dot(n) + p.dot(turned)) * n + across * turned);
      s_.x_launch.col(k) = where - c2 * out * later;
      s_.p_launch.col(k) = dp - force * later;
    }
    s_.p = out;
    note_bearing();
    ++bounces;
    const double grazing = std::asin(std::clamp(-across * c, 0.0, 1.0));
    out_.bounces.push_back({.boundary = kind,
                            .grazing = grazing,
                            .range = std::hypot(s_.x.x() - source_.x(), s_.x.y() - source_.y())});
    history_.key = bounced_key(history_.key, kind);
    cell_ = ocean_.water_cell(s_.x, s_.p);
    if (limits_.losses && !lose(kind, grazing, c)) return false;
    begin_leg();
    return true;
  }

  /// What the boundary takes, as a marched ray in a plane. \return false: too little is left
  bool lose(BoundaryKind kind, double grazing, double c) {
    const bool surface = kind == BoundaryKind::surface;
    const BoundaryMaterial& material =
        surface ? ocean_.surface_material() : ocean_.floor_material(s_.x.x(), s_.x.y());
    const WaterAtBoundary beside{
        .speed = c, .density = ocean_.water_density(s_.x.z()), .frequency = tracer_.frequency_};
    std::complex<double> coefficient = reflection_coefficient(material, grazing, beside);
    const Roughness& rough = surface ? ocean_.surface_roughness() : ocean_.floor_roughness();
    double scattered = 0.0;
    if (!rough.smooth() || history_.scattered > 0.0) {
      const RoughReflection left =
          rough_reflection(rough, std::sin(grazing), 2.0 * pi * tracer_.frequency_ / c);
      const double mean = left.coherent * left.coherent;
      scattered = std::norm(coefficient) *
                  (history_.scattered * left.energy +
                   std::norm(history_.reflection) * std::max(0.0, left.energy - mean));
      coefficient *= left.coherent;
    }
    history_.reflection *= coefficient;
    history_.scattered = scattered;
    const double left = std::sqrt(std::norm(history_.reflection) + scattered);
    return left > 0.0 && left >= limits_.faintest;
  }

  const VolumeTracer& tracer_;
  const VolumeOcean& ocean_;
  const Vec3 receiver_;
  const VolumeLimits& limits_;
  VolumeRay& out_;
  bool with_track_;
  std::span<const Vec3> hull_;
  VolumeCourse* course_ = nullptr;

  Vec3 source_ = Vec3::Zero();
  Vec2 first_ = Vec2::Zero();  // the launch direction on the map
  VolumeState s_, leg_begin_;
  VolumeHistory history_;
  WaterCell cell_;
  LegPass pass_;
  bool passed_ = false;
  double nearest_ = infinity;
  double steep_ = 0.0;  // weight of the depth in what is closest
  double wall_ = 0.0;   // the plane that the last chord met
  double step_ = 0.0;   // of travel time, as the last one suggests [s]
};

void VolumeTracer::trace(const Vec3& from, const Vec3& direction, const Vec3& receiver,
                         const VolumeLimits& limits, VolumeRay& out, bool with_track) const {
  Run(*this, receiver, limits, out, with_track).follow(from, direction);
}

void VolumeTracer::trace(const Vec3& from, const Vec3& direction, std::span<const Vec3> hull,
                         const VolumeLimits& limits, VolumeCourse& out) const {
  VolumeRay ray;
  out.knots.clear();
  out.legs.clear();
  Run(*this, hull, limits, ray, out).follow(from, direction);
  out.turned = ray.turned;
}

}  // namespace asdic::detail
