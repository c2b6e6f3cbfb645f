#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

// What a DataGrid reads its values from, whatever the file is: netCDF, a raster, a plane in memory.
namespace asdic::detail {

/// What a dimension is. The horizontal ones are x and y [m] where the grid is projected.
enum class GridAxis { longitude, latitude, depth, time };

/// One dimension of a variable.
struct GridDimension {
  std::string name{};
  bool known = false;  ///< as one of the axes
  GridAxis axis{};
  bool projected = false;           ///< x or y [m], not degrees
  std::vector<double> values{};     ///< as stored; lengths in metres, depth positive down
  std::string units{}, calendar{};  ///< of time
  std::vector<double> spans{};      ///< [2·times] of time, as stored
  bool every_year = false;          ///< of time
};

template <class Visit>
void fields(GridDimension& dimension, Visit visit) {
  visit(dimension.name);
  visit(dimension.known);
  visit(dimension.axis);
  visit(dimension.projected);
  visit(dimension.values);
  visit(dimension.units);
  visit(dimension.calendar);
  visit(dimension.spans);
  visit(dimension.every_year);
}

/// What is known of a variable before its values are read.
struct GridVariable {
  bool found = false;
  std::string name{}, units{}, standard_name{}, long_name{}, flag_meanings{};
  std::vector<double> flag_values{};
  std::vector<GridDimension> dimensions{};                  ///< in the order of the variable
  std::vector<double> missing_values{};                     ///< packed
  double least = -std::numeric_limits<double>::infinity();  ///< packed
  double most = std::numeric_limits<double>::infinity();    ///< packed
  double scale = 1.0, offset = 0.0;
  /// Of projected axes, where the file tells: the projection's name, and a text that is the same
  /// for the same projection.
  std::string projection_name{}, projection{};
  std::vector<std::string> remarks{};  ///< what a user should know of it

  [[nodiscard]] double unpacked(double packed) const {
    constexpr double missing = std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(packed) || packed < least || packed > most) return missing;
    for (const double flag : missing_values)  // stored as float, the flag may be a double, or round
      if (std::abs(packed - flag) <= 1e-6 * std::abs(flag)) return missing;
    return packed * scale + offset;
  }
};

template <class Visit>
void fields(GridVariable& variable, Visit visit) {
  visit(variable.found);
  visit(variable.name);
  visit(variable.units);
  visit(variable.standard_name);
  visit(variable.long_name);
  visit(variable.flag_meanings);
  visit(variable.flag_values);
  visit(variable.dimensions);
  visit(variable.missing_values);
  visit(variable.least);
  visit(variable.most);
  visit(variable.scale);
  visit(variable.offset);
  visit(variable.projection_name);
  visit(variable.projection);
  visit(variable.remarks);
}

/// Where a part of a variable begins along each of its dimensions, and how many values it has.
struct GridPart {
  std::vector<std::size_t> start{}, count{};
};

template <class Visit>
void fields(GridPart& part, Visit visit) {
  visit(part.start);
  visit(part.count);
}

/// A variable of a file that is opened, and not loaded.
class GridSource {
 public:
  GridSource() = default;
  GridSource(const GridSource&) = delete;
  GridSource& operator=(const GridSource&) = delete;
  virtual ~GridSource() = default;

  [[nodiscard]] virtual const GridVariable& variable() const noexcept = 0;
  /// A part as it is stored: packed, the last dimension fastest; NaN where the file says that there
  /// is none. \throws InputError
  [[nodiscard]] virtual std::vector<double> read(const GridPart& part) const = 0;

  /// A place of projected axes on the Earth.
  struct Place {
    double longitude, latitude;  ///< [°], of WGS 84
  };
  /// \param x, y  [m]   \return nothing where the file does not tell its projection
  [[nodiscard]] virtual std::optional<Place> on_earth(double x, double y) const {
    static_cast<void>(x);
    static_cast<void>(y);
    return std::nullopt;
  }
};

}  // namespace asdic::detail
