#include "raytrace/layered/ocean_fan.h"

#include <algorithm>

namespace asdic::detail {
namespace {

OceanFan::Interval make_interval(std::span<const Layer> layers, const CriticalSpeed& slow,
                                 const CriticalSpeed& fast) {
  OceanFan::Interval interval;
  put_nodes(slow, fast, layers.front().law == Layer::Law::munk, interval.sigma);
  interval.between = 0.5 * (slow.speed + fast.speed);
  interval.nodes = interval.sigma.size();
  while (interval.sigma.size() % rays_at_once != 0) interval.sigma.push_back(interval.sigma.back());
  const std::size_t n = interval.sigma.size();
  interval.per_slowness.resize(layers.size() * n);
  interval.d_range.resize(layers.size() * n);
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    bool some_cross = false, some_turn = false, all_come = true;
    for (std::size_t i = 0; i < n; i += rays_at_once) {
      SimdLegs leg;
      const LayerVisit visit = visit_layer(
          layers[layer], SimdRays(slow.speed, load(&interval.sigma[i])), interval.between, leg);
      some_cross |= any_of(visit.crossed);
      some_turn |= any_of(visit.turned);
      all_come &= all_of(visit.crossed || visit.turned);
      store(leg.per_slowness, &interval.per_slowness[layer * n + i]);
      store(leg.d_range, &interval.d_range[layer * n + i]);
    }
    using Reach = OceanFan::Reach;
    Reach reach = some_turn ? Reach::turned : Reach::crossed;
    if (!all_come || (some_cross && some_turn)) reach = Reach::mixed;
    if (!some_cross && !some_turn) reach = Reach::none;
    interval.reach.push_back(reach);
  }
  return interval;
}

}  // namespace

OceanFan::OceanFan(std::span<const Layer> layers) : layers_(layers) {
  double slowest = layers.front().c_top, fastest = slowest;
  for (const Layer& layer : layers) {
    slowest = std::min({slowest, layer.c_top, layer.c_bottom});
    fastest = std::max({fastest, layer.c_top, layer.c_bottom});
  }
  critical_ = critical_speeds(layers, slowest, fastest);
  slots_ = std::make_unique<Slot[]>(critical_.size());
}

const OceanFan::Interval* OceanFan::find(const CriticalSpeed& slow,
                                         const CriticalSpeed& fast) const {
  const auto same = [](const CriticalSpeed& a, const CriticalSpeed& b) {
    return a.speed == b.speed && a.logarithmic == b.logarithmic;
  };
  const auto it =
      std::lower_bound(critical_.begin(), critical_.end(), slow.speed,
                       [](const CriticalSpeed& c, double speed) { return c.speed < speed; });
  if (it == critical_.end() || it + 1 == critical_.end() || !same(*it, slow) || !same(it[1], fast))
    return nullptr;
  Slot& slot = slots_[static_cast<std::size_t>(it - critical_.begin())];
  std::call_once(slot.once, [&] { slot.interval = make_interval(layers_, slow, fast); });
  return &slot.interval;
}

}  // namespace asdic::detail
