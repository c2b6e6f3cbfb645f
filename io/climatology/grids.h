#pragma once
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/climatology/netcdf_grid.h"

// The grids of climatologies, by what they hold.
namespace asdic::detail::climatology {

inline constexpr double earth_radius = 6.371e6;  // [m]

/// "30.5 N -60.5 E", for messages.
[[nodiscard]] std::string place(double latitude, double longitude);
/// \throws InputError for what is no place on Earth [degrees]
void check_place(double latitude, double longitude);

/// Finds a variable. \throws InputError that says which file lacks it
[[nodiscard]] NetcdfGrid require(const std::filesystem::path& path,
                                 const std::vector<std::string>& names, const std::string& what);

/// Depth of the sea [m]: below 0 on land, NaN where unknown.
class Bathymetry {
 public:
  explicit Bathymetry(const std::filesystem::path& path);
  [[nodiscard]] double depth(double latitude, double longitude) const {
    const double value = grid_.nearest(longitude, latitude);
    return is_depth_ ? value : -value;
  }
  /// Between grid points, for a floor without steps.
  [[nodiscard]] double between(double latitude, double longitude) const {
    const double value = grid_.bilinear(longitude, latitude);
    return is_depth_ ? value : -value;
  }
  [[nodiscard]] const std::string& variable() const { return grid_.variable(); }

 private:
  NetcdfGrid grid_;
  bool is_depth_ = false;
};

/// Which time steps stand for a month, and a note if the grid cannot tell.
[[nodiscard]] std::vector<std::size_t> time_steps(const NetcdfGrid& grid, std::optional<int> month,
                                                  const std::string& what,
                                                  std::vector<std::string>& notes);

/// Mean over time steps of those that are there.
template <class Value>
double mean(const std::vector<std::size_t>& steps, Value&& value) {
  double sum = 0.0;
  int count = 0;
  for (const std::size_t step : steps) {
    const double x = value(step);
    if (std::isnan(x)) continue;
    sum += x;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// Temperature and salinity of one water column.
struct Column {
  std::vector<double> depth, temperature, salinity;  // [levels] [m], [°C], [psu]

  bool operator==(const Column&) const = default;
};

/// Temperature and salinity over the levels of a grid.
class Hydrography {
 public:
  Hydrography(const std::filesystem::path& path, std::optional<int> month,
              std::vector<std::string>& notes);

  /// Of the nearest grid point, down to the first level that is missing.
  [[nodiscard]] Column at(double latitude, double longitude) const;
  [[nodiscard]] const std::vector<double>& levels() const { return temperature_.depths(); }
  [[nodiscard]] std::string variables() const {
    return temperature_.variable() + " and " + salinity_.variable();
  }

 private:
  NetcdfGrid temperature_, salinity_;
  std::vector<std::size_t> steps_;
  double zero_ = 0.0;
};

}  // namespace asdic::detail::climatology
