#include "processing/localiser.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry.h"
#include "raytrace/ocean/environment.h"
#include "raytrace/paths/trace_ray.h"
#include "sonar/paths/enough_bounces.h"

namespace asdic::detail {
namespace {

/// The path of a kind among eigenrays; of two, the one nearer in angle.
const Arrival* of_kind(const Arrivals& paths, const PathHistory& history, double elevation) {
  const Arrival* best = nullptr;
  for (const Arrival& path : paths)
    if (history_of(path) == history &&
        (best == nullptr || std::abs(path.launch_elevation - elevation) <
                                std::abs(best->launch_elevation - elevation)))
      best = &path;
  return best;
}

Vec3 received_at(const Detection& detection, const SonarPlaces& places) {
  return places.array.at(detection.time).position;
}

/// Without a bearing a pair that lies apart puts it on an ellipse, not at a range.
bool on_ellipse(const Detection& detection, const SonarPlaces& places) {
  const bool bearing_known = places.shape.kind != ArrayKind::point && !places.shape.upright();
  const double apart = separation(places.source.position, received_at(detection, places)).range;
  return !bearing_known && apart > farthest_apart * detection.time;
}

}  // namespace

std::string_view words_for(Unplaced reason) noexcept {
  switch (reason) {
    case Unplaced::no:
      return "";
    case Unplaced::no_bearing:
      return "no bearing, a pair apart";
    case Unplaced::no_path:
      return "no path to the depth takes so long";
    case Unplaced::ray_ends:
      return "the ray ends before";
  }
  return "";
}

void Location::set_slopes(double xi_out, double xi_home, double turn, double factor) {
  range_slope = 1.0 / (xi_out * std::cos(turn) + xi_home);
  bearing_slope = -xi_out * range * std::sin(turn) * range_slope;
  rate_slope = 1.0 / (xi_out + xi_home);
  range_rate = -(factor - 1.0) * rate_slope;
}

Unplaced Localiser::reason(const Detection& detection, const SonarPlaces& places) const {
  if (on_ellipse(detection, places)) return Unplaced::no_bearing;
  const bool elevation_known = places.shape.upright() ||
                               (places.shape.kind == ArrayKind::plane && !places.shape.bent) ||
                               places.shape.kind == ArrayKind::volume;
  return elevation_known && !settings_.depth ? Unplaced::ray_ends : Unplaced::no_path;
}

/// One detection with one bearing.
struct Localiser::Query {
  const Detection& detection;
  const SonarPlaces& places;
  Vec3 received_at = Vec3::Zero();  ///< the array when the echo came
  double bearing = 0.0;
  std::optional<double> elevation;  ///< measured
  double elevation_sigma = 0.0;
};

Localiser::Localiser(const PropagationPaths& paths, const LocaliserSettings& settings)
    : paths_(paths),
      settings_(settings),
      tables_(paths, settings.frequency, settings.propagation, settings.ranges) {}

/// Eigenrays between two places, with no more bounces than the path that is looked for has.
Arrivals Localiser::like(const PathHistory& wanted, const Vec3& from, const Vec3& to) const {
  PathLimits limits =
      limits_of(settings_.propagation, std::max(wanted.surface_bounces, wanted.bottom_bounces));
  limits.max_surface_bounces = std::min(limits.max_surface_bounces, wanted.surface_bounces);
  limits.max_bottom_bounces = std::min(limits.max_bottom_bounces, wanted.bottom_bounces);
  limits.diffraction = false;  // it has no history
  return paths_.find(from, to, settings_.frequency, limits);
}

std::optional<Location> Localiser::at_depth(const Query& query, double depth) const {
  const Vec3 from = query.places.source.position, back = query.received_at;
  const Vec3 across = direction(query.bearing, 0.0);
  const auto point = [&](double range) {
    Vec3 p = back + range * across;
    p.z() = depth;
    return p;
  };
  Location found;
  found.bearing = query.bearing;
  if (settings_.speed) {  // straight rays
    const double c = *settings_.speed;
    double low = 0.0, high = 0.5 * c * query.detection.time + (from - back).norm();
    const auto delay = [&](double r) {
      return ((point(r) - from).norm() + (point(r) - back).norm()) / c;
    };
    if (delay(0.0) > query.detection.time) return std::nullopt;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (delay(middle) < query.detection.time ? low : high) = middle;
    }
    found.range = low;
    found.position = point(low);
    found.elevation = std::atan2(back.z() - depth, low);
    const Separation out = separation(from, found.position);
    const double xi_home = std::cos(found.elevation) / c,
                 xi_out = out.range / (c * (found.position - from).norm());
    found.struck = (found.position - from).norm() / c;
    found.set_slopes(xi_out, xi_home, out.bearing - query.bearing, query.detection.doppler);
    return found;
  }
  const double offset = std::hypot((from - back).x(), (from - back).y());
  const double longest = DelayTables::longest(query.detection.time, offset);
  const auto home = tables_.from(back, query.bearing, depth, longest);
  // The other leg's plane turns with the range unless both ends are in one place: its table is that
  // of the plane towards the point where a straight ray would put it.
  const Vec3 guess = point(0.5 * 1500.0 * query.detection.time);
  const auto out = tables_.from(
      from, offset < 1.0 ? query.bearing : separation(from, guess).bearing, depth, longest);

