#include "io/climatology/netcdf_grid.h"

#include <netcdf.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "core/error.h"
#include "core/text.h"
#include "io/climatology/netcdf_file.h"
#include "io/climatology/words.h"
#include "io/files/input_file.h"
#include "io/isolated/child.h"
#include "io/isolated/pack.h"

namespace asdic::detail {
namespace {

using climatology::lower;

constexpr std::size_t longest_axis = 10'000'000;
constexpr std::size_t chunk_cache = 128U << 20U;  // [bytes]
constexpr std::size_t largest_piece = 1'000'000;  // values that are read at a time
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// One dimension of a variable.
struct Dimension {
  std::string name{};
  bool known = false;  ///< as one of the axes
  NetcdfGrid::Axis axis{};
  bool projected = false;           ///< x or y [m], not degrees
  std::vector<double> values{};     ///< as stored; lengths in metres, depth positive down
  std::string units{}, calendar{};  ///< of time
  std::vector<double> spans{};      ///< [2·times] of time, as stored
  bool every_year = false;          ///< of time
};

template <class Visit>
void fields(Dimension& dimension, Visit visit) {
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
struct Variable {
  bool found = false;
  std::string name{}, units{}, standard_name{}, long_name{}, flag_meanings{};
  std::vector<double> flag_values{};
  std::vector<Dimension> dimensions{};                      ///< in the order of the variable
  std::vector<double> missing_values{};                     ///< packed
  double least = -std::numeric_limits<double>::infinity();  ///< packed
  double most = std::numeric_limits<double>::infinity();    ///< packed
  double scale = 1.0, offset = 0.0;

  [[nodiscard]] double unpacked(double packed) const {
    if (!std::isfinite(packed) || packed < least || packed > most) return missing;
    for (const double flag : missing_values)  // stored as float, the flag may be a double, or round
      if (std::abs(packed - flag) <= 1e-6 * std::abs(flag)) return missing;
    return packed * scale + offset;
  }
};

template <class Visit>
void fields(Variable& variable, Visit visit) {
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
}

/// Metres of a unit of length; nothing for other units.
std::optional<double> metres_of(const std::string& unit) {
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), unit) != names.end();
  };
  if (is({"m", "metre", "metres", "meter", "meters"})) return 1.0;
  if (is({"km", "kilometre", "kilometres", "kilometer", "kilometers"})) return 1000.0;
  return std::nullopt;
}

/// What an axis is by the conventions; its name is asked last.
struct AxisKind {
  NetcdfGrid::Axis axis{};
  bool projected = false;
};
std::optional<AxisKind> axis_of(const NetcdfFile& file, int variable, const std::string& name) {
  using Axis = NetcdfGrid::Axis;
  const std::string units = lower(file.text(variable, "units"));
  const std::string standard = lower(file.text(variable, "standard_name"));
  const std::string axis = lower(file.text(variable, "axis"));
  const std::string word = lower(name);
  const bool length = metres_of(units).has_value();
  if (standard == "projection_x_coordinate") return AxisKind{Axis::longitude, true};
  if (standard == "projection_y_coordinate") return AxisKind{Axis::latitude, true};
  if (standard == "longitude" || units.starts_with("degrees_e") || units.starts_with("degree_e"))
    return AxisKind{Axis::longitude};
  if (standard == "latitude" || units.starts_with("degrees_n") || units.starts_with("degree_n"))
    return AxisKind{Axis::latitude};
  if (axis == "x") return AxisKind{Axis::longitude, length};
  if (axis == "y") return AxisKind{Axis::latitude, length};
  if (standard == "time" || axis == "t" || units.find(" since ") != std::string::npos)
    return AxisKind{Axis::time};
  if (standard == "depth" || axis == "z" || !file.text(variable, "positive").empty())
    return AxisKind{Axis::depth};
  if (word == "lon" || word == "longitude") return AxisKind{Axis::longitude};
  if (word == "lat" || word == "latitude") return AxisKind{Axis::latitude};
  if (length && (word == "x" || word == "easting")) return AxisKind{Axis::longitude, true};
  if (length && (word == "y" || word == "northing")) return AxisKind{Axis::latitude, true};
  if (word == "depth" || word == "lev" || word == "level") return AxisKind{Axis::depth};
  if (word == "time" || word == "month") return AxisKind{Axis::time};
  return std::nullopt;
}

