#include "io/netcdf_grid.h"

#include <netcdf.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "io/hdf5/handles.h"
#include "io/text/quote.h"

namespace asdic {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// A netCDF file, open for reading.
struct File {
  int id = -1;
  std::filesystem::path path;

  explicit File(const std::filesystem::path& where) : path(where) {
    hdf5::prepare();
    if (const int status = nc_open(path.c_str(), NC_NOWRITE, &id); status != NC_NOERR) {
      id = -1;
      throw InputError(
          {.where = path.string(),
           .got = "a file that cannot be opened (" + std::string(nc_strerror(status)) + ")",
           .expected = "a netCDF file"});
    }
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (id >= 0) nc_close(id);
  }

  void check(int status, const std::string& variable) const {
    if (status != NC_NOERR)
      throw InputError({.where = path.string() + ": " + variable,
                        .got = "a netCDF error (" + std::string(nc_strerror(status)) + ")",
                        .expected = "a readable variable"});
  }

  [[nodiscard]] std::string text(int variable, const char* key) const {
    std::size_t size = 0;
    nc_type type = NC_NAT;
    if (nc_inq_att(id, variable, key, &type, &size) != NC_NOERR || type != NC_CHAR) return "";
    std::string value(size, '\0');
    if (nc_get_att_text(id, variable, key, value.data()) != NC_NOERR) return "";
    return value.substr(0, value.find('\0'));
  }

  [[nodiscard]] std::vector<double> numbers(int variable, const char* key) const {
    std::size_t size = 0;
    nc_type type = NC_NAT;
    if (nc_inq_att(id, variable, key, &type, &size) != NC_NOERR || type == NC_CHAR) return {};
    std::vector<double> values(size);
    if (nc_get_att_double(id, variable, key, values.data()) != NC_NOERR) return {};
    return values;
  }
};

/// One dimension of a variable.
struct Dimension {
  std::optional<NetcdfGrid::Axis> axis;
  std::string name;
  std::vector<double> values;  // as stored; depth in metres, positive down
};

/// What an axis is by the conventions; its name is asked last.
std::optional<NetcdfGrid::Axis> axis_of(const File& file, int variable, const std::string& name) {
  using Axis = NetcdfGrid::Axis;
  const std::string units = lower(file.text(variable, "units"));
  const std::string standard = lower(file.text(variable, "standard_name"));
  const std::string axis = lower(file.text(variable, "axis"));
  const std::string word = lower(name);
  if (standard == "longitude" || units.starts_with("degrees_e") || units.starts_with("degree_e") ||
      axis == "x")
    return Axis::longitude;
  if (standard == "latitude" || units.starts_with("degrees_n") || units.starts_with("degree_n") ||
      axis == "y")
    return Axis::latitude;
  if (standard == "time" || axis == "t" || units.find(" since ") != std::string::npos)
    return Axis::time;
  if (standard == "depth" || axis == "z" || !file.text(variable, "positive").empty())
    return Axis::depth;
  if (word == "lon" || word == "longitude") return Axis::longitude;
  if (word == "lat" || word == "latitude") return Axis::latitude;
  if (word == "depth" || word == "lev" || word == "level") return Axis::depth;
  if (word == "time" || word == "month") return Axis::time;
  return std::nullopt;
}

}  // namespace

struct NetcdfGrid::Impl {
  File file;
  int id = -1;
  std::string name, units;
  std::vector<Dimension> dimensions;          // in the order of the variable
  std::vector<double> longitudes, latitudes;  // as stored
  std::vector<double> depths;                 // increasing
  bool depths_reversed = false;
  std::vector<double> missing_values, valid;  // packed
  double scale = 1.0, offset = 0.0;

  explicit Impl(const std::filesystem::path& path) : file(path) {}

  void read_dimensions();
  [[nodiscard]] const Dimension* find(Axis axis) const {
    for (const Dimension& dimension : dimensions)
      if (dimension.axis == axis) return &dimension;
    return nullptr;
  }
  [[nodiscard]] double value(std::size_t i, std::size_t j, std::size_t level,
                             std::size_t time) const;
};

