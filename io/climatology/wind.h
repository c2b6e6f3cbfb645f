#pragma once
#include <optional>
#include <vector>

#include "io/climatology/tiles.h"

namespace asdic::detail::climatology {

/// The wind speed at a place, of speeds or of eastward and northward components.
class Wind {
 public:
  Wind(const std::vector<DataFile>& files, const OceanTime& when);

  /// Bilinear; of components the mean of the steps' speeds [m/s]; NaN where it is not known.
  [[nodiscard]] double at(double latitude, double longitude) const;
  [[nodiscard]] const Tiles& first() const { return speed_ ? *speed_ : *east_; }
  /// The northward component, where there are components.
  [[nodiscard]] const Tiles* second() const { return speed_ ? nullptr : &*north_; }

 private:
  std::optional<Tiles> speed_, east_, north_;
};

}  // namespace asdic::detail::climatology
