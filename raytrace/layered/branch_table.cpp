#include "raytrace/layered/branch_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raytrace/layered/column_lanes.h"
#include "raytrace/layered/hermite.h"

namespace asdic {
namespace {

/// A speed at which the fan is singular; `logarithmic` where it is a smooth maximum of the profile,
/// near which a ray lingers.
struct CriticalSpeed {
  double speed;
  bool logarithmic;
};

bool is_smooth_extremum(const Layer& layer, double depth) {
  if (layer.closed_form()) return false;
  const SoundSpeed here = layer.at(depth);
  return std::abs(here.dc_dz) < 1e-6 * std::abs(here.d2c_dz2) * layer.thickness();
}

std::vector<CriticalSpeed> critical_speeds(const Column& column, double slowest, double fastest) {
  std::vector<CriticalSpeed> critical = {{slowest, false}, {fastest, false}};
  const auto& layers = column.layers();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Layer& layer = layers[i];
    const bool extremum = is_smooth_extremum(layer, layer.top);
    // Cuts inside an analytic law are no knots: nothing happens to a ray that turns there.
    if (i == 0 || extremum || layer.law != Layer::Law::munk)
      critical.push_back({layer.c_top, extremum});
    critical.push_back({layer.c_bottom, is_smooth_extremum(layer, layer.bottom)});
    if (layer.law == Layer::Law::munk && i + 1 < layers.size() && !critical.back().logarithmic)
      critical.pop_back();
  }
  std::erase_if(critical,
                [&](const CriticalSpeed& c) { return c.speed < slowest || c.speed > fastest; });
  std::sort(critical.begin(), critical.end(),
            [](const auto& a, const auto& b) { return a.speed < b.speed; });
  std::vector<CriticalSpeed> distinct;
  for (const CriticalSpeed& c : critical) {
    if (!distinct.empty() && c.speed - distinct.back().speed <= 1e-13 * c.speed)
      distinct.back().logarithmic |= c.logarithmic;
    else
      distinct.push_back(c);
  }
  return distinct;
}

/// Nodes over (0, σ_end): denser towards 0, where r(σ) bends within the distance to the next slower
/// knot; geometric towards logarithmic ends.
std::vector<double> node_sigmas(double sigma_end, int count, bool log_begin, bool log_end) {
  std::vector<double> sigma;
  const double first = sigma_end / (count * count);
  sigma.push_back(1e-10 * sigma_end);
  if (log_begin)
    for (int m = 14; m >= 1; --m) sigma.push_back(first * std::pow(0.25, m));
  for (int j = 1; j < count; ++j) sigma.push_back(sigma_end * (j * j) / (double(count) * count));
  if (log_end)
    for (int m = 1; m <= 14; ++m)
      sigma.push_back(sigma_end * (1.0 - 2.0 / count * std::pow(0.25, m)));
  sigma.push_back(sigma_end * (1.0 - 1e-12));
  return sigma;
}

}  // namespace

BranchTable::BranchTable(Column column, const PathLimits& limits, const Environment* boundaries)
    : column_(std::move(column)), limits_(limits), boundaries_(boundaries) {
  const double slowest = column_.barrier_speed();
  const double steepest = std::cos(std::min(limits_.max_launch_angle, 0.5 * 3.14159265358979));
  const double fastest = column_.source_speed() / std::max(steepest, 1e-9);
  if (fastest <= slowest) return;
  const auto critical = critical_speeds(column_, slowest, fastest);
  intervals_.reserve(critical.size());
  for (std::size_t i = 0; i + 1 < critical.size(); ++i)
    add_interval(critical[i].speed, critical[i + 1].speed, critical[i].logarithmic,
                 critical[i + 1].logarithmic);
}

void BranchTable::add_interval(double c_slow, double c_fast, bool singular_slow,
                               bool singular_fast) {
  const double ratio = c_slow / c_fast;
  const double sigma_end = std::sqrt((1.0 - ratio) * (1.0 + ratio));
  // One analytic law over the whole depth has few, wide intervals; a table has one from sample to
  // sample.
  const bool wide = column_.layers().front().law == Layer::Law::munk;
  FanInterval interval{.reference_speed = c_slow};
  const std::vector<double> nodes =
      node_sigmas(sigma_end, wide ? 16 : 7, singular_slow, singular_fast);
  for (auto* values : {&interval.sigma, &interval.up, &interval.middle, &interval.down,
                       &interval.d_up, &interval.d_middle, &interval.d_down})
    values->reserve(nodes.size());
  for (std::size_t begin = 0; begin < nodes.size(); begin += rays_at_once) {
    const Rays sigmas([&](auto i) { return nodes[std::min(begin + i, nodes.size() - 1)]; });
    const RayLanes rays(c_slow, sigmas);
    const auto& [up, middle, down, turns_above, turns_below] = walk_sums(column_, rays);
    const Rays chain = -rays.sigma * rays.per_c2 / rays.slowness;  // dξ/dσ
    const Rays cycle = rays.slowness * (up.per_slowness + middle.per_slowness + down.per_slowness);
    const Rays slope = chain * (up.d_range + middle.d_range + down.d_range);
    interval.turns_above = turns_above;
    interval.turns_below = turns_below;
    for (std::size_t i = 0; i < std::min(rays_at_once, nodes.size() - begin); ++i) {
      // Next to a smooth maximum of the profile a ray lingers without end; it is further than any
      // receiver and fainter than anything.
      if (!std::isfinite(cycle[i]) || !std::isfinite(slope[i])) continue;
      interval.sigma.push_back(sigmas[i]);
      interval.up.push_back(rays.slowness[i] * up.per_slowness[i]);
      interval.middle.push_back(rays.slowness[i] * middle.per_slowness[i]);
      interval.down.push_back(rays.slowness[i] * down.per_slowness[i]);
      interval.d_up.push_back(chain[i] * up.d_range[i]);
      interval.d_middle.push_back(chain[i] * middle.d_range[i]);
      interval.d_down.push_back(chain[i] * down.d_range[i]);
    }
  }
  if (interval.sigma.size() < 2) return;
  limit_by_loss(interval);
  intervals_.push_back(std::move(interval));
}

