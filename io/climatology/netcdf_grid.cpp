#include "io/climatology/netcdf_grid.h"

#include <netcdf.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/text.h"
#include "io/files/files_read.h"
#include "io/files/input_file.h"
#include "io/hdf5/gate.h"
#include "io/hdf5/handles.h"
#include "io/isolated/child.h"
#include "io/isolated/pack.h"

namespace asdic::detail {
namespace {

constexpr std::size_t longest_axis = 10'000'000;
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
    hdf5::check_contents(path);  // of netCDF-4
    note_read(path);
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
  std::string name{};
  bool known = false;  ///< as one of the axes
  NetcdfGrid::Axis axis{};
  std::vector<double> values{};  ///< as stored; depth in metres, positive down
};

template <class Visit>
void fields(Dimension& dimension, Visit visit) {
  visit(dimension.name);
  visit(dimension.known);
  visit(dimension.axis);
  visit(dimension.values);
}

/// What is known of a variable before its values are read.
struct Variable {
  bool found = false;
  std::string name{}, units{};
  std::vector<Dimension> dimensions{};            ///< in the order of the variable
  std::vector<double> missing_values{}, valid{};  ///< packed
  double scale = 1.0, offset = 0.0;
};

template <class Visit>
void fields(Variable& variable, Visit visit) {
  visit(variable.found);
  visit(variable.name);
  visit(variable.units);
  visit(variable.dimensions);
  visit(variable.missing_values);
  visit(variable.valid);
  visit(variable.scale);
  visit(variable.offset);
}

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

/// The side that has the file open, in a child process: it says what a variable is, and gives its
/// values one by one as they are stored.
class VariableReader {
 public:
  VariableReader(const std::filesystem::path& path, const std::vector<std::string>& names)
      : file_(path) {
    find(names);
  }

  /// Nothing asked: the variable. Indices: the value there.
  [[nodiscard]] std::string answer(std::string_view question) const {
    isolated::Packed out;
    if (question.empty()) {
      out.put(variable_);
      return out.bytes();
    }
    const auto index = isolated::Unpacked(question).get<std::vector<std::size_t>>();
    double packed = 0.0;
    file_.check(nc_get_var1_double(file_.id, id_, index.data(), &packed), variable_.name);
    out.put(packed);
    return out.bytes();
  }

 private:
  void find(const std::vector<std::string>& names);
  void read_dimensions();
  void read_coordinate(Dimension& dimension, int dimension_id);

  File file_;
  int id_ = -1;
  Variable variable_;
};

void VariableReader::find(const std::vector<std::string>& names) {
  int variables = 0;
  file_.check(nc_inq_nvars(file_.id, &variables), "variables");
  for (const std::string& wanted : names) {
    for (int id = 0; id < variables; ++id) {
      char text[NC_MAX_NAME + 1] = {};
      file_.check(nc_inq_varname(file_.id, id, text), "variables");
      if (lower(text) != lower(wanted) && lower(file_.text(id, "standard_name")) != lower(wanted))
        continue;
      id_ = id;
      variable_.found = true;
      variable_.name = text;
      variable_.units = file_.text(id, "units");
      for (const char* key : {"missing_value", "_FillValue"})
        for (const double flag : file_.numbers(id, key)) variable_.missing_values.push_back(flag);
      variable_.valid = file_.numbers(id, "valid_range");
      if (const auto scale = file_.numbers(id, "scale_factor"); !scale.empty())
        variable_.scale = scale[0];
      if (const auto offset = file_.numbers(id, "add_offset"); !offset.empty())
        variable_.offset = offset[0];
      return read_dimensions();
    }
  }
}

void VariableReader::read_dimensions() {
  const std::string where = file_.path.string() + ": " + variable_.name;
  int rank = 0;
  file_.check(nc_inq_varndims(file_.id, id_, &rank), variable_.name);
  std::vector<int> ids(static_cast<std::size_t>(rank));
  file_.check(nc_inq_vardimid(file_.id, id_, ids.data()), variable_.name);
  for (const int dimension_id : ids) {
    char text[NC_MAX_NAME + 1] = {};
    std::size_t size = 0;
    file_.check(nc_inq_dim(file_.id, dimension_id, text, &size), variable_.name);
    if (size == 0 || size > longest_axis)
      throw InputError({.where = where,
                        .got = "the dimension " + in_quotes(text) + " of " + std::to_string(size),
                        .expected = "1 to " + std::to_string(longest_axis)});
    Dimension dimension{.name = text, .values = std::vector<double>(size)};
    read_coordinate(dimension, dimension_id);
    if (!dimension.known && size > 1)
      throw InputError({.where = where,
                        .got = "the dimension " + in_quotes(text),
                        .expected = "longitude, latitude, depth or time by their units, "
                                    "standard_name or axis"});
    variable_.dimensions.push_back(std::move(dimension));
  }
  for (const auto axis : {NetcdfGrid::Axis::longitude, NetcdfGrid::Axis::latitude})
    if (std::none_of(variable_.dimensions.begin(), variable_.dimensions.end(),
                     [&](const Dimension& d) { return d.known && d.axis == axis; }))
      throw InputError({.where = where,
                        .got = "a variable without longitude and latitude",
                        .expected = "one on a grid of them"});
}

/// The values of the variable that bears a dimension's name.
void VariableReader::read_coordinate(Dimension& dimension, int dimension_id) {
  const char* const name = dimension.name.c_str();
  int coordinate = -1, rank = 0, along = -1;
  if (nc_inq_varid(file_.id, name, &coordinate) != NC_NOERR) return;
  file_.check(nc_inq_varndims(file_.id, coordinate, &rank), dimension.name);
  if (rank == 1) file_.check(nc_inq_vardimid(file_.id, coordinate, &along), dimension.name);
  if (along != dimension_id) return;  // a variable that only bears its name
  const auto axis = axis_of(file_, coordinate, dimension.name);
  dimension.known = axis.has_value();
  if (axis) dimension.axis = *axis;
  file_.check(nc_get_var_double(file_.id, coordinate, dimension.values.data()), dimension.name);
  if (axis != NetcdfGrid::Axis::depth) return;
  const std::string unit = lower(file_.text(coordinate, "units"));
  const double metres = unit.starts_with("km") || unit.starts_with("kilom") ? 1000.0 : 1.0;
  const double sign = lower(file_.text(coordinate, "positive")) == "up" ? -1.0 : 1.0;
  for (double& z : dimension.values) z *= sign * metres;
}

}  // namespace