  struct Candidate {
    const DelayTable::Branch *out, *home;
    double range, score, elevation_out, elevation_home, struck;
  };
  std::optional<Candidate> best;
  // The other way to each node, once for all pairs.
  std::vector<Separation> ways;
  for (const double range : home->ranges()) ways.push_back(separation(from, point(range)));
  std::vector<double> delays(ways.size());
  for (const auto& there : out->branches()) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const auto leg = out->at(there, ways[i].range);
      delays[i] = leg ? leg->delay : none;
    }
    for (const auto& here : home->branches()) {
      std::size_t last = 0;
      double last_excess = none;
      for (const DelayTable::Node& node : here.nodes) {
        const std::size_t i = node.place;
        const double excess = delays[i] + node.delay - query.detection.time;
        if (i == last + 1 && last_excess <= 0.0 && excess > 0.0) {
          const auto leg = out->at(there, ways[i].range);
          const double last_range = home->ranges()[last];
          const double range =
              last_range + (node.range - last_range) * last_excess / (last_excess - excess);
          double score = leg->amplitude * node.amplitude;
          if (query.places.pattern != nullptr)
            score *= std::abs(query.places.pattern->towards(ways[i].bearing, leg->elevation));
          if (query.elevation) {
            const double off = (node.elevation - *query.elevation) / query.elevation_sigma;
            score *= std::exp(-0.5 * off * off) + 1e-12;
          }
          if (!best || score > best->score)
            best =
                Candidate{&there, &here, range, score, leg->elevation, node.elevation, leg->delay};
        }
        last = i;
        last_excess = excess;
      }
    }
  }
  if (!best) return std::nullopt;

  // Newton with exact eigenrays.
  found.range = best->range;
  found.elevation = best->elevation_home;
  found.struck = best->struck;
  for (int i = 0; i < 6; ++i) {
    const Vec3 p = point(found.range);
    const Arrivals homes = like(best->home->history, back, p);
    const Arrivals outs = like(best->out->history, from, p);
    const Arrival* h = of_kind(homes, best->home->history, found.elevation);
    const Arrival* o = of_kind(outs, best->out->history, best->elevation_out);
    if (h == nullptr || o == nullptr) break;  // at the end of a branch: the table's answer stands
    found.set_slopes(o->horizontal_slowness, h->horizontal_slowness,
                     separation(from, p).bearing - query.bearing, query.detection.doppler);
    const double step = (query.detection.time - o->delay - h->delay) * found.range_slope;
    if (!std::isfinite(step) || std::abs(step) > 2.0 * home->step()) break;
    found.range += step;
    found.elevation = h->launch_elevation;
    found.struck = o->delay;
    found.surface_bounces = o->surface_bounces + h->surface_bounces;
    found.bottom_bounces = o->bottom_bounces + h->bottom_bounces;
    if (std::abs(step) < 1e-3) break;
  }
  found.position = point(found.range);
  if (!(found.rate_slope > 0.0)) {  // by the table alone
    const Vec3& p = found.position;
    const double turn = separation(from, p).bearing - query.bearing;
    found.set_slopes(std::cos(best->elevation_out) / paths_.speed_at(from),
                     std::cos(found.elevation) / paths_.speed_at(back), turn,
                     query.detection.doppler);
  }
  return found;
}

