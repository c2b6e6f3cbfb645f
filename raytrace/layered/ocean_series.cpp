#include "raytrace/layered/ocean_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raytrace/layered/fan_nodes.h"

namespace asdic::detail {
namespace {

/// A piece that is not good is halved so often at most.
constexpr int most_halvings = 2;

/// The quadratures are right to 1e-10 of range and time, 1e-8 of every layer's slope, and nearly
/// flat rays have that much noise.
constexpr LegFit<2>::Tolerance tolerance{.range = 2e-6, .time = 1e-12, .slope = 5e-8};

/// Series go on a little beyond the ends of their extent.
constexpr double beyond_ends = 1.01;

SimdLegs nowhere() noexcept {
  const Rays none = std::numeric_limits<double>::quiet_NaN();
  return {none, none, none, none};
}

/// a + sign·b
template <bool detailed>
SimdLegs plus(const SimdLegs& a, double sign, const SimdLegs& b) noexcept {
  SimdLegs sum{a.per_slowness + sign * b.per_slowness, a.d_range + sign * b.d_range};
  if constexpr (detailed) {
    sum.intercept = a.intercept + sign * b.intercept;
    sum.length = a.length + sign * b.length;
  }
  return sum;
}

/// Ranges and slopes of those that a mask names.
void put(const Rays::mask_type& these, const SimdLegs& part, SimdLegs& leg) noexcept {
  where(these, leg.per_slowness) = part.per_slowness;
  where(these, leg.d_range) = part.d_range;
}

}  // namespace

bool OceanSeries::worth_keeping(std::span<const Layer> layers) noexcept {
  return layers.size() >= fewest_layers && layers.size() <= most_layers &&
         std::all_of(layers.begin(), layers.end(), [](const Layer& l) { return !l.closed_form(); });
}

OceanSeries::OceanSeries(std::span<const Layer> layers) {
  // Rays between two neighbours of all the speeds at cuts turn in the same layers.
  std::vector<double> speeds = {layers.front().c_top};
  for (const Layer& layer : layers) speeds.push_back(layer.c_bottom);
  std::sort(speeds.begin(), speeds.end());
  const auto same = [](double a, double b) { return b - a <= 1e-13 * b; };
  speeds.erase(std::unique(speeds.begin(), speeds.end(), same), speeds.end());
  /// Rays linger beside a smooth extremum, or turn in the layers next to it, and their quadratures
  /// are not right to what is asked here.
  const auto critical = critical_speeds(layers, speeds.front(), speeds.back());
  const auto linger = [&](double speed) {
    return std::any_of(critical.begin(), critical.end(), [&](const CriticalSpeed& c) {
      return c.logarithmic && std::abs(c.speed - speed) <= 1e-13 * speed;
    });
  };
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const bool last = i + 1 == speeds.size();
    const double slow = speeds[i], ratio = last ? 0.0 : slow / speeds[i + 1],
                 between = last ? 2.0 * slow : 0.5 * (slow + speeds[i + 1]),
                 end = std::sqrt((1.0 - ratio) * (1.0 + ratio));
    Interval& interval = intervals_.emplace_back(Interval{slow, {}});
    for (double from = 0.0; from < end;) {
      double to = from + series_reach(from, slow, i > 0 ? speeds[i - 1] : 0.0);
      if (to > end - 0.3 * (to - from)) to = end;
      interval.pieces.push_back(std::make_unique<Piece>(layers, slow, between, from, to));
      from = to;
    }
    if (linger(slow))
      for (std::size_t k = 0; k < (last ? 1 : interval.pieces.size()); ++k)
        interval.pieces[k]->give_up();
    if (!last && linger(speeds[i + 1])) interval.pieces.back()->give_up();
  }
}

