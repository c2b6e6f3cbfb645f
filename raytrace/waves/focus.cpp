#include "raytrace/waves/focus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "core/units.h"
#include "raytrace/layered/branch_table.h"
#include "raytrace/layered/ray_parameter.h"

namespace asdic::detail {
namespace {

constexpr double flattest_ray = 1e-7;  // that is looked at [rad]
constexpr double widest_zone = radians(10.0);

/// The steepest gradient of the speed between surface and bottom, of a table or a law that bends
/// little within an eighth of it [1/s].
double steepest_gradient(const Environment& ocean) {
  constexpr int parts = 8;
  const double top = ocean.surface.depth, floor = ocean.bottom.depth;
  std::vector<double> edges{top};
  for (const double depth : ocean.water.depths())
    if (depth > top && depth < floor) edges.push_back(depth);
  edges.push_back(floor);
  double steepest = 0.0;
  for (std::size_t i = 1; i < edges.size(); ++i)
    for (int k = 0; k < parts; ++k) {
      const double depth = std::lerp(edges[i - 1], edges[i], (k + 0.5) / parts);
      steepest = std::max(steepest, std::abs(ocean.water.at(depth).dc_dz));
    }
  return steepest;
}

/// The widths of ray tubes over the angle at that end where sound is faster: each family of rays is
/// a smooth function of it, through the horizontal too, where it goes on with one vertex more.
class TubeWidths {
 public:
  TubeWidths(const EigenraySolver& solver, double source_depth, double receiver_depth,
             const PathLimits& limits)
      : table_(solver.table(source_depth, receiver_depth, limits)) {
    const SoundSpeed source = solver.environment().water.at(source_depth),
                     receiver = solver.environment().water.at(receiver_depth);
    by_launch_ = source.c >= receiver.c;
    faster_ = by_launch_ ? source.c : receiver.c;
    slower_ = by_launch_ ? receiver.c : source.c;
    turns_above_ = (by_launch_ ? source : receiver).dc_dz < 0.0;
  }

  /// Of a ray, positive up [rad].
  [[nodiscard]] double angle(const Arrival& ray) const {
    return by_launch_ ? ray.launch_elevation : ray.arrival_elevation;
  }

  /// |q| of the family of a ray where its angle is another [m/rad], but for a factor that all have.
  /// Nothing where there is no such ray.
  [[nodiscard]] std::optional<double> at(const Arrival& ray, double angle) const {
    Branch branch{
        .starts_up = ray.launch_elevation > 0.0,
        .vertices = ray.surface_bounces + ray.bottom_bounces + ray.upper_turns + ray.lower_turns};
    const double here = this->angle(ray);
    if (angle * here < 0.0) {
      // From the end it leaves, or before the end it comes to, it turns once more.
      const bool more = (angle > 0.0) == (turns_above_ == by_launch_);
      branch.vertices += more ? 1 : -1;
      if (by_launch_) branch.starts_up = angle > 0.0;
      if (branch.vertices < 0) return std::nullopt;
    }
    const double sine = std::sin(std::max(std::abs(angle), flattest_ray));
    const double slowness = std::cos(std::max(std::abs(angle), flattest_ray)) / faster_;
    const auto intervals = table_->intervals();
    for (auto interval = intervals.rbegin(); interval != intervals.rend(); ++interval) {
      const double reference = interval->reference_speed;
      const double sigma2 = 1.0 - slowness * slowness * reference * reference;
      if (!(sigma2 > 0.0)) continue;
      const double sigma = std::sqrt(sigma2);
      if (sigma > interval->sigma.back()) return std::nullopt;
      const double slope = table_->evaluate(*interval, branch, sigma).slope;
      const double sigma_per_angle = slowness * reference * reference * sine / (faster_ * sigma);
      const double other = std::sqrt(std::max(0.0, 1.0 - slowness * slowness * slower_ * slower_));
      return std::abs(slope * sigma_per_angle * other);
    }
    return std::nullopt;
  }

 private:
  std::shared_ptr<const BranchTable> table_;
  bool by_launch_, turns_above_;
  double faster_, slower_;
};

}  // namespace

std::vector<double> focusing_errors(const EigenraySolver& solver, double source_depth,
                                    double receiver_depth, double frequency,
                                    const PathLimits& limits, const Arrivals& rays,
                                    double faintest) {
  std::vector<double> errors(rays.size(), 0.0);
  double energy = 0.0;
  for (const Arrival& ray : rays) energy += std::norm(ray.amplitude);
  std::optional<TubeWidths> tubes;
  const double speed = solver.environment().water.at(source_depth).c;
  const double wavelength = speed / frequency;
  const double steepest = steepest_gradient(solver.environment());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Arrival& ray = rays[i];
    if (ray.kind == ArrivalKind::diffracted || !(std::norm(ray.amplitude) > faintest * energy))
      continue;
    // The phase of a ray δθ beside it differs by ½k·q·δθ², its wavefront's turn being that of its
    // launch about a focus.
    const double zone =
        std::min(widest_zone, std::sqrt(wavelength / std::max(std::abs(ray.q), 1e-9)));
    // No ray is bent by more than |dc/dz|·τ. Where that is less than the zone of straight rays,
    // nothing focuses, and sound spreads as from images: near the horizontal tubes differ, but what
    // they lack is in waves that do not run (Weyl's integral).
    if (steepest * ray.delay < std::sqrt(wavelength / (speed * ray.delay))) continue;
    if (!tubes) tubes.emplace(solver, source_depth, receiver_depth, limits);
    const double angle = tubes->angle(ray);
    const auto here = tubes->at(ray, angle);
    if (!here) continue;
    const auto above = tubes->at(ray, angle + zone), below = tubes->at(ray, angle - zone);
    if (!above || !below) {
      errors[i] = std::numeric_limits<double>::infinity();
      continue;
    }
    // ψ‴/ψ″ and ½ψ⁗/ψ″, times the zone and its square 2π/ψ″
    const double tilt = 0.5 * (*above - *below) / *here, bend = 0.5 * (*above + *below) / *here - 1;
    errors[i] = (5.0 / 24.0 * tilt * tilt + 0.25 * std::abs(bend)) / (2.0 * pi);
  }
  return errors;
}

}  // namespace asdic::detail