/// Where a part of a variable begins along each of its dimensions, and how many values it has.
struct Part {
  std::vector<std::size_t> start{}, count{};
};

template <class Visit>
void fields(Part& part, Visit visit) {
  visit(part.start);
  visit(part.count);
}

/// The side that has the file open, in a child process: it says what a variable is, and gives parts
/// of it as they are stored.
class VariableReader {
 public:
  VariableReader(const std::filesystem::path& path, const std::vector<std::string>& names)
      : file_(path) {
    find(names);
  }

  /// Nothing asked: the variable. A part: its values.
  [[nodiscard]] std::string answer(std::string_view question) const {
    isolated::Packed out;
    if (question.empty()) {
      out.put(variable_);
      return out.bytes();
    }
    const auto part = isolated::Unpacked(question).get<Part>();
    std::size_t size = 1;
    for (const std::size_t n : part.count) size *= n;
    std::vector<double> values(size);
    file_.check(
        nc_get_vara_double(file_.id(), id_, part.start.data(), part.count.data(), values.data()),
        variable_.name);
    out.put(values);
    return out.bytes();
  }

 private:
  void find(const std::vector<std::string>& names);
  void read_packing();
  void read_dimensions();
  void read_coordinate(Dimension& dimension, int dimension_id);
  void read_time(Dimension& dimension, int coordinate);

  NetcdfFile file_;
  int id_ = -1;
  Variable variable_;
};

void VariableReader::find(const std::vector<std::string>& names) {
  int variables = 0;
  file_.check(nc_inq_nvars(file_.id(), &variables), "variables");
  for (const std::string& wanted : names) {
    for (int id = 0; id < variables; ++id) {
      char text[NC_MAX_NAME + 1] = {};
      file_.check(nc_inq_varname(file_.id(), id, text), "variables");
      if (lower(text) != lower(wanted) && lower(file_.text(id, "standard_name")) != lower(wanted))
        continue;
      id_ = id;
      variable_.found = true;
      variable_.name = text;
      variable_.units = file_.text(id, "units");
      variable_.standard_name = file_.text(id, "standard_name");
      variable_.long_name = file_.text(id, "long_name");
      variable_.flag_meanings = file_.text(id, "flag_meanings");
      variable_.flag_values = file_.numbers(id, "flag_values");
      read_packing();
      // Values are asked for one by one: a chunk that is unpacked stays. Not of older formats.
      static_cast<void>(nc_set_var_chunk_cache(file_.id(), id_, chunk_cache, 1009, 0.75F));
      return read_dimensions();
    }
  }
}

