#include "io/climatology/netcdf_source.h"

#include <netcdf.h>

#include <algorithm>
#include <cmath>
#include <optional>

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
  GridAxis axis{};
  bool projected = false;
};
std::optional<AxisKind> axis_of(const NetcdfFile& file, int variable, const std::string& name) {
  using Axis = GridAxis;
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
    const auto part = isolated::Unpacked(question).get<GridPart>();
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
  void read_coordinate(GridDimension& dimension, int dimension_id);
  void read_time(GridDimension& dimension, int coordinate);

  NetcdfFile file_;
  int id_ = -1;
  GridVariable variable_;
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
    GridDimension dimension{.name = text, .values = std::vector<double>(size)};
    read_coordinate(dimension, dimension_id);
    if (!dimension.known && size > 1)
      throw InputError({.where = where,
                        .got = "the dimension " + in_quotes(text),
                        .expected = "longitude, latitude, depth or time by their units, "
                                    "standard_name or axis"});
    variable_.dimensions.push_back(std::move(dimension));
  }
  for (const auto axis : {GridAxis::longitude, GridAxis::latitude})
    if (std::none_of(variable_.dimensions.begin(), variable_.dimensions.end(),
                     [&](const GridDimension& d) { return d.known && d.axis == axis; }))
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
void VariableReader::read_coordinate(GridDimension& dimension, int dimension_id) {
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
  const GridAxis axis = dimension.axis = kind->axis;
  dimension.projected = kind->projected;
  if (axis == GridAxis::time) return read_time(dimension, coordinate);
  if (axis == GridAxis::longitude && !kind->projected) unroll(dimension.values);
  if (axis == GridAxis::depth || kind->projected) {
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

void VariableReader::read_time(GridDimension& dimension, int coordinate) {
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

class NetcdfSource : public GridSource {
 public:
  NetcdfSource(const std::filesystem::path& path, const std::vector<std::string>& names)
      : child_(path, "netCDF",
               [&] {
                 auto reader = std::make_shared<const VariableReader>(path, names);
                 return [reader](std::string_view question) { return reader->answer(question); };
               }),
        variable_(isolated::Unpacked(child_.ask("")).get<GridVariable>()) {}

  const GridVariable& variable() const noexcept override { return variable_; }

  std::vector<double> read(const GridPart& part) const override {
    isolated::Packed question;
    question.put(part);
    return isolated::Unpacked(child_.ask(question.bytes())).get<std::vector<double>>();
  }

 private:
  mutable isolated::Child child_;  // netCDF fails as HDF5 does; asked, it goes on
  GridVariable variable_;
};

}  // namespace

std::unique_ptr<const GridSource> open_netcdf(const std::filesystem::path& path,
                                              const std::vector<std::string>& names) {
  require_file(path, "a netCDF file");
  prepare_netcdf();
  return std::make_unique<const NetcdfSource>(path, names);
}

}  // namespace asdic::detail
