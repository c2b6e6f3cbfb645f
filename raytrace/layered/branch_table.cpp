#include "raytrace/layered/branch_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "raytrace/layered/piece_splitter.h"
#include "raytrace/layered/simd_column.h"
#include "raytrace/math/hermite.h"

namespace asdic::detail {

/// The pieces of a column as sums of an OceanFan's layers, and of what the two cuts left of theirs.
class BranchTable::Parts {
 public:
  Parts(const Column& column, const OceanFan& fan, std::span<const Layer> uncut)
      : column_(column), fan_(fan), of_ocean_(column.layers().size(), cut) {
    std::size_t ocean = 0;
    for (std::size_t i = 0; i < of_ocean_.size(); ++i) {
      const Layer& layer = column.layers()[i];
      if (layer.top == uncut[ocean].top && layer.bottom == uncut[ocean].bottom)
        of_ocean_[i] = ocean;
      if (layer.bottom == uncut[ocean].bottom) ++ocean;
    }
  }

  [[nodiscard]] const OceanFan::Interval* find(const CriticalSpeed& slow,
                                               const CriticalSpeed& fast) const {
    return fan_.find(slow, fast);
  }

  /// walk_sums, of the nodes from `first` on.
  [[nodiscard]] SimdColumn sums(const OceanFan::Interval& interval, const SimdRays& rays,
                                std::size_t first) const {
    SimdColumn sums;
    for (std::size_t i = column_.upper(); i < column_.lower(); ++i)
      add(interval, rays, first, i, sums.middle);
    for (std::size_t i = column_.upper(); i-- > 0;) {
      sums.turns_above = sums.turns_above || ends_rays(i, interval);
      if (add(interval, rays, first, i, sums.up)) break;
    }
    for (std::size_t i = column_.lower(); i < of_ocean_.size(); ++i) {
      sums.turns_below = sums.turns_below || ends_rays(i, interval);
      if (add(interval, rays, first, i, sums.down)) break;
    }
    return sums;
  }

 private:
  static constexpr std::size_t cut = static_cast<std::size_t>(-1);

  /// Whether one of the interval's rays turns there: then none comes to the boundary beyond. Inside
  /// an analytic law others may turn in other layers, up to the last.
  [[nodiscard]] bool ends_rays(std::size_t layer,
                               const OceanFan::Interval& interval) const noexcept {
    const Layer& here = column_.layers()[layer];
    return std::max(here.c_top, here.c_bottom) > interval.between;
  }

  /// \return whether all the rays have turned there, or before
  bool add(const OceanFan::Interval& interval, const SimdRays& rays, std::size_t first,
           std::size_t layer, SimdLegs& leg) const {
    const std::size_t ocean = of_ocean_[layer];
    if (ocean == cut)
      return all_of(visit_layer(column_.layers()[layer], rays, interval.between, leg).turned);
    using Reach = OceanFan::Reach;
    if (interval.reach[ocean] == Reach::none) return true;
    const std::size_t at = ocean * interval.sigma.size() + first;
    leg.per_slowness += load(&interval.per_slowness[at]);
    leg.d_range += load(&interval.d_range[at]);
    return interval.reach[ocean] == Reach::turned;
  }