void VariableReader::read_packing() {
  for (const char* key : {"missing_value", "_FillValue"})
    for (const double flag : file_.numbers(id_, key)) variable_.missing_values.push_back(flag);
  if (const auto scale = file_.numbers(id_, "scale_factor"); !scale.empty())
    variable_.scale = scale[0];
  if (const auto offset = file_.numbers(id_, "add_offset"); !offset.empty())
    variable_.offset = offset[0];
  nc_type type = NC_NAT;
  file_.check(nc_inq_vartype(file_.id(), id_, &type), variable_.name);
  if (file_.numbers(id_, "_FillValue").empty()) {
    if (type == NC_SHORT) variable_.missing_values.push_back(NC_FILL_SHORT);
    if (type == NC_INT) variable_.missing_values.push_back(NC_FILL_INT);
    if (type == NC_FLOAT) variable_.missing_values.push_back(static_cast<double>(NC_FILL_FLOAT));
    if (type == NC_DOUBLE) variable_.missing_values.push_back(NC_FILL_DOUBLE);
  }
  // A range of another type than the packed values is one of unpacked values (NUG, attributes).
  const auto bound = [&](const char* key, std::size_t i) -> std::optional<double> {
    const auto values = file_.numbers(id_, key);
    if (values.size() <= i) return std::nullopt;
    nc_type kind = NC_NAT;
    if (nc_inq_atttype(file_.id(), id_, key, &kind) != NC_NOERR) return std::nullopt;
    if (kind == type || variable_.scale == 0.0) return values[i];
    return (values[i] - variable_.offset) / variable_.scale;
  };
  const bool pair = file_.numbers(id_, "valid_range").size() == 2;
  auto least = pair ? bound("valid_range", 0) : bound("valid_min", 0);
  auto most = pair ? bound("valid_range", 1) : bound("valid_max", 0);
  if (least && most && *least > *most) std::swap(least, most);  // a negative scale
  if (least) variable_.least = *least;
  if (most) variable_.most = *most;
}

void VariableReader::read_dimensions() {
  const std::string where = file_.path().string() + ": " + variable_.name;
  int rank = 0;
  file_.check(nc_inq_varndims(file_.id(), id_, &rank), variable_.name);
  std::vector<int> ids(static_cast<std::size_t>(rank));
  file_.check(nc_inq_vardimid(file_.id(), id_, ids.data()), variable_.name);
  for (const int dimension_id : ids) {
    char text[NC_MAX_NAME + 1] = {};
    std::size_t size = 0;
    file_.check(nc_inq_dim(file_.id(), dimension_id, text, &size), variable_.name);
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
                        .expected = "one on a grid of them, or of x and y with units of length"});
}

/// Longitudes that jump by the whole circle go on instead.
void unroll(std::vector<double>& longitudes) {
  double turn = 0.0;
  for (std::size_t i = 1; i < longitudes.size(); ++i) {
    const double step = longitudes[i] + turn - longitudes[i - 1];
    if (step < -180.0) turn += 360.0;
    if (step > 180.0) turn -= 360.0;
    longitudes[i] += turn;
  }
}

bool rises_or_falls(const std::vector<double>& values) {
  if (values.size() == 1) return std::isfinite(values[0]);
  const bool rising = values.back() > values.front();
  for (std::size_t i = 1; i < values.size(); ++i)
    if (!(rising ? values[i] > values[i - 1] : values[i] < values[i - 1])) return false;
  return std::isfinite(values.front()) && std::isfinite(values.back());
}

/// The values of the variable that bears a dimension's name.
void VariableReader::read_coordinate(Dimension& dimension, int dimension_id) {
  const char* const name = dimension.name.c_str();
  int coordinate = -1, rank = 0, along = -1;
  if (nc_inq_varid(file_.id(), name, &coordinate) != NC_NOERR) return;
  file_.check(nc_inq_varndims(file_.id(), coordinate, &rank), dimension.name);
  if (rank == 1) file_.check(nc_inq_vardimid(file_.id(), coordinate, &along), dimension.name);
  if (along != dimension_id) return;  // a variable that only bears its name
  const auto kind = axis_of(file_, coordinate, dimension.name);
  dimension.known = kind.has_value();
  file_.check(nc_get_var_double(file_.id(), coordinate, dimension.values.data()), dimension.name);
  if (!kind) return;
  const NetcdfGrid::Axis axis = dimension.axis = kind->axis;
  dimension.projected = kind->projected;
  if (axis == NetcdfGrid::Axis::time) return read_time(dimension, coordinate);
  if (axis == NetcdfGrid::Axis::longitude && !kind->projected) unroll(dimension.values);
  if (axis == NetcdfGrid::Axis::depth || kind->projected) {
    const std::string unit = lower(file_.text(coordinate, "units"));
    const double metres = metres_of(unit).value_or(1.0);
    const bool up = lower(file_.text(coordinate, "positive")) == "up";
    for (double& z : dimension.values) z *= up ? -metres : metres;
  }
  if (!rises_or_falls(dimension.values))
    throw InputError({.where = file_.path().string() + ": " + dimension.name,
                      .got = "an axis whose values neither rise nor fall",
                      .expected = "an axis that does"});
}