/// Layer by layer downward for what lies above, and upward for what lies below. Where rays do not
/// come there is no number, and no good series.
void OceanSeries::Piece::compute() {
  const std::size_t n = layers_.size();
  cuts_ = std::make_unique<Cut[]>(n + 1);
  const auto crossed = [&](const Layer& l) { return std::max(l.c_top, l.c_bottom) < between_; };
  const auto come = [&](double speed) { return speed < between_ ? SimdLegs{} : nowhere(); };
  std::vector<SimdLegs> part(n);
  for (std::size_t j = 0; j < LegFit<2>::terms; j += rays_at_once) {
    const SimdRays rays(reference_speed_, LegFit<2>::sigmas(extent(), j));
    Rays top = rays.sine(layers_.front().c_top);
    for (std::size_t i = 0; i < n; ++i) {
      const Layer& layer = layers_[i];
      const Rays bottom = rays.sine(layer.c_bottom);
      part[i] = come(std::min(layer.c_top, layer.c_bottom));
      if (crossed(layer))
        cross_layer<true>(layer, rays, top, bottom, part[i]);
      else if (std::min(layer.c_top, layer.c_bottom) < between_)
        turn_in_layer<true>(layer, rays, layer.c_top < layer.c_bottom ? top : bottom, part[i]);
      top = bottom;
    }
    SimdLegs leg = come(layers_.front().c_top);
    cuts_[0].legs.put(up, j, leg, rays);
    for (std::size_t i = 0; i < n; ++i) {
      const Layer& layer = layers_[i];
      leg = crossed(layer)                 ? plus<true>(leg, 1.0, part[i])
            : layer.c_bottom < layer.c_top ? part[i]
                                           : nowhere();
      cuts_[i + 1].legs.put(up, j, leg, rays);
      cuts_[i + 1].turns_above = cuts_[i].turns_above || !crossed(layer);
    }
    leg = come(layers_.back().c_bottom);
    cuts_[n].legs.put(down, j, leg, rays);
    for (std::size_t i = n; i-- > 0;) {
      const Layer& layer = layers_[i];
      leg = crossed(layer)                 ? plus<true>(leg, 1.0, part[i])
            : layer.c_top < layer.c_bottom ? part[i]
                                           : nowhere();
      cuts_[i].legs.put(down, j, leg, rays);
      cuts_[i].turns_below = cuts_[i + 1].turns_below || !crossed(layer);
    }
  }
}

const OceanSeries::Piece::Cut& OceanSeries::Piece::cut(std::size_t index) {
  if (!computed_.load(std::memory_order_acquire) ||
      !cuts_[index].ready.load(std::memory_order_acquire))
    make(index);
  return cuts_[index];
}

void OceanSeries::Piece::make(std::size_t index) {
  const std::lock_guard lock(mutex_);
  if (!computed_) compute();
  computed_ = true;
  Cut& cut = cuts_[index];
  if (cut.ready) return;
  cut.legs.fit();
  cut.good = cut.legs.good(up, reference_speed_, tolerance) &&
             cut.legs.good(down, reference_speed_, tolerance);
  cut.ready = true;
}

OceanSeries::Piece& OceanSeries::Piece::half(double sigma) {
  const double middle = 0.5 * (low_ + high_);
  std::call_once(halved_, [&] {
    half_[0] = std::make_unique<Piece>(layers_, reference_speed_, between_, low_, middle);
    half_[1] = std::make_unique<Piece>(layers_, reference_speed_, between_, middle, high_);
  });
  return *half_[sigma < middle ? 0 : 1];
}

OceanSeries::Found OceanSeries::find(double c_ref, double sigma, std::size_t cut,
                                     std::size_t other_cut) const {
  const auto above =
      std::upper_bound(intervals_.begin(), intervals_.end(), c_ref * (1.0 + 1e-13),
                       [](double c, const Interval& i) { return c < i.reference_speed; });
  if (above == intervals_.begin()) return {};
  const Interval& interval = *(above - 1);
  const double ratio = interval.reference_speed / c_ref;
  const double own =  // σ where the speed is the interval's
      std::sqrt(std::max((1.0 - ratio) * (1.0 + ratio) + sigma * sigma * (ratio * ratio), 0.0));
  const auto& pieces = interval.pieces;
  const auto at =
      std::upper_bound(pieces.begin(), pieces.end(), own,
                       [](double s, const auto& piece) { return s < piece->extent().high(); });
  Piece* piece = (at == pieces.end() ? pieces.back() : *at).get();
  for (int halved = 0; halved <= most_halvings && !piece->given_up(); ++halved) {
    const Piece::Cut &one = piece->cut(cut), &other = piece->cut(other_cut);
    if (one.good && other.good) return {piece, &one, &other};
    piece = &piece->half(own);
  }
  return {};
}

OceanLegs::OceanLegs(const Column& column, const OceanSeries& series, std::span<const Layer> uncut)
    : series_(&series),
      upper_(anchor(column, column.upper(), uncut)),
      lower_(anchor(column, column.lower(), uncut)) {}