std::optional<Location> Localiser::along_ray(const Query& query) const {
  // Out and back by the same ray from where the echo was received: the point at half the delay, and
  // then, at that depth, as at_depth() does it with both ends where they are.
  const Environment& ocean = paths_.along_transect().environment();
  double depth = 0.0;
  if (settings_.speed) {
    depth = query.received_at.z() -
            0.5 * *settings_.speed * query.detection.time * std::sin(*query.elevation);
  } else {
    const double reach = 800.0 * query.detection.time + 1.0;
    const Plane plane = paths_.plane(query.received_at, query.bearing, reach);
    const RayPath ray = paths_.layered()
                            ? trace_ray(ocean, query.received_at.z(), *query.elevation, reach, 5.0)
                            : trace_ray(paths_.solver(plane)->environment(), query.received_at.z(),
                                        *query.elevation, reach, 5.0);
    const double half = 0.5 * query.detection.time;
    const auto after = std::find_if(ray.points.begin(), ray.points.end(),
                                    [&](const RayPoint& p) { return p.time >= half; });
    if (after == ray.points.end() || after == ray.points.begin()) return std::nullopt;
    const RayPoint &a = *(after - 1), &b = *after;
    const double t = b.time > a.time ? (half - a.time) / (b.time - a.time) : 0.0;
    depth = a.depth + t * (b.depth - a.depth);
  }
  const Vec3 there =
      query.received_at + 750.0 * query.detection.time * direction(query.bearing, 0.0);
  const double top = paths_.surface_depth(there) + 1.0, bottom = paths_.bottom_depth(there) - 1.0;
  return at_depth(query, std::clamp(depth, std::min(top, bottom), bottom));
}

std::optional<Location> Localiser::towards(Query query, std::optional<double> bearing) const {
  query.bearing = bearing.value_or(0.0);
  std::optional<Location> found =
      !settings_.depth && query.elevation
          ? along_ray(query)
          : at_depth(query, settings_.depth.value_or(settings_.shallow));
  if (found && !bearing) found->bearing = std::numeric_limits<double>::quiet_NaN();
  return found;
}

std::vector<Location> Localiser::locate(const Detection& detection, const SonarPlaces& places,
                                        double elevation_sigma) const {
  const ArrayShape& shape = places.shape;
  Query query{
      .detection = detection, .places = places, .received_at = received_at(detection, places)};
  std::vector<Location> result;
  const auto keep = [&](std::optional<Location> found) {
    if (found) result.push_back(*found);
  };
  query.elevation_sigma = std::max(elevation_sigma, 1e-3);
  if (on_ellipse(detection, places)) return result;
  if (shape.kind == ArrayKind::point) {
    keep(towards(query, std::nullopt));
  } else if (shape.upright()) {
    query.elevation = detection.elevation;
    keep(towards(query, std::nullopt));
  } else if (shape.kind == ArrayKind::line || shape.bent) {
    // look·axis = cos e·(a_x sin β + a_y cos β) − a_z sin e: two bearings for the path's elevation.
    const double along = std::hypot(shape.axis.x(), shape.axis.y());
    const double axis_bearing = std::atan2(shape.axis.x(), shape.axis.y());
    const double seen = detection.look.dot(right_of(shape.axis));
    for (const double side : {1.0, -1.0}) {
      if (shape.bent && side * seen < 0.0) continue;
      std::optional<Location> found;
      double elevation = 0.0;
      for (int i = 0; i < 4; ++i) {
        const double cosine = (detection.cosine + shape.axis.z() * std::sin(elevation)) /
                              (along * std::cos(elevation));
        const double bearing = axis_bearing + side * std::acos(std::clamp(cosine, -1.0, 1.0));
        found = towards(query, std::remainder(bearing, 2.0 * pi));
        if (!found || std::abs(found->elevation - elevation) < 1e-4) break;
        elevation = found->elevation;
      }
      keep(found);
    }
  } else {
    std::vector<Vec3> looks{detection.look};
    if (shape.kind == ArrayKind::plane) looks.push_back(mirrored(shape, detection.look));
    for (const Vec3& look : looks) {
      query.elevation = std::asin(std::clamp(-look.z(), -1.0, 1.0));
      keep(towards(query, std::atan2(look.x(), look.y())));
    }
  }
  return result;
}