void VariableReader::read_time(Dimension& dimension, int coordinate) {
  dimension.units = file_.text(coordinate, "units");
  dimension.calendar = file_.text(coordinate, "calendar");
  nc_type modulo = NC_NAT;
  std::size_t size = 0;
  std::string bounds = file_.text(coordinate, "climatology");
  dimension.every_year =
      !bounds.empty() || nc_inq_att(file_.id(), coordinate, "modulo", &modulo, &size) == NC_NOERR;
  if (bounds.empty()) bounds = file_.text(coordinate, "bounds");
  int id = -1, rank = 0, ids[2] = {-1, -1};
  if (bounds.empty() || nc_inq_varid(file_.id(), bounds.c_str(), &id) != NC_NOERR) return;
  if (nc_inq_varndims(file_.id(), id, &rank) != NC_NOERR || rank != 2) return;
  std::size_t steps = 0, ends = 0;
  if (nc_inq_vardimid(file_.id(), id, ids) != NC_NOERR ||
      nc_inq_dimlen(file_.id(), ids[0], &steps) != NC_NOERR ||
      nc_inq_dimlen(file_.id(), ids[1], &ends) != NC_NOERR || ends != 2 ||
      steps != dimension.values.size())
    return;
  dimension.spans.resize(2 * steps);
  file_.check(nc_get_var_double(file_.id(), id, dimension.spans.data()), bounds);
}

}  // namespace

struct NetcdfGrid::Impl {
  std::filesystem::path path;
  std::unique_ptr<isolated::Child> child;  // a VariableReader; netCDF fails as HDF5 does
  Variable variable;
  std::vector<double> eastings, northings;  // as stored
  std::vector<double> depths;               // increasing
  bool depths_reversed = false;
  bool geographic = true;
  std::vector<double> plane;  // of a grid in memory: all values
  std::vector<Moment> moments, spans;
  Calendar calendar = Calendar::standard;
  bool every_year = false;

  Impl(const std::filesystem::path& path, const std::vector<std::string>& names);
  Impl() = default;
  void read_axes();

  [[nodiscard]] const Dimension* find(Axis axis) const {
    for (const Dimension& dimension : variable.dimensions)
      if (dimension.known && dimension.axis == axis) return &dimension;
    return nullptr;
  }
  /// A part as it is stored, unpacked.
  [[nodiscard]] std::vector<double> read(const Part& part) const;
  [[nodiscard]] double value(std::size_t i, std::size_t j, std::size_t level,
                             std::size_t time) const;
  [[nodiscard]] double period() const { return geographic ? 360.0 : 0.0; }
};

NetcdfGrid::Impl::Impl(const std::filesystem::path& path_, const std::vector<std::string>& names)
    : path(path_) {
  require_file(path, "a netCDF file");
  prepare_netcdf();
  child = std::make_unique<isolated::Child>(path, "netCDF", [&] {
    auto reader = std::make_shared<const VariableReader>(path, names);
    return [reader](std::string_view question) { return reader->answer(question); };
  });
  variable = isolated::Unpacked(child->ask("")).get<Variable>();
  if (variable.found) read_axes();
}