OceanLegs::Anchor OceanLegs::anchor(const Column& column, std::size_t node,
                                    std::span<const Layer> uncut) {
  const auto& layers = column.layers();
  const double depth = node < layers.size() ? layers[node].top : layers.back().bottom;
  std::size_t i = 0;
  while (i < uncut.size() && uncut[i].bottom <= depth) ++i;
  Anchor anchor{.cut = i, .first = node, .last = node};
  if (i == uncut.size() || uncut[i].top == depth) return anchor;
  anchor.above = uncut[i].c_top <= uncut[i].c_bottom;
  if (anchor.above) {
    while (layers[anchor.first].top > uncut[i].top) --anchor.first;
  } else {
    anchor.cut = i + 1;
    while (layers[anchor.last - 1].bottom < uncut[i].bottom) ++anchor.last;
  }
  return anchor;
}

template <bool detailed>
SimdColumn OceanLegs::legs(const Column& column, const OceanSeries::Found& found,
                           const SimdRays& rays) const noexcept {
  const auto walked = [&] { return detailed ? walk_all(column, rays) : walk_sums(column, rays); };
  if (found.piece == nullptr) return walked();
  const double c_ref = found.piece->reference_speed();
  const Rays sine2 = c_ref == rays.reference_speed ? rays.sigma * rays.sigma : rays.sine2(c_ref);
  const Rays sigma = c_ref == rays.reference_speed ? rays.sigma : sqrt(sine2);
  const Rays x = found.piece->extent().x(sigma), per_sigma = 1.0 / sigma;
  if (!all_of(sine2 > 0.0 && abs(x) < beyond_ends)) return walked();

  using Piece = OceanSeries::Piece;
  struct Both {
    SimdLegs up, down;
  };
  const auto from = [&](const Anchor& anchor, const Piece::Cut& cut) {
    const auto [range, slope] = cut.legs.at(x, per_slowness, d_range);
    Both legs{{range[Piece::up], slope[Piece::up] * per_sigma},
              {range[Piece::down], slope[Piece::down] * per_sigma}};
    if constexpr (detailed) {
      const auto [times, lengths] = cut.legs.at(x, intercept, length);
      legs.up.intercept = times[Piece::up];
      legs.down.intercept = times[Piece::down];
      legs.up.length = lengths[Piece::up];
      legs.down.length = lengths[Piece::down];
    }
    if (anchor.first == anchor.last) return legs;
    const SimdLegs part = cross_layers<detailed>(column, anchor.first, anchor.last, rays);
    const double sign = anchor.above ? 1.0 : -1.0;
    return Both{plus<detailed>(legs.up, sign, part), plus<detailed>(legs.down, -sign, part)};
  };
  const Both upper = from(upper_, *found.cut), lower = from(lower_, *found.other_cut);
  SimdColumn legs{.up = upper.up,
                  .down = lower.down,
                  .turns_above = found.cut->turns_above,
                  .turns_below = found.other_cut->turns_below};
  // A short way is summed: as a difference it would lose digits.
  legs.middle = column.lower() <= column.upper() + 2
                    ? cross_layers<detailed>(column, column.upper(), column.lower(), rays)
                    : plus<detailed>(upper.down, -1.0, lower.down);
  return legs;
}

SimdColumn OceanLegs::sums(const Column& column, const OceanSeries::Found& found,
                           const SimdRays& rays) const noexcept {
  return legs<false>(column, found, rays);
}

SimdColumn OceanLegs::sums(const Column& column, const SimdRays& rays) const noexcept {
  std::array<OceanSeries::Found, rays_at_once> found;
  for (std::size_t i = 0; i < rays_at_once; ++i)
    found[i] = find(rays.reference_speed, rays.sigma[i]);
  SimdColumn legs;
  Rays::mask_type todo(true);
  while (any_of(todo)) {
    const auto& piece = found[static_cast<std::size_t>(find_first_set(todo))];
    const auto these = Rays([&](auto i) { return found[i] == piece ? 1.0 : 0.0; }) > 0.5;
    const SimdColumn part = sums(column, piece, only(rays, these));
    put(these, part.up, legs.up);
    put(these, part.middle, legs.middle);
    put(these, part.down, legs.down);
    legs.turns_above = part.turns_above;
    legs.turns_below = part.turns_below;
    todo = todo && !these;
  }
  return legs;
}

SimdColumn OceanLegs::all(const Column& column, const OceanSeries::Found& found,
                          const SimdRays& rays) const noexcept {
  return legs<true>(column, found, rays);
}

}  // namespace asdic::detail
