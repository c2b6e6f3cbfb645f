#include "raytrace/layered/fan_nodes.h"

#include <algorithm>
#include <cmath>

namespace asdic {
namespace {

bool is_smooth_extremum(const Layer& layer, double depth) {
  if (layer.closed_form()) return false;
  const SoundSpeed here = layer.at(depth);
  return std::abs(here.dc_dz) < 1e-6 * std::abs(here.d2c_dz2) * layer.thickness();
}

}  // namespace

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
  std::size_t kept = 0;
  for (const CriticalSpeed& c : critical) {
    if (kept > 0 && c.speed - critical[kept - 1].speed <= 1e-13 * c.speed)
      critical[kept - 1].logarithmic |= c.logarithmic;
    else
      critical[kept++] = c;
  }
  critical.resize(kept);
  return critical;
}

void put_nodes(const CriticalSpeed& slow, const CriticalSpeed& fast, bool analytic,
               std::vector<double>& sigma) {
  const double ratio = slow.speed / fast.speed;
  const double sigma_end = std::sqrt((1.0 - ratio) * (1.0 + ratio));
  const int count = analytic ? 16 : 7;
  const double first = sigma_end / (count * count);
  sigma.clear();
  sigma.push_back(1e-10 * sigma_end);
  if (slow.logarithmic)
    for (int m = 14; m >= 1; --m) sigma.push_back(std::ldexp(first, -2 * m));
  for (int j = 1; j < count; ++j) sigma.push_back(sigma_end * (j * j) / (double(count) * count));
  if (fast.logarithmic)
    for (int m = 1; m <= 14; ++m)
      sigma.push_back(sigma_end * (1.0 - std::ldexp(2.0 / count, -2 * m)));
  sigma.push_back(sigma_end * (1.0 - 1e-12));
}

}  // namespace asdic