void NetcdfGrid::Impl::read_axes() {
  const Dimension* const x = find(Axis::longitude);
  const Dimension* const y = find(Axis::latitude);
  if (x == nullptr || y == nullptr) return;  // both are there: the reader has looked
  if (x->projected != y->projected)
    throw InputError({.where = path.string() + ": " + variable.name,
                      .got = "one axis in degrees and one in a unit of length",
                      .expected = "both alike"});
  geographic = !x->projected;
  eastings = x->values;
  northings = y->values;
  if (const Dimension* axis = find(Axis::depth)) depths = axis->values;
  depths_reversed = depths.size() > 1 && depths.front() > depths.back();
  if (depths_reversed) std::reverse(depths.begin(), depths.end());
  const Dimension* const time = find(Axis::time);
  if (time == nullptr) return;
  every_year = time->every_year;
  const auto units = TimeUnits::parse(time->units, time->calendar);
  if (!units) return;
  calendar = units->calendar();
  for (const double t : time->values) moments.push_back(units->at(t));
  for (const double t : time->spans) spans.push_back(units->at(t));
}

std::vector<double> NetcdfGrid::Impl::read(const Part& part) const {
  if (child == nullptr) {
    std::vector<double> values;
    for (std::size_t j = part.start[0]; j < part.start[0] + part.count[0]; ++j) {
      const auto row = plane.begin() + static_cast<std::ptrdiff_t>(j * eastings.size());
      const auto begin = row + static_cast<std::ptrdiff_t>(part.start[1]);
      values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(part.count[1]));
    }
    return values;
  }
  isolated::Packed question;
  question.put(part);
  auto values = isolated::Unpacked(child->ask(question.bytes())).get<std::vector<double>>();
  for (double& value : values) value = variable.unpacked(value);
  return values;
}

double NetcdfGrid::Impl::value(std::size_t i, std::size_t j, std::size_t level,
                               std::size_t time) const {
  Part part;
  for (const Dimension& dimension : variable.dimensions) {
    if (!dimension.known)
      part.start.push_back(0);
    else if (dimension.axis == Axis::longitude)
      part.start.push_back(i);
    else if (dimension.axis == Axis::latitude)
      part.start.push_back(j);
    else if (dimension.axis == Axis::depth)
      part.start.push_back(depths_reversed ? depths.size() - 1 - level : level);
    else
      part.start.push_back(time);
    part.count.push_back(1);
  }
  return read(part).front();
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

NetcdfGrid NetcdfGrid::of_plane(const std::filesystem::path& path, const std::string& variable,
                                std::vector<double> eastings, std::vector<double> northings,
                                std::vector<double> values) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->variable.found = true;
  impl->variable.name = variable;
  impl->variable.units = "m";
  impl->variable.dimensions = {
      {.name = "y", .known = true, .axis = Axis::latitude, .values = std::move(northings)},
      {.name = "x", .known = true, .axis = Axis::longitude, .values = std::move(eastings)}};
  impl->plane = std::move(values);
  impl->read_axes();
  return NetcdfGrid(std::move(impl));
}

const std::filesystem::path& NetcdfGrid::path() const noexcept { return impl_->path; }
const std::string& NetcdfGrid::variable() const noexcept { return impl_->variable.name; }
const std::string& NetcdfGrid::units() const noexcept { return impl_->variable.units; }
const std::string& NetcdfGrid::standard_name() const noexcept {
  return impl_->variable.standard_name;
}
const std::string& NetcdfGrid::long_name() const noexcept { return impl_->variable.long_name; }
const std::vector<double>& NetcdfGrid::flag_values() const noexcept {
  return impl_->variable.flag_values;
}
const std::string& NetcdfGrid::flag_meanings() const noexcept {
  return impl_->variable.flag_meanings;
}
bool NetcdfGrid::geographic() const noexcept { return impl_->geographic; }
const std::vector<double>& NetcdfGrid::eastings() const noexcept { return impl_->eastings; }
const std::vector<double>& NetcdfGrid::northings() const noexcept { return impl_->northings; }
const std::vector<Moment>& NetcdfGrid::moments() const noexcept { return impl_->moments; }
const std::vector<Moment>& NetcdfGrid::spans() const noexcept { return impl_->spans; }
Calendar NetcdfGrid::calendar() const noexcept { return impl_->calendar; }
bool NetcdfGrid::every_year() const noexcept { return impl_->every_year; }
bool NetcdfGrid::has(Axis axis) const noexcept { return impl_->find(axis) != nullptr; }
const std::vector<double>& NetcdfGrid::depths() const noexcept { return impl_->depths; }
std::size_t NetcdfGrid::times() const noexcept {
  const Dimension* time = impl_->find(Axis::time);
  return time == nullptr ? 1 : time->values.size();
}