void BranchTable::limit_by_loss(FanInterval& interval) const {
  const std::size_t n = interval.sigma.size();
  interval.loudest_vertices.assign(n - 1, limits_.max_vertices);
  if (!(limits_.faintest > 0.0) || boundaries_ == nullptr) return;
  const auto lossless = [](const BoundaryMaterial& material) {
    return std::holds_alternative<Vacuum>(material) || std::holds_alternative<Rigid>(material);
  };
  struct Met {
    const Boundary* boundary;
    WaterAtBoundary water;
  };
  std::vector<Met> met;
  for (const Boundary* b : {&boundaries_->surface, &boundaries_->bottom}) {
    const bool top = b == &boundaries_->surface;
    if ((top ? interval.turns_above : interval.turns_below) || lossless(b->material)) continue;
    met.push_back({b,
                   {.speed = top ? column_.surface_speed() : column_.bottom_speed(),
                    .density = boundaries_->water_density.at(b->depth)}});
  }
  if (met.empty()) return;
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
  const RayParameter ray(interval.reference_speed, sigma);
  const ColumnSums sums = column_.sums(ray);
  const BranchWeights w = weights(branch, column_.source_is_upper());
  return {w.of(sums.up.range, sums.middle.range, sums.down.range),
          w.of(sums.up.d_range, sums.middle.d_range, sums.down.d_range) * ray.slowness_per_sigma()};
}

namespace {

/// Splits the stretch between two nodes wherever the cubic through their ranges and slopes says
/// that r has an extremum; the extrema themselves are found on the exact r.
class StretchSplitter {
 public:
  StretchSplitter(const BranchTable& table, const FanInterval& interval, const Branch& branch,
                  std::span<const double> ranges,
                  const std::function<void(const MonotoneStretch&)>& visit)
      : table_(table), interval_(interval), branch_(branch), ranges_(ranges), visit_(visit) {}

  void split_cell(std::size_t cell, HermiteNode a, HermiteNode b) {
    cell_ = cell;
    split(a, b);
  }

 private:
  void split(HermiteNode a, HermiteNode b, bool caustic_a = false, int depth = 0) {
    const bool steep = a.x > steep_sigma;
    const Hermite cubic = steep ? Hermite(in_cosine(a), in_cosine(b)) : Hermite(a, b);
    const auto turns = cubic.extrema();
    if (depth < 4 && !turns.empty()) {
      // A change of sign of the exact slope brackets an extremum; without one the cubic saw a
      // wiggle: look at its place and decide there.
      const HermiteNode middle = node(steep ? sine_of_cosine(turns.front()) : turns.front());
      if ((a.slope > 0.0) != (b.slope > 0.0) || (middle.slope > 0.0) != (a.slope > 0.0)) {
        const HermiteNode caustic =
            (middle.slope > 0.0) != (a.slope > 0.0) ? extremum(a, middle) : extremum(middle, b);
        emit(a, caustic, caustic_a, true);
        split(caustic, b, true, depth + 1);
        return;
      }
      split(a, middle, caustic_a, depth + 1);
      split(middle, b, false, depth + 1);
      return;
    }
    emit(a, b, caustic_a, false);
  }

  HermiteNode node(double sigma) const {
    const auto [range, slope] = table_.evaluate(interval_, branch_, sigma);
    return {sigma, range, slope};
  }

  /// Whether no wanted range lies between r there and the extremum, slope²/(2|r″|) away (held to be
  /// eight times as far): then it serves as well.
  bool near_enough(const HermiteNode& here, double curvature) const {
    if (ranges_.empty()) return false;
    const double away = 4.0 * here.slope * here.slope / curvature + 1e-3;
    const auto next = std::lower_bound(ranges_.begin(), ranges_.end(), here.value - away);
    return next == ranges_.end() || *next > here.value + away;
  }