  const Column& column_;
  const OceanFan& fan_;
  std::vector<std::size_t> of_ocean_;  // [column's layers] which of the ocean's; or cut
};

BranchTable::BranchTable(Column column, const PathLimits& limits, const Environment* boundaries,
                         const KeptOcean& kept)
    : column_(std::move(column)), limits_(limits), boundaries_(boundaries) {
  const double slowest = column_.barrier_speed();
  const double steepest = std::cos(std::min(limits_.max_launch_angle, 0.5 * pi));
  const double fastest = column_.source_speed() / std::max(steepest, 1e-9);
  if (fastest <= slowest) return;
  std::optional<Parts> parts;
  if (kept.fan != nullptr) parts.emplace(column_, *kept.fan, kept.layers);
  if (kept.series != nullptr) legs_.emplace(column_, *kept.series, kept.layers);
  const auto critical = critical_speeds(column_.layers(), slowest, fastest);
  std::vector<double> singular = {column_.source_speed(), column_.receiver_speed()};
  for (const CriticalSpeed& c : critical_speeds(column_.layers(), 0.0, fastest))
    singular.push_back(c.speed);
  intervals_.reserve(critical.size());
  for (std::size_t i = 0; i + 1 < critical.size(); ++i)
    add_interval(critical[i], critical[i + 1], bend_within(critical[i].speed, singular),
                 parts ? &*parts : nullptr);
}

void BranchTable::add_interval(const CriticalSpeed& slow, const CriticalSpeed& fast, double bend,
                               const Parts* parts) {
  const bool analytic = column_.layers().front().law == Layer::Law::munk,
             by_series = analytic && legs_;
  const OceanFan::Interval* known = parts != nullptr ? parts->find(slow, fast) : nullptr;
  if (known != nullptr && known->nodes > 1 && bend < known->sigma[1])
    known = nullptr;  // too few nodes
  std::vector<double> own;
  if (known == nullptr) put_nodes(slow, fast, analytic, own, bend);
  const std::span<const double> nodes =
      known != nullptr ? std::span(known->sigma).first(known->nodes) : own;
  FanInterval interval{.reference_speed = slow.speed};
  interval.numbers = std::make_unique<double[]>(7 * nodes.size());
  double* const numbers = interval.numbers.get();
  const auto column = [&](std::size_t i) { return numbers + i * nodes.size(); };
  std::size_t n = 0;
  for (std::size_t begin = 0; begin < nodes.size(); begin += rays_at_once) {
    const Rays sigmas([&](auto i) { return nodes[std::min(begin + i, nodes.size() - 1)]; });
    const SimdRays rays(slow.speed, sigmas);
    const auto& [up, middle, down, turns_above, turns_below] =
        known != nullptr ? parts->sums(*known, rays, begin)
        : by_series      ? legs_->sums(column_, rays)
                         : walk_sums(column_, rays);
    interval.turns_above = turns_above;
    interval.turns_below = turns_below;
    const Rays xi = rays.slowness;
    const Rays chain = -rays.sigma * rays.per_c2 / xi;  // dξ/dσ
    const Rays values[7] = {sigmas,
                            xi * up.per_slowness,
                            xi * middle.per_slowness,
                            xi * down.per_slowness,
                            chain * up.d_range,
                            chain * middle.d_range,
                            chain * down.d_range};
    const Rays cycle = values[1] + values[2] + values[3], slope = values[4] + values[5] + values[6];
    for (std::size_t i = 0; i < std::min(rays_at_once, nodes.size() - begin); ++i) {
      // Next to a smooth maximum of the profile a ray lingers without end; it is further than any
      // receiver and fainter than anything.
      if (!std::isfinite(cycle[i]) || !std::isfinite(slope[i])) continue;
      for (std::size_t k = 0; k < 7; ++k) column(k)[n] = values[k][i];
      ++n;
    }
  }
  if (n < 2) return;
  std::size_t k = 0;
  for (auto* values : {&interval.sigma, &interval.up, &interval.middle, &interval.down,
                       &interval.d_up, &interval.d_middle, &interval.d_down})
    *values = {column(k++), n};
  limit_by_loss(interval);
  intervals_.push_back(std::move(interval));
}

void BranchTable::limit_by_loss(FanInterval& interval) const {
  const std::size_t n = interval.sigma.size();
  if (!(limits_.faintest > 0.0) || boundaries_ == nullptr) return;
  const auto not_counted = [](const BoundaryMaterial& material) {
    return std::holds_alternative<Vacuum>(material) || std::holds_alternative<Rigid>(material) ||
           depends_on_frequency(material);  // a fan serves all frequencies
  };
  struct Met {
    const Boundary* boundary;
    WaterAtBoundary water;
  };
  std::vector<Met> met;
  for (const Boundary* b : {&boundaries_->surface, &boundaries_->bottom}) {
    const bool top = b == &boundaries_->surface;
    if ((top ? interval.turns_above : interval.turns_below) || not_counted(b->material)) continue;
    met.push_back({b,
                   {.speed = top ? column_.surface_speed() : column_.bottom_speed(),
                    .density = boundaries_->water_density.at(b->depth)}});
  }
  if (met.empty()) return;
  interval.loudest_vertices.assign(n - 1, limits_.max_vertices);
  const auto per_cycle = [&](double sigma) {  // what a bounce off each leaves
    const RayParameter ray(interval.reference_speed, sigma);
    double product = 1.0;
    for (const auto& [boundary, water] : met) {
      const double sine = std::sqrt(std::max(0.0, ray.sine2(water.speed)));
      product *= std::abs(reflection_coefficient(
          boundary->material, std::atan2(sine, ray.slowness * water.speed), water));
    }
    return product;
  };
  double left = per_cycle(interval.sigma[0]);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double middle = per_cycle(0.5 * (interval.sigma[i] + interval.sigma[i + 1]));
    const double right = per_cycle(interval.sigma[i + 1]);
    // the loudest of three rays, and a little more for those between
    const double loudest = 1.02 * std::max({left, middle, right});
    left = right;
    if (loudest >= 1.0) continue;
    const double cycles = std::log(limits_.faintest) / std::log(std::max(loudest, 1e-300));
    interval.loudest_vertices[i] =
        static_cast<int>(std::min<double>(limits_.max_vertices, 2.0 * cycles + 2.0));
  }
}