void NetcdfGrid::Impl::read_dimensions() {
  int rank = 0;
  file.check(nc_inq_varndims(file.id, id, &rank), name);
  std::vector<int> ids(static_cast<std::size_t>(rank));
  file.check(nc_inq_vardimid(file.id, id, ids.data()), name);
  for (const int dimension_id : ids) {
    char text[NC_MAX_NAME + 1] = {};
    std::size_t size = 0;
    file.check(nc_inq_dim(file.id, dimension_id, text, &size), name);
    Dimension dimension{.axis = std::nullopt, .name = text, .values = std::vector<double>(size)};
    int coordinate = -1;
    if (nc_inq_varid(file.id, text, &coordinate) == NC_NOERR) {
      dimension.axis = axis_of(file, coordinate, text);
      file.check(nc_get_var_double(file.id, coordinate, dimension.values.data()), text);
    }
    if (!dimension.axis.has_value() && size > 1)
      throw InputError({.where = file.path.string() + ": " + name,
                        .got = "the dimension " + in_quotes(text),
                        .expected = "longitude, latitude, depth or time by their units, "
                                    "standard_name or axis"});
    if (dimension.axis == Axis::longitude) longitudes = dimension.values;
    if (dimension.axis == Axis::latitude) latitudes = dimension.values;
    if (dimension.axis == Axis::depth && coordinate >= 0) {
      const std::string unit = lower(file.text(coordinate, "units"));
      const double metres = unit.starts_with("km") || unit.starts_with("kilom") ? 1000.0 : 1.0;
      const double sign = lower(file.text(coordinate, "positive")) == "up" ? -1.0 : 1.0;
      for (double& z : dimension.values) z *= sign * metres;
      depths = dimension.values;
      depths_reversed = depths.size() > 1 && depths.front() > depths.back();
      if (depths_reversed) std::reverse(depths.begin(), depths.end());
    }
    dimensions.push_back(std::move(dimension));
  }
  if (longitudes.empty() || latitudes.empty())
    throw InputError({.where = file.path.string() + ": " + name,
                      .got = "a variable without longitude and latitude",
                      .expected = "one on a grid of them"});
}

double NetcdfGrid::Impl::value(std::size_t i, std::size_t j, std::size_t level,
                               std::size_t time) const {
  std::vector<std::size_t> index;
  for (const Dimension& dimension : dimensions) {
    if (dimension.axis == Axis::longitude)
      index.push_back(i);
    else if (dimension.axis == Axis::latitude)
      index.push_back(j);
    else if (dimension.axis == Axis::depth)
      index.push_back(depths_reversed ? depths.size() - 1 - level : level);
    else if (dimension.axis == Axis::time)
      index.push_back(time);
    else
      index.push_back(0);
  }
  double packed = 0.0;
  file.check(nc_get_var1_double(file.id, id, index.data(), &packed), name);
  if (!std::isfinite(packed)) return missing;
  for (const double flag : missing_values)  // stored as float, the flag may be a double, or round
    if (std::abs(packed - flag) <= 1e-6 * std::abs(flag)) return missing;
  if (valid.size() == 2 && (packed < valid[0] || packed > valid[1])) return missing;
  return packed * scale + offset;
}