  /// With slope zero, and the sign of what follows.
  static HermiteNode as_extremum(HermiteNode node, bool rises) {
    node.slope = rises ? -1e-300 : 1e-300;
    return node;
  }

  /// The zero of the exact slope between two nodes where it has different signs: secant steps
  /// inside a shrinking bracket.
  HermiteNode extremum(HermiteNode a, HermiteNode b) const {
    const bool rises = a.slope > 0.0;
    HermiteNode best = std::abs(a.slope) < std::abs(b.slope) ? a : b;
    for (int i = 0; i < 60; ++i) {
      // With curvature r″ the range there differs from the extremum by slope²/(2r″).
      const double curvature = std::abs((b.slope - a.slope) / (b.x - a.x));
      if (best.slope * best.slope < 2e-6 * curvature || b.x - a.x < 1e-14 * b.x ||
          (i > 0 && near_enough(best, curvature)))
        break;
      double x = a.x - a.slope * (b.x - a.x) / (b.slope - a.slope);
      if (i % 3 == 2 || !(x > a.x && x < b.x)) x = 0.5 * (a.x + b.x);
      best = node(x);
      ((best.slope > 0.0) == rises ? a : b) = best;
    }
    return as_extremum(best, rises);
  }

  void emit(const HermiteNode& a, const HermiteNode& b, bool caustic_a, bool caustic_b) const {
    if (!(b.x > a.x) || !std::isfinite(a.value) || !std::isfinite(b.value)) return;
    visit_({.interval = &interval_,
            .cell = cell_,
            .branch = branch_,
            .sigma_begin = a.x,
            .sigma_end = b.x,
            .range_begin = a.value,
            .range_end = b.value,
            .slope_begin = a.slope,
            .slope_end = b.slope,
            .caustic_begin = caustic_a,
            .caustic_end = caustic_b});
  }

  const BranchTable& table_;
  const FanInterval& interval_;
  Branch branch_;
  std::size_t cell_ = 0;
  std::span<const double> ranges_;
  const std::function<void(const MonotoneStretch&)>& visit_;
};

}  // namespace

void BranchTable::for_each_stretch(double low, double high,
                                   const std::function<void(const MonotoneStretch&)>& visit) const {
  for_each_stretch(low, high, {}, visit);
}

void BranchTable::for_each_stretch(std::span<const double> ranges,
                                   const std::function<void(const MonotoneStretch&)>& visit) const {
  for_each_stretch(ranges.front(), ranges.back(), ranges, visit);
}

void BranchTable::for_each_stretch(double low, double high, std::span<const double> ranges,
                                   const std::function<void(const MonotoneStretch&)>& visit) const {
  const bool upper = column_.source_is_upper();
  for (const FanInterval& interval : intervals_) {
    const std::size_t n = interval.sigma.size();
    // Between two nodes there is nothing to find after so many vertices: too far, or too faint.
    std::vector<int> most(n - 1);
    const auto cycle = [&](std::size_t i) {
      return interval.up[i] + interval.middle[i] + interval.down[i];
    };
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double cycles = high / std::max(std::min(cycle(i), cycle(i + 1)), 1e-9);
      most[i] = static_cast<int>(std::min<double>(interval.loudest_vertices[i], cycles + 2.0));
    }
    int last = 0;
    for (const int vertices : most) last = std::max(last, vertices);
    for (const bool starts_up : {true, false}) {
      for (int k = 0; k <= last; ++k) {
        const Branch branch{.starts_up = starts_up, .vertices = k};
        if (!interval.turns_above && branch.top_vertices() > limits_.max_surface_bounces) break;
        if (!interval.turns_below && branch.bottom_vertices() > limits_.max_bottom_bounces) break;
        if (k == 0 && starts_up == upper) continue;  // the receiver lies the other way
        const BranchWeights w = weights(branch, upper);
        const auto node = [&](std::size_t i) {
          return HermiteNode{interval.sigma[i],
                             w.of(interval.up[i], interval.middle[i], interval.down[i]),
                             w.of(interval.d_up[i], interval.d_middle[i], interval.d_down[i])};
        };
        StretchSplitter splitter(*this, interval, branch, ranges, visit);
        HermiteNode a = node(0);
        for (std::size_t i = 1; i < n; ++i) {
          if (k > most[i - 1]) {
            if (i < n - 1 && k <= most[i]) a = node(i);
            continue;
          }
          const HermiteNode b = node(i);
          // A cubic stays within its ends widened by a quarter of what its slopes could add.
          const double margin = 0.25 * (b.x - a.x) * (std::abs(a.slope) + std::abs(b.slope)) + 1e-3;
          if (std::max(a.value, b.value) + margin >= low &&
              std::min(a.value, b.value) - margin <= high)
            splitter.split_cell(i - 1, a, b);
          a = b;
        }
      }
    }
  }
}

}  // namespace asdic
