// Ranges of all delays at once (Localiser::ranges): the axis of a map.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry.h"
#include "processing/localiser.h"

namespace asdic::detail {

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
