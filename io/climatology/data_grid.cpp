#include "io/climatology/data_grid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "core/error.h"
#include "io/climatology/netcdf_source.h"

namespace asdic::detail {
namespace {

constexpr std::size_t largest_piece = 1'000'000;  // values that are read at a time
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

struct DataGrid::Impl {
  std::filesystem::path path;
  std::unique_ptr<const GridSource> source;
  const GridVariable& variable;
  std::vector<double> eastings, northings;  // as stored
  std::vector<double> depths;               // increasing
  bool depths_reversed = false;
  bool geographic = true;
  std::vector<Moment> moments, spans;
  Calendar calendar = Calendar::standard;
  bool every_year = false;

  Impl(const std::filesystem::path& path, std::unique_ptr<const GridSource> from);
  void read_axes();

  [[nodiscard]] const GridDimension* find(Axis axis) const {
    for (const GridDimension& dimension : variable.dimensions)
      if (dimension.known && dimension.axis == axis) return &dimension;
    return nullptr;
  }
  /// A part as it is stored, unpacked.
  [[nodiscard]] std::vector<double> read(const GridPart& part) const;
  [[nodiscard]] double value(std::size_t i, std::size_t j, std::size_t level,
                             std::size_t time) const;
  [[nodiscard]] double period() const { return geographic ? 360.0 : 0.0; }
};

DataGrid::Impl::Impl(const std::filesystem::path& path_, std::unique_ptr<const GridSource> from)
    : path(path_), source(std::move(from)), variable(source->variable()) {
  if (variable.found) read_axes();
}

void DataGrid::Impl::read_axes() {
  const GridDimension* const x = find(Axis::longitude);
  const GridDimension* const y = find(Axis::latitude);
  if (x == nullptr || y == nullptr) return;  // both are there: the reader has looked
  if (x->projected != y->projected)
    throw InputError({.where = path.string() + ": " + variable.name,
                      .got = "one axis in degrees and one in a unit of length",
                      .expected = "both alike"});
  geographic = !x->projected;
  eastings = x->values;
  northings = y->values;
  if (const GridDimension* axis = find(Axis::depth)) depths = axis->values;
  depths_reversed = depths.size() > 1 && depths.front() > depths.back();
  if (depths_reversed) std::reverse(depths.begin(), depths.end());
  const GridDimension* const time = find(Axis::time);
  if (time == nullptr) return;
  every_year = time->every_year;
  const auto units = TimeUnits::parse(time->units, time->calendar);
  if (!units) return;
  calendar = units->calendar();
  for (const double t : time->values) moments.push_back(units->at(t));
  for (const double t : time->spans) spans.push_back(units->at(t));
}

std::vector<double> DataGrid::Impl::read(const GridPart& part) const {
  std::vector<double> values = source->read(part);
  for (double& value : values) value = variable.unpacked(value);
  return values;
}

double DataGrid::Impl::value(std::size_t i, std::size_t j, std::size_t level,
                             std::size_t time) const {
  GridPart part;
  for (const GridDimension& dimension : variable.dimensions) {
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

DataGrid::DataGrid(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DataGrid::DataGrid(DataGrid&&) noexcept = default;
DataGrid& DataGrid::operator=(DataGrid&&) noexcept = default;
DataGrid::~DataGrid() = default;

std::optional<DataGrid> DataGrid::of(const std::filesystem::path& path,
                                     std::unique_ptr<const GridSource> source) {
  auto impl = std::make_unique<Impl>(path, std::move(source));
  if (!impl->variable.found) return std::nullopt;
  return DataGrid(std::move(impl));
}

std::optional<DataGrid> DataGrid::find(const std::filesystem::path& path,
                                       const std::vector<std::string>& names) {
  return of(path, open_netcdf(path, names));
}

const std::filesystem::path& DataGrid::path() const noexcept { return impl_->path; }
const std::string& DataGrid::variable() const noexcept { return impl_->variable.name; }
const std::string& DataGrid::units() const noexcept { return impl_->variable.units; }
const std::string& DataGrid::standard_name() const noexcept {
  return impl_->variable.standard_name;
}
const std::string& DataGrid::long_name() const noexcept { return impl_->variable.long_name; }
const std::vector<double>& DataGrid::flag_values() const noexcept {
  return impl_->variable.flag_values;
}
const std::string& DataGrid::flag_meanings() const noexcept {
  return impl_->variable.flag_meanings;
}
const std::string& DataGrid::projection_name() const noexcept {
  return impl_->variable.projection_name;
}
const std::string& DataGrid::projection() const noexcept { return impl_->variable.projection; }
std::optional<GridSource::Place> DataGrid::on_earth(double x, double y) const {
  return impl_->source->on_earth(x, y);
}
const std::vector<std::string>& DataGrid::remarks() const noexcept {
  return impl_->variable.remarks;
}
bool DataGrid::geographic() const noexcept { return impl_->geographic; }
const std::vector<double>& DataGrid::eastings() const noexcept { return impl_->eastings; }
const std::vector<double>& DataGrid::northings() const noexcept { return impl_->northings; }
const std::vector<Moment>& DataGrid::moments() const noexcept { return impl_->moments; }
const std::vector<Moment>& DataGrid::spans() const noexcept { return impl_->spans; }
Calendar DataGrid::calendar() const noexcept { return impl_->calendar; }
bool DataGrid::every_year() const noexcept { return impl_->every_year; }
bool DataGrid::has(Axis axis) const noexcept { return impl_->find(axis) != nullptr; }
const std::vector<double>& DataGrid::depths() const noexcept { return impl_->depths; }
std::size_t DataGrid::times() const noexcept {
  const GridDimension* time = impl_->find(Axis::time);
  return time == nullptr ? 1 : time->values.size();
}

bool DataGrid::wraps() const noexcept {
  const auto& axis = impl_->eastings;
  if (!impl_->geographic || axis.size() < 2) return false;
  const double length = std::abs(axis.back() - axis.front());
  return length + 1.5 * length / static_cast<double>(axis.size() - 1) >= 360.0;
}

namespace {

/// What of a dimension goes into a block, and where.
struct Along {
  DataGrid::Indices indices;  // as stored
  std::size_t stride = 0;     // of the block
  bool reversed = false;      // stored from the far end
};

/// Puts a part of a variable into a block, a piece at a time.
class BlockReader {
 public:
  using Read = std::function<std::vector<double>(const GridPart&)>;
  BlockReader(std::vector<Along> dimensions, Read read)
      : dimensions_(std::move(dimensions)), read_(std::move(read)) {}

  void into(std::vector<double>& values, std::size_t offset) {
    GridPart part;
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
  void pieces(std::size_t d, const GridPart& part, std::vector<double>& values,
              std::size_t offset) {
    std::size_t size = 1;
    for (const std::size_t n : part.count) size *= n;
    while (d < part.count.size() && part.count[d] == 1) ++d;
    if (size > largest_piece && d < part.count.size()) {
      GridPart half = part;
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

  void scatter(std::size_t d, const GridPart& part, const std::vector<double>& read,
               std::size_t& next, std::vector<double>& values, std::size_t offset) const {
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

void check_indices(DataGrid::Indices indices, std::size_t size, const char* what) {
  if (indices.first > indices.last || indices.last >= std::max<std::size_t>(size, 1))
    throw std::out_of_range(std::string("DataGrid::block: ") + what);
}

std::vector<double> part_of(const std::vector<double>& axis, DataGrid::Indices indices) {
  const auto at = [&](std::size_t i) { return axis.begin() + static_cast<std::ptrdiff_t>(i); };
  return {at(indices.first), at(indices.last + 1)};
}

}  // namespace

DataGrid::Block DataGrid::block(Indices east, Indices north, Indices levels,
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
  if (time >= times()) throw std::out_of_range("DataGrid::block: time");
  Block block{.eastings = part_of(impl_->eastings, east),
              .northings = part_of(impl_->northings, north)};
  if (!impl_->depths.empty()) block.depths = part_of(impl_->depths, levels);
  const bool x_falls = rising(block.eastings), y_falls = rising(block.northings);
  const std::size_t row = block.eastings.size(), plane = row * block.northings.size();
  std::vector<Along> dimensions;
  for (const GridDimension& dimension : impl_->variable.dimensions) {
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
  BlockReader(std::move(dimensions), [this](const GridPart& part) {
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

std::optional<DataGrid::Point> DataGrid::nearest_point(double longitude, double latitude) const {
  const auto x = locate(impl_->eastings, longitude, impl_->period());
  const auto y = locate(impl_->northings, latitude, 0.0);
  if (!x || !y) return std::nullopt;
  return Point{x->share < 0.5 ? x->low : x->high, y->share < 0.5 ? y->low : y->high};
}

double DataGrid::nearest(double longitude, double latitude, std::size_t level,
                         std::size_t time) const {
  const auto x = locate(impl_->eastings, longitude, impl_->period());
  const auto y = locate(impl_->northings, latitude, 0.0);
  if (!x || !y) return missing;
  return impl_->value(x->share < 0.5 ? x->low : x->high, y->share < 0.5 ? y->low : y->high, level,
                      time);
}

double DataGrid::bilinear(double longitude, double latitude, std::size_t level,
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