bool NetcdfGrid::wraps() const noexcept {
  const auto& axis = impl_->eastings;
  if (!impl_->geographic || axis.size() < 2) return false;
  const double length = std::abs(axis.back() - axis.front());
  return length + 1.5 * length / static_cast<double>(axis.size() - 1) >= 360.0;
}

namespace {

/// What of a dimension goes into a block, and where.
struct Along {
  NetcdfGrid::Indices indices;  // as stored
  std::size_t stride = 0;       // of the block
  bool reversed = false;        // stored from the far end
};

/// Puts a part of a variable into a block, a piece at a time.
class BlockReader {
 public:
  using Read = std::function<std::vector<double>(const Part&)>;
  BlockReader(std::vector<Along> dimensions, Read read)
      : dimensions_(std::move(dimensions)), read_(std::move(read)) {}

  void into(std::vector<double>& values, std::size_t offset) {
    Part part;
    for (const Along& along : dimensions_) {
      part.start.push_back(along.indices.first);
      part.count.push_back(along.indices.last - along.indices.first + 1);
    }
    pieces(0, part, values, offset);
  }

 private:
  [[nodiscard]] std::size_t place(std::size_t d, std::size_t index) const {
    const Along& along = dimensions_[d];
    return along.stride *
           (along.reversed ? along.indices.last - index : index - along.indices.first);
  }

  /// Halves the outermost dimension that is longer than one until a piece is small enough.
  void pieces(std::size_t d, const Part& part, std::vector<double>& values, std::size_t offset) {
    std::size_t size = 1;
    for (const std::size_t n : part.count) size *= n;
    while (d < part.count.size() && part.count[d] == 1) ++d;
    if (size > largest_piece && d < part.count.size()) {
      Part half = part;
      half.count[d] = part.count[d] / 2;
      pieces(d, half, values, offset);
      half.start[d] += half.count[d];
      half.count[d] = part.count[d] - half.count[d];
      return pieces(d, half, values, offset);
    }
    const std::vector<double> read = read_(part);
    std::size_t next = 0;
    scatter(0, part, read, next, values, offset);
  }

  void scatter(std::size_t d, const Part& part, const std::vector<double>& read, std::size_t& next,
               std::vector<double>& values, std::size_t offset) const {
    if (d == part.count.size()) {
      values[offset] = read[next++];
      return;
    }
    for (std::size_t i = 0; i < part.count[d]; ++i)
      scatter(d + 1, part, read, next, values, offset + place(d, part.start[d] + i));
  }

  std::vector<Along> dimensions_;
  Read read_;
};

/// A part of an axis that rises. \return whether it was turned round
bool rising(std::vector<double>& axis) {
  const bool turned = axis.size() > 1 && axis.front() > axis.back();
  if (turned) std::reverse(axis.begin(), axis.end());
  return turned;
}

void check_indices(NetcdfGrid::Indices indices, std::size_t size, const char* what) {
  if (indices.first > indices.last || indices.last >= std::max<std::size_t>(size, 1))
    throw std::out_of_range(std::string("NetcdfGrid::block: ") + what);
}

std::vector<double> part_of(const std::vector<double>& axis, NetcdfGrid::Indices indices) {
  const auto at = [&](std::size_t i) { return axis.begin() + static_cast<std::ptrdiff_t>(i); };
  return {at(indices.first), at(indices.last + 1)};
}

}  // namespace