NetcdfGrid::NetcdfGrid(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
NetcdfGrid::NetcdfGrid(NetcdfGrid&&) noexcept = default;
NetcdfGrid& NetcdfGrid::operator=(NetcdfGrid&&) noexcept = default;
NetcdfGrid::~NetcdfGrid() = default;

std::optional<NetcdfGrid> NetcdfGrid::find(const std::filesystem::path& path,
                                           const std::vector<std::string>& names) {
  auto impl = std::make_unique<Impl>(path);
  const File& file = impl->file;
  int variables = 0;
  file.check(nc_inq_nvars(file.id, &variables), "variables");
  for (const std::string& wanted : names) {
    for (int id = 0; id < variables; ++id) {
      char text[NC_MAX_NAME + 1] = {};
      file.check(nc_inq_varname(file.id, id, text), "variables");
      if (lower(text) != lower(wanted) && lower(file.text(id, "standard_name")) != lower(wanted))
        continue;
      impl->id = id;
      impl->name = text;
      impl->units = file.text(id, "units");
      for (const char* key : {"missing_value", "_FillValue"})
        for (const double flag : file.numbers(id, key)) impl->missing_values.push_back(flag);
      impl->valid = file.numbers(id, "valid_range");
      if (const auto scale = file.numbers(id, "scale_factor"); !scale.empty())
        impl->scale = scale[0];
      if (const auto offset = file.numbers(id, "add_offset"); !offset.empty())
        impl->offset = offset[0];
      impl->read_dimensions();
      return NetcdfGrid(std::move(impl));
    }
  }
  return std::nullopt;
}

const std::string& NetcdfGrid::variable() const noexcept { return impl_->name; }
const std::string& NetcdfGrid::units() const noexcept { return impl_->units; }
bool NetcdfGrid::has(Axis axis) const noexcept { return impl_->find(axis) != nullptr; }
const std::vector<double>& NetcdfGrid::depths() const noexcept { return impl_->depths; }
std::size_t NetcdfGrid::times() const noexcept {
  const Dimension* time = impl_->find(Axis::time);
  return time == nullptr ? 1 : time->values.size();
}

namespace {

/// Two neighbouring grid points and the share of the second.
struct Between {
  std::size_t low = 0, high = 0;
  double share = 0.0;
};

/// \param period  360 for longitudes, else 0   \return nothing outside (by more than half a step)
std::optional<Between> locate(const std::vector<double>& axis, double x, double period) {
  const std::size_t n = axis.size();
  if (n == 1) return Between{};
  const double step = std::abs(axis.back() - axis.front()) / static_cast<double>(n - 1);
  const bool rising = axis.back() > axis.front();
  const double least = rising ? axis.front() : axis.back();
  const double most = rising ? axis.back() : axis.front();
  if (period > 0.0) x = least + std::fmod(std::fmod(x - least, period) + period, period);
  if (x > most || x < least) {
    if (period > 0.0 && most - least + 1.5 * step >= period) {  // across the seam of the globe
      const double gap = period - (most - least);
      const std::size_t last = rising ? n - 1 : 0, first = rising ? 0 : n - 1;
      return Between{.low = last, .high = first, .share = gap > 0.0 ? (x - most) / gap : 0.0};
    }
    if (period > 0.0 && x > most + step / 2.0) x -= period;  // left of a regional grid
    if (x > most + step / 2.0 || x < least - step / 2.0) return std::nullopt;
    const std::size_t end = (x > most) == rising ? n - 1 : 0;
    return Between{.low = end, .high = end};
  }
  std::size_t i = 0;
  while (i + 2 < n && (rising ? axis[i + 1] <= x : axis[i + 1] >= x)) ++i;
  return Between{.low = i, .high = i + 1, .share = (x - axis[i]) / (axis[i + 1] - axis[i])};
}

}  // namespace

double NetcdfGrid::nearest(double longitude, double latitude, std::size_t level,
                           std::size_t time) const {
  const auto x = locate(impl_->longitudes, longitude, 360.0);
  const auto y = locate(impl_->latitudes, latitude, 0.0);
  if (!x || !y) return missing;
  return impl_->value(x->share < 0.5 ? x->low : x->high, y->share < 0.5 ? y->low : y->high, level,
                      time);
}

double NetcdfGrid::bilinear(double longitude, double latitude, std::size_t level,
                            std::size_t time) const {
  const auto x = locate(impl_->longitudes, longitude, 360.0);
  const auto y = locate(impl_->latitudes, latitude, 0.0);
  if (!x || !y) return missing;
  double sum = 0.0, weights = 0.0;
  for (const bool east : {false, true})
    for (const bool north : {false, true}) {
      const double weight =
          (east ? x->share : 1.0 - x->share) * (north ? y->share : 1.0 - y->share);
      if (weight <= 0.0) continue;
      const double value =
          impl_->value(east ? x->high : x->low, north ? y->high : y->low, level, time);
      if (std::isnan(value)) continue;
      sum += weight * value;
      weights += weight;
    }
  return weights > 0.0 ? sum / weights : missing;
}

}  // namespace asdic