struct NetcdfGrid::Impl {
  std::unique_ptr<isolated::Child> child;  // a VariableReader; netCDF fails as HDF5 does
  Variable variable;
  std::vector<double> longitudes, latitudes;  // as stored
  std::vector<double> depths;                 // increasing
  bool depths_reversed = false;

  Impl(const std::filesystem::path& path, const std::vector<std::string>& names);

  [[nodiscard]] const Dimension* find(Axis axis) const {
    for (const Dimension& dimension : variable.dimensions)
      if (dimension.known && dimension.axis == axis) return &dimension;
    return nullptr;
  }
  [[nodiscard]] double value(std::size_t i, std::size_t j, std::size_t level,
                             std::size_t time) const;
};

NetcdfGrid::Impl::Impl(const std::filesystem::path& path, const std::vector<std::string>& names) {
  require_file(path, "a netCDF file");
  hdf5::prepare();  // once here, so that children need not
  nc_initialize();
  child = std::make_unique<isolated::Child>(path, "netCDF", [&] {
    auto reader = std::make_shared<const VariableReader>(path, names);
    return [reader](std::string_view question) { return reader->answer(question); };
  });
  variable = isolated::Unpacked(child->ask("")).get<Variable>();
  if (const Dimension* axis = find(Axis::longitude)) longitudes = axis->values;
  if (const Dimension* axis = find(Axis::latitude)) latitudes = axis->values;
  if (const Dimension* axis = find(Axis::depth)) depths = axis->values;
  depths_reversed = depths.size() > 1 && depths.front() > depths.back();
  if (depths_reversed) std::reverse(depths.begin(), depths.end());
}

double NetcdfGrid::Impl::value(std::size_t i, std::size_t j, std::size_t level,
                               std::size_t time) const {
  std::vector<std::size_t> index;
  for (const Dimension& dimension : variable.dimensions) {
    if (!dimension.known)
      index.push_back(0);
    else if (dimension.axis == Axis::longitude)
      index.push_back(i);
    else if (dimension.axis == Axis::latitude)
      index.push_back(j);
    else if (dimension.axis == Axis::depth)
      index.push_back(depths_reversed ? depths.size() - 1 - level : level);
    else
      index.push_back(time);
  }
  isolated::Packed question;
  question.put(index);
  const auto packed = isolated::Unpacked(child->ask(question.bytes())).get<double>();
  if (!std::isfinite(packed)) return missing;
  for (const double flag :
       variable.missing_values)  // stored as float, the flag may be a double, or round
    if (std::abs(packed - flag) <= 1e-6 * std::abs(flag)) return missing;
  const auto& valid = variable.valid;
  if (valid.size() == 2 && (packed < valid[0] || packed > valid[1])) return missing;
  return packed * variable.scale + variable.offset;
}

NetcdfGrid::NetcdfGrid(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
NetcdfGrid::NetcdfGrid(NetcdfGrid&&) noexcept = default;
NetcdfGrid& NetcdfGrid::operator=(NetcdfGrid&&) noexcept = default;
NetcdfGrid::~NetcdfGrid() = default;

std::optional<NetcdfGrid> NetcdfGrid::find(const std::filesystem::path& path,
                                           const std::vector<std::string>& names) {
  auto impl = std::make_unique<Impl>(path, names);
  if (!impl->variable.found) return std::nullopt;
  return NetcdfGrid(std::move(impl));
}

const std::string& NetcdfGrid::variable() const noexcept { return impl_->variable.name; }
const std::string& NetcdfGrid::units() const noexcept { return impl_->variable.units; }
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

}  // namespace asdic::detail