// Ranges of all delays at once: the axis of a map.

std::vector<double> Localiser::ranges(double bearing, std::span<const double> times,
                                      const SonarPlaces& places) const {
  std::vector<double> found(times.size(), std::numeric_limits<double>::quiet_NaN());
  if (times.empty()) return found;
  const double depth = settings_.depth.value_or(settings_.shallow);
  const Vec3 from = places.source.position, across = direction(bearing, 0.0);
  const Vec3 at_ping = places.array.at(0.0).position;
  const Vec3 received = places.array.at(times.back()).position;
  const double apart = std::max(separation(from, at_ping).range, separation(from, received).range);
  const double longest = DelayTables::longest(times.back(), apart);
  // The place at a range, from where the array is when its echo comes (to a straight ray's delay).
  const auto point = [&](double range) {
    Vec3 p = at_ping + range * across;
    p = places.array.at((range + separation(from, p).range) / 1500.0).position + range * across;
    p.z() = depth;
    return p;
  };
  std::vector<double> loudest(times.size(), 0.0);
  const auto take = [&](double first, double last, double range, double step, double score) {
    // delays first … last at range − step … range
    const auto begin = std::lower_bound(times.begin(), times.end(), first),
               end = std::upper_bound(begin, times.end(), last);
    for (auto t = begin; t != end; ++t) {
      const auto i = static_cast<std::size_t>(t - times.begin());
      if (score <= loudest[i]) continue;
      loudest[i] = score;
      found[i] = range - step * (last > first ? (last - *t) / (last - first) : 0.0);
    }
  };
  if (settings_.speed) {  // straight rays
    const double step = longest / static_cast<double>(settings_.ranges);
    double before = 0.0;
    for (std::size_t i = 0; i <= settings_.ranges; ++i) {
      const double range = step * static_cast<double>(i);
      const Vec3 p = point(range);
      const double back = std::hypot(range, depth - at_ping.z());
      const double delay = ((p - from).norm() + back) / *settings_.speed;
      if (i > 0) take(before, delay, range, step, 1.0);
      before = delay;
    }
    return found;
  }
  const auto home = tables_.from(received, bearing, depth, longest);
  const Vec3 middle = point(0.5 * 750.0 * times.back());
  const auto out =
      tables_.from(from, apart < 1.0 ? bearing : separation(from, middle).bearing, depth, longest);
  std::vector<Separation> ways;
  for (const double range : home->ranges()) ways.push_back(separation(from, point(range)));
  for (const auto& here : home->branches())
    for (const auto& there : out->branches()) {
      double before = 0.0, range_before = -1.0;
      for (const DelayTable::Node& node : here.nodes) {
        const Separation& way = ways[node.place];
        const auto leg = out->at(there, way.range);
        const double delay = leg ? leg->delay + node.delay : 0.0;
        const double step = node.range - range_before;
        if (leg && range_before >= 0.0 && step < 1.5 * home->step() && delay > before) {
          double score = leg->amplitude * node.amplitude;
          if (places.pattern != nullptr)
            score *= std::abs(places.pattern->towards(way.bearing, leg->elevation));
          take(before, delay, node.range, step, score);
        }
        range_before = leg ? node.range : -1.0;
        before = delay;
      }
    }
  return found;
}

}  // namespace asdic::detail