NetcdfGrid::Block NetcdfGrid::block(Indices east, Indices north, Indices levels,
                                    std::size_t time) const {
  const std::size_t n = impl_->eastings.size();
  if (east.first > east.last && east.first < n && wraps()) {  // two parts, the seam between
    const Block one = block({east.first, n - 1}, north, levels, time);
    const Block two = block({0, east.last}, north, levels, time);
    const bool falls = impl_->eastings.front() > impl_->eastings.back();
    const Block &west = falls ? two : one, &rest = falls ? one : two;
    Block both{.eastings = west.eastings, .northings = one.northings, .depths = one.depths};
    for (double x : rest.eastings) {
      while (x <= west.eastings.back()) x += 360.0;
      both.eastings.push_back(x);
    }
    const std::size_t rows = one.values.size() / one.eastings.size();
    for (std::size_t row = 0; row < rows; ++row)
      for (const Block* part : {&west, &rest}) {
        const auto begin =
            part->values.begin() + static_cast<std::ptrdiff_t>(row * part->eastings.size());
        both.values.insert(both.values.end(), begin,
                           begin + static_cast<std::ptrdiff_t>(part->eastings.size()));
      }
    return both;
  }
  check_indices(east, n, "east");
  check_indices(north, impl_->northings.size(), "north");
  check_indices(levels, impl_->depths.size(), "levels");
  if (time >= times()) throw std::out_of_range("NetcdfGrid::block: time");
  Block block{.eastings = part_of(impl_->eastings, east),
              .northings = part_of(impl_->northings, north)};
  if (!impl_->depths.empty()) block.depths = part_of(impl_->depths, levels);
  const bool x_falls = rising(block.eastings), y_falls = rising(block.northings);
  const std::size_t row = block.eastings.size(), plane = row * block.northings.size();
  std::vector<Along> dimensions;
  for (const Dimension& dimension : impl_->variable.dimensions) {
    if (!dimension.known)
      dimensions.push_back({});
    else if (dimension.axis == Axis::longitude)
      dimensions.push_back({east, 1, x_falls});
    else if (dimension.axis == Axis::latitude)
      dimensions.push_back({north, row, y_falls});
    else if (dimension.axis == Axis::time)
      dimensions.push_back({{time, time}, 0, false});
    else if (const std::size_t last = impl_->depths.size() - 1; impl_->depths_reversed)
      dimensions.push_back({{last - levels.last, last - levels.first}, plane, true});
    else
      dimensions.push_back({levels, plane, false});
  }
  block.values.resize(plane * (levels.last - levels.first + 1));
  BlockReader(std::move(dimensions), [this](const Part& part) {
    return impl_->read(part);
  }).into(block.values, 0);
  return block;
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
  const auto after = std::partition_point(axis.begin() + 1, axis.end() - 1, [&](double value) {
    return rising ? value <= x : value >= x;
  });
  const auto i = static_cast<std::size_t>(after - axis.begin() - 1);
  return Between{.low = i, .high = i + 1, .share = (x - axis[i]) / (axis[i + 1] - axis[i])};
}

}  // namespace

std::optional<NetcdfGrid::Point> NetcdfGrid::nearest_point(double longitude,
                                                           double latitude) const {
  const auto x = locate(impl_->eastings, longitude, impl_->period());
  const auto y = locate(impl_->northings, latitude, 0.0);
  if (!x || !y) return std::nullopt;
  return Point{x->share < 0.5 ? x->low : x->high, y->share < 0.5 ? y->low : y->high};
}

double NetcdfGrid::nearest(double longitude, double latitude, std::size_t level,
                           std::size_t time) const {
  const auto x = locate(impl_->eastings, longitude, impl_->period());
  const auto y = locate(impl_->northings, latitude, 0.0);
  if (!x || !y) return missing;
  return impl_->value(x->share < 0.5 ? x->low : x->high, y->share < 0.5 ? y->low : y->high, level,
                      time);
}

double NetcdfGrid::bilinear(double longitude, double latitude, std::size_t level,
                            std::size_t time) const {
  const auto x = locate(impl_->eastings, longitude, impl_->period());
  const auto y = locate(impl_->northings, latitude, 0.0);
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