BranchTable::RangeSlope BranchTable::evaluate(const FanInterval& interval, const Branch& branch,
                                              double sigma) const noexcept {
  // Lanes are as fast for one ray as for many, and know shorter ways through smooth laws.
  const SimdRays rays(interval.reference_speed, Rays(sigma));
  const SimdColumn sums =
      legs_ ? legs_->sums(column_, legs_->find(interval.reference_speed, sigma), rays)
            : walk_sums(column_, rays);
  const BranchWeights w = weights(branch, column_.source_is_upper());
  const double xi = rays.slowness[0];
  return {
      xi * w.of(sums.up.per_slowness[0], sums.middle.per_slowness[0], sums.down.per_slowness[0]),
      -sigma * rays.per_c2 / xi *
          w.of(sums.up.d_range[0], sums.middle.d_range[0], sums.down.d_range[0])};
}

void BranchTable::for_each_piece(double low, double high,
                                 const std::function<void(const MonotonePiece&)>& visit) const {
  for_each_piece(low, high, {}, visit);
}

void BranchTable::for_each_piece(std::span<const double> ranges,
                                 const std::function<void(const MonotonePiece&)>& visit) const {
  for_each_piece(ranges.front(), ranges.back(), ranges, visit);
}

void BranchTable::for_each_piece(double low, double high, std::span<const double> ranges,
                                 const std::function<void(const MonotonePiece&)>& visit) const {
  const bool upper = column_.source_is_upper();
  std::vector<int> most;
  std::vector<double> r, slope, least, greatest;  // of a branch at the nodes and between them
  for (const FanInterval& interval : intervals_) {
    const std::size_t n = interval.sigma.size();
    // Between two nodes there is nothing to find after so many vertices: too far, or too faint.
    most.resize(n - 1);
    for (auto* values : {&r, &slope, &least, &greatest}) values->resize(n);
    const auto cycle = [&](std::size_t i) {
      return interval.up[i] + interval.middle[i] + interval.down[i];
    };
    int last = 0;
    // A ray that meets both boundaries crosses all of the water from vertex to vertex.
    const double in_time = interval.turns_above || interval.turns_below
                               ? infinity
                               : limits_.max_delay / column_.least_crossing_time() + 2.0;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double cycles = high / std::max(std::min(cycle(i), cycle(i + 1)), 1e-9);
      const int loudest =
          interval.loudest_vertices.empty() ? limits_.max_vertices : interval.loudest_vertices[i];
      most[i] = static_cast<int>(std::min({double(loudest), cycles + 2.0, in_time}));
      last = std::max(last, most[i]);
    }
    for (const bool starts_up : {true, false}) {
      for (int k = limits_.min_vertices; k <= last; ++k) {
        const Branch branch{.starts_up = starts_up, .vertices = k};
        if (!interval.turns_above && branch.top_vertices() > limits_.max_surface_bounces) break;
        if (!interval.turns_below && branch.bottom_vertices() > limits_.max_bottom_bounces) break;
        if (k == 0 && starts_up == upper) continue;  // the receiver lies the other way
        const BranchWeights w = weights(branch, upper);
        for (std::size_t i = 0; i < n; ++i) {
          r[i] = w.of(interval.up[i], interval.middle[i], interval.down[i]);
          slope[i] = w.of(interval.d_up[i], interval.d_middle[i], interval.d_down[i]);
        }
        // A cubic stays within its ends widened by a quarter of what its slopes could add.
        for (std::size_t i = 0; i + 1 < n; ++i) {
          const double margin = 0.25 * (interval.sigma[i + 1] - interval.sigma[i]) *
                                    (std::abs(slope[i]) + std::abs(slope[i + 1])) +
                                1e-3;
          least[i] = std::min(r[i], r[i + 1]) - margin;
          greatest[i] = std::max(r[i], r[i + 1]) + margin;
        }
        const auto node = [&](std::size_t i) {
          return HermiteNode{interval.sigma[i], r[i], slope[i]};
        };
        PieceSplitter splitter(*this, interval, branch, ranges, visit);
        for (std::size_t i = 0; i + 1 < n; ++i)
          if (k <= most[i] && greatest[i] >= low && least[i] <= high)
            splitter.split_cell(i, node(i), node(i + 1));
      }
    }
  }
}

}  // namespace asdic::detail
