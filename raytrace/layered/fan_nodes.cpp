#include "raytrace/layered/fan_nodes.h"

#include <algorithm>
#include <cmath>

namespace asdic::detail {
namespace {

bool is_smooth_extremum(const Layer& layer, double depth) {
  if (layer.closed_form()) return false;
  const SoundSpeed here = layer.at(depth);
  return std::abs(here.dc_dz) < 1e-6 * std::abs(here.d2c_dz2) * layer.thickness();
}

/// Speeds that the sums cannot resolve. Rays that turn between them pass the one and not the
/// other by less than rounding: there are none in the fan.
bool are_one(double slower, double faster) { return faster - slower <= 1e-13 * faster; }

}  // namespace

/// Of speeds that are one the slowest and the fastest: slower rays meet none of them, faster ones
/// all.
std::vector<CriticalSpeed> critical_speeds(std::span<const Layer> layers, double slowest,
                                           double fastest) {
  std::vector<CriticalSpeed> critical;
  critical.reserve(2 * layers.size() + 2);
  critical.push_back({slowest, false});
  critical.push_back({fastest, false});
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
  std::vector<CriticalSpeed> kept;
  for (auto first = critical.begin(); first != critical.end();) {
    const auto end = std::find_if(first, critical.end(),
                                  [&](const auto& c) { return !are_one(first->speed, c.speed); });
    const bool logarithmic = std::any_of(first, end, [](const auto& c) { return c.logarithmic; });
    const double slowest_of_them = first->speed, fastest_of_them = (end - 1)->speed;
    kept.push_back({slowest_of_them, logarithmic});
    if (fastest_of_them > slowest_of_them) kept.push_back({fastest_of_them, logarithmic});
    first = end;
  }
  return kept;
}

void put_nodes(const CriticalSpeed& slow, const CriticalSpeed& fast, bool analytic,
               std::vector<double>& sigma, double bend) {
  sigma.clear();
  if (are_one(slow.speed, fast.speed)) return;
  // The last node is 1e-12 short of it: the speeds' ratio would not tell it so well.
  const double sigma_end =
      std::sqrt((fast.speed - slow.speed) * (fast.speed + slow.speed)) / fast.speed;
  const int count = analytic ? 16 : 7;
  const double first = sigma_end / (count * count);
  sigma.push_back(1e-10 * sigma_end);
  if (slow.logarithmic)
    for (int m = 14; m >= 1; --m) sigma.push_back(std::ldexp(first, -2 * m));
  if (!slow.logarithmic && bend < first) {
    const int halvings = std::ilogb(first / bend) + 3;
    for (int m = halvings; m >= 1; --m) sigma.push_back(std::ldexp(first, -m));
  }
  for (int j = 1; j < count; ++j) sigma.push_back(sigma_end * (j * j) / (double(count) * count));
  if (fast.logarithmic)
    for (int m = 1; m <= 14; ++m)
      sigma.push_back(sigma_end * (1.0 - std::ldexp(2.0 / count, -2 * m)));
  sigma.push_back(sigma_end * (1.0 - 1e-12));
}

double bend_within(double speed, std::span<const double> others) {
  double next = 0.0;
  for (const double other : others)
    if (other < speed && !are_one(other, speed)) next = std::max(next, other);
  return next > 0.0 ? std::sqrt((speed - next) * (speed + next)) / next : infinity;
}

}  // namespace asdic::detail
