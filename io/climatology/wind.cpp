#include "io/climatology/wind.h"

#include <cmath>
#include <limits>

namespace asdic::detail::climatology {

Wind::Wind(const std::vector<DataFile>& files, const OceanTime& when) {
  if (has_quantity(files, wind_speed_quantity())) {
    speed_.emplace(files, wind_speed_quantity(), when);
    return;
  }
  std::vector<DataFile> unnamed = files;
  for (DataFile& file : unnamed) file.variable.clear();
  const auto with = [&](const GriddedQuantity& quantity) {
    std::vector<DataFile> some;  // components may be in files of their own
    for (const DataFile& file : unnamed)
      if (has_quantity({file}, quantity)) some.push_back(file);
    return Tiles(some.empty() ? unnamed : some, quantity, when);
  };
  east_.emplace(with(eastward_wind_quantity()));
  north_.emplace(with(northward_wind_quantity()));
}

double Wind::at(double latitude, double longitude) const {
  if (speed_) return speed_->bilinear(latitude, longitude);
  const auto u = east_->bilinear_steps(latitude, longitude),
             v = north_->bilinear_steps(latitude, longitude);
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < std::min(u.size(), v.size()); ++i) {
    const double speed = std::hypot(u[i].value, v[i].value);
    if (std::isnan(speed)) continue;
    sum += u[i].weight * speed;
    weights += u[i].weight;
  }
  return weights > 0.0 ? sum / weights : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace asdic::detail::climatology
