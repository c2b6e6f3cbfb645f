#include "io/compare/rays.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace asdic::detail::compare {
namespace {

using Ray = bellhop::RayFile::Ray;

constexpr double same_angle_deg = 1e-6;  // printed and read again

struct RayPair {
  std::size_t a, b;
};

double end_distance(const Ray& a, const Ray& b) {
  return std::hypot(a.range.back() - b.range.back(), a.depth.back() - b.depth.back());
}

bool finite_ray(const Ray& ray) {
  const auto all = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
  };
  return std::isfinite(ray.launch_angle_deg) && all(ray.range) && all(ray.depth);
}

std::size_t not_finite(const std::vector<Ray>& rays) {
  return rays.size() -
         static_cast<std::size_t>(std::count_if(rays.begin(), rays.end(), finite_ray));
}

/// Rays of one history, in order of launch angle.
using Families = std::map<std::pair<int, int>, std::vector<std::size_t>>;

Families families(const std::vector<Ray>& rays) {
  Families result;
  for (std::size_t i = 0; i < rays.size(); ++i)
    if (!rays[i].range.empty() && finite_ray(rays[i]))
      result[{rays[i].surface_bounces, rays[i].bottom_bounces}].push_back(i);
  for (auto& [history, family] : result)
    std::stable_sort(family.begin(), family.end(), [&](std::size_t x, std::size_t y) {
      return rays[x].launch_angle_deg < rays[y].launch_angle_deg;
    });
  return result;
}

/// Rays within the tolerance of angle, nearest ends first; those that found a partner leave the
/// lists.
void pair_up(const std::vector<Ray>& a, const std::vector<Ray>& b, double angle_deg,
             std::vector<std::size_t>& ia, std::vector<std::size_t>& ib,
             std::vector<RayPair>& pairs) {
  struct Candidate {
    double distance;
    std::size_t a, b;
  };
  std::vector<Candidate> candidates;
  std::size_t low = 0;
  for (const std::size_t i : ia) {
    const double angle = a[i].launch_angle_deg;
    while (low < ib.size() && b[ib[low]].launch_angle_deg < angle - angle_deg) ++low;
    for (std::size_t k = low; k < ib.size() && b[ib[k]].launch_angle_deg <= angle + angle_deg; ++k)
      candidates.push_back({end_distance(a[i], b[ib[k]]), i, ib[k]});
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& x, const Candidate& y) {
    return std::tie(x.distance, x.a, x.b) < std::tie(y.distance, y.a, y.b);
  });
  std::vector<char> used_a(a.size(), 0), used_b(b.size(), 0);
  for (const Candidate& c : candidates) {
    if (used_a[c.a] != 0 || used_b[c.b] != 0) continue;
    used_a[c.a] = used_b[c.b] = 1;
    pairs.push_back({c.a, c.b});
  }
  std::erase_if(ia, [&](std::size_t i) { return used_a[i] != 0; });
  std::erase_if(ib, [&](std::size_t i) { return used_b[i] != 0; });
}

std::size_t points(const std::vector<Ray>& rays) {
  std::size_t n = 0;
  for (const Ray& ray : rays) n += ray.range.size();
  return n;
}

}  // namespace

Polyline::Polyline(const std::vector<double>& range, const std::vector<double>& depth)
    : range_(range), depth_(depth), length_(range.size(), 0.0) {
  for (std::size_t i = 1; i < range_.size(); ++i)
    length_[i] = length_[i - 1] + std::hypot(range_[i] - range_[i - 1], depth_[i] - depth_[i - 1]);
}

double Polyline::to_segment(std::size_t k, double range, double depth,
                            double& place) const noexcept {
  const double dr = range_[k + 1] - range_[k], dz = depth_[k + 1] - depth_[k];
  const double l2 = dr * dr + dz * dz;
  place = l2 > 0.0
              ? std::clamp(((range - range_[k]) * dr + (depth - depth_[k]) * dz) / l2, 0.0, 1.0)
              : 0.0;
  return std::hypot(range_[k] + place * dr - range, depth_[k] + place * dz - depth);
}

Polyline::Nearest Polyline::nearest(double range, double depth) noexcept {
  if (range_.size() < 2)
    return {.distance = std::hypot(range - range_[0], depth - depth_[0]), .beyond_end = true};
  const std::size_t segments = range_.size() - 1;
  double place = 0.0;
  std::size_t best_segment = last_;
  double best = to_segment(last_, range, depth, place);
  double best_place = place;
  // A point that is D away from node k cannot come nearer than `best` before the path has gone on
  // for D − best: those segments are passed over.
  for (std::size_t k = 0; k < segments;) {
    const double away = std::hypot(range - range_[k], depth - depth_[k]);
    const double skip = length_[k] + away - best;
    if (skip > length_[k + 1]) {
      const auto next = std::upper_bound(length_.begin() + static_cast<std::ptrdiff_t>(k) + 1,
                                         length_.end(), skip);
      k = static_cast<std::size_t>(next - length_.begin()) - 1;
      continue;
    }
    const double distance = to_segment(k, range, depth, place);
    if (distance < best) {
      best = distance;
      best_place = place;
      best_segment = k;
    }
    ++k;
  }
  last_ = best_segment;
  return {.distance = best,
          .beyond_end = (best_segment == 0 && best_place <= 0.0) ||
                        (best_segment + 1 == segments && best_place >= 1.0)};
}

double RayDifference::paired_pct() const noexcept { return share_pct(paired, rays_b); }

RayDifference compare_rays(const bellhop::RayFile& a, const bellhop::RayFile& b,
                           const RayOptions& options) {
  RayDifference result{.rays_a = a.rays.size(),
                       .rays_b = b.rays.size(),
                       .points_a = points(a.rays),
                       .points_b = points(b.rays),
                       .not_finite = not_finite(a.rays) + not_finite(b.rays)};
  std::vector<RayPair> pairs;
  Families fa = families(a.rays), fb = families(b.rays);
  for (auto& [history, ia] : fa) {
    const auto other = fb.find(history);
    if (other == fb.end()) continue;
    for (const double tolerance : {std::min(same_angle_deg, options.angle_deg), options.angle_deg})
      pair_up(a.rays, b.rays, tolerance, ia, other->second, pairs);
  }
  result.paired = pairs.size();
  std::vector<double> path, inside, ends;
  for (const RayPair& pair : pairs) {
    const Ray& ray = a.rays[pair.a];
    Polyline line(b.rays[pair.b].range, b.rays[pair.b].depth);
    double largest = 0.0, largest_inside = 0.0;
    for (std::size_t i = 0; i < ray.range.size(); ++i) {
      const Polyline::Nearest nearest = line.nearest(ray.range[i], ray.depth[i]);
      largest = std::max(largest, nearest.distance);
      if (nearest.beyond_end) continue;
      largest_inside = std::max(largest_inside, nearest.distance);
      if (nearest.distance > result.worst.distance)
        result.worst = {.launch_angle_deg = ray.launch_angle_deg,
                        .range = ray.range[i],
                        .depth = ray.depth[i],
                        .distance = nearest.distance};
    }
    path.push_back(largest);
    inside.push_back(largest_inside);
    ends.push_back(end_distance(ray, b.rays[pair.b]));
  }
  result.path_m = spread_of(std::move(path));
  result.inside_m = spread_of(std::move(inside));
  result.end_m = spread_of(std::move(ends));
  return result;
}

}  // namespace asdic::detail::compare
