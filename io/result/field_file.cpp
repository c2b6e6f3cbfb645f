#include "io/result/field_file.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "io/bellhop/finite_field.h"
#include "io/hdf5/earth.h"
#include "io/hdf5/scale.h"
#include "raytrace/cases/beam_error_text.h"

namespace asdic::detail {
namespace {

void coordinate(Hdf5File& file, const std::string& name, const std::vector<double>& values,
                const std::string& long_name, const Meaning& meaning = {}) {
  file.write<double>(name, values, {values.size()});
  describe(file, name, long_name, "m", meaning);
  file.attach_scales(name, {"receiver"});
}

InputError wrong(const Hdf5File& file, const std::string& where, const std::string& got,
                 const std::string& expected) {
  return InputError(
      {.where = file.path().string() + ": " + where, .got = got, .expected = expected});
}

std::vector<double> axis(const Hdf5File& file, const std::string& name) {
  if (!file.has(name)) throw wrong(file, name, "nothing", "a dataset (docs/formats/field.md)");
  std::vector<double> values = file.read<double>(name);
  if (values.empty()) throw wrong(file, name, "no values", "one or more");
  return values;
}

constexpr std::string_view field_kinds[] = {"coherent", "incoherent", "semi-coherent"};

}  // namespace

namespace {

/// Coordinates of scattered receivers, but for their places on the Earth.
const char* places_of(const ReceiverGrid& grid) {
  return grid.irregular ? "receiver_depth receiver_range" : "";
}

/// What each receiver is sure to, and how many of them are. \param shape, scales  of the receivers
void write_beam_errors(Hdf5File& file, const FieldData& field, const Shape& shape,
                       const std::vector<std::string>& scales) {
  if (field.beam_errors.empty()) return;
  file.write<float>("beam_error", field.beam_errors, shape);
  describe(file, "beam_error",
           "what more beams would change of the transmission loss, no more than this where "
           "beam_error_bounded is 1; infinite: no number bounds it; NaN: too faint to count, "
           "outside of the water, or a column that was not looked at",
           "dB");
  file.attach_scales("beam_error", scales);
  place_on_earth(file, field.earth.known(), "beam_error", places_of(field.receivers));
  if (const double share = share_sure(field.beam_errors); !std::isnan(share)) {
    file.set_attribute("", "sure_pct", 100.0 * share);
    file.set_attribute("", "sure_db", sure_db);
  }
}

}  // namespace

void write_field(Hdf5File& file, const FieldData& field) {
  require_finite(field.pressure);
  file.set_attribute("", "frequency_hz", field.frequency);
  file.set_attribute("", "field", field_kinds[static_cast<int>(field.kind)]);
  file.set_attribute("", "source", field.source == SourceKind::line ? "line" : "point");
  if (!field.beam_kind.empty()) file.set_attribute("", "beam_kind", field.beam_kind);
  if (!field.solver.empty()) file.set_attribute("", "solver", field.solver);
  if (field.beams > 0) {
    file.set_attribute("", "beams", static_cast<std::int64_t>(field.beams));
    file.set_attribute("", "beam_error_db", field.beam_error_db);
    file.set_attribute("", "beam_error_bounded", std::int64_t{field.beam_error_bounded});
  }
  write_scale(file, "source_depth", "source_depth", field.source_depths,
              "depth of the source, positive down", "m", cf::depth);
  write_scale<std::int8_t>(file, "re_im", "re_im", {0, 1}, "0 real part, 1 imaginary part");
  const ReceiverGrid& grid = field.receivers;
  const std::size_t sources = field.source_depths.size();
  Shape shape = {sources, grid.depths.size(), grid.ranges.size(), 2};
  std::vector<std::string> scales = {"source_depth", "depth", "range", "re_im"};
  const bellhop::MapPlaces& map = field.map;
  if (map.is_map()) {
    write_scale(file, "source_x", "source_x", map.source_x, "place of the source, to the east",
                "m");
    write_scale(file, "source_y", "source_y", map.source_y, "place of the source, to the north",
                "m");
    write_scale(file, "azimuth", "azimuth", map.azimuths_deg,
                "of the line of receivers, counter-clockwise from east; bearing = 90 - azimuth",
                "degree");
  }
  if (grid.irregular) {
    std::vector<std::int32_t> numbers(grid.ranges.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    write_scale(file, "receiver", "receiver", numbers, "number of the receiver, from 0");
    coordinate(file, "receiver_depth", grid.depths, "depth of the receiver, positive down",
               cf::depth);
    coordinate(file, "receiver_range", grid.ranges, "horizontal distance from the source");
    shape = {sources, grid.ranges.size(), 2};
    scales = {"source_depth", "receiver", "re_im"};
  } else {
    write_scale(file, "depth", "depth", grid.depths, "depth of the receiver, positive down", "m",
                cf::depth_axis);
    write_scale(file, "range", "range", grid.ranges, "horizontal distance from the source", "m",
                cf::range_axis);
  }
  if (map.is_map()) {
    shape.insert(shape.begin(),
                 {map.source_x.size(), map.source_y.size(), map.azimuths_deg.size()});
    scales.insert(scales.begin(), {"source_x", "source_y", "azimuth"});
  }
  std::vector<float> parts;
  parts.reserve(2 * field.pressure.size());
  for (const std::complex<float> p : field.pressure)
    parts.insert(parts.end(), {p.real(), p.imag()});
  file.write<float>("pressure", parts, shape);
  describe(file, "pressure",
           "pressure relative to 1 m from the source; transmission loss = -20 log10 |pressure|",
           "1");
  file.attach_scales("pressure", scales);
  place_on_earth(file, field.earth.known(), "pressure", places_of(grid));
  write_on_earth(file, field.earth, "", "of the receiver", grid.ranges, {grid.ranges.size()},
                 {grid.irregular ? "receiver" : "range"});
  shape.pop_back(), scales.pop_back();
  write_beam_errors(file, field, shape, scales);
}

FieldData read_field(const Hdf5File& file) {
  if (const std::string type = file.attribute_or("", "filetype", ""); type != "asdic field")
    throw wrong(file, "filetype", type.empty() ? "none" : '"' + type + '"', "\"asdic field\"");
  FieldData field{.title = file.attribute_or("", "title", ""),
                  .source_depths = axis(file, "source_depth"),
                  .beam_kind = file.attribute_or("", "beam_kind", "")};
  if (file.has_attribute("", "frequency_hz"))
    field.frequency = file.attribute_number("", "frequency_hz");
  const std::string kind = file.attribute_or("", "field", "coherent");
  const auto known = std::find(std::begin(field_kinds), std::end(field_kinds), kind);
  if (known == std::end(field_kinds))
    throw wrong(file, "field", '"' + kind + '"', "coherent, incoherent or semi-coherent");
  field.kind = static_cast<FieldKind>(known - std::begin(field_kinds));
  if (file.attribute_or("", "source", "point") == "line") field.source = SourceKind::line;
  field.solver = file.attribute_or("", "solver", "");
  if (file.has_attribute("", "beams"))
    field.beams = static_cast<std::size_t>(file.attribute_number("", "beams"));
  if (file.has_attribute("", "beam_error_db"))
    field.beam_error_db = file.attribute_number("", "beam_error_db");
  if (file.has_attribute("", "beam_error_bounded"))
    field.beam_error_bounded = file.attribute_number("", "beam_error_bounded") != 0.0;

  ReceiverGrid& grid = field.receivers;
  grid.irregular = file.has("receiver");
  grid.depths = axis(file, grid.irregular ? "receiver_depth" : "depth");
  grid.ranges = axis(file, grid.irregular ? "receiver_range" : "range");
  if (!file.has("pressure")) throw wrong(file, "pressure", "nothing", "a dataset");
  const Shape shape = file.info("pressure").shape;
  Shape expected =
      grid.irregular ? Shape{field.source_depths.size(), grid.ranges.size(), 2}
                     : Shape{field.source_depths.size(), grid.depths.size(), grid.ranges.size(), 2};
  if (file.has("azimuth")) {
    bellhop::MapPlaces& map = field.map;
    map = {.source_x = axis(file, "source_x"),
           .source_y = axis(file, "source_y"),
           .azimuths_deg = axis(file, "azimuth")};
    expected.insert(expected.begin(),
                    {map.source_x.size(), map.source_y.size(), map.azimuths_deg.size()});
  }
  if (shape != expected || (grid.irregular && grid.depths.size() != grid.ranges.size()))
    throw wrong(file, "pressure", "a shape that does not fit its axes",
                "(source_depth, depth, range, re_im)");
  const std::vector<float> parts = file.read<float>("pressure");
  for (std::size_t i = 0; i + 1 < parts.size(); i += 2)
    field.pressure.emplace_back(parts[i], parts[i + 1]);
  if (file.has("beam_error")) {
    const Shape receivers(shape.begin(), shape.end() - 1);
    if (file.info("beam_error").shape != receivers)
      throw wrong(file, "beam_error", "a shape that does not fit its axes",
                  "that of the pressure without re_im");
    field.beam_errors = file.read<float>("beam_error");
  }
  return field;
}

FieldData read_field(const std::filesystem::path& path) { return read_field(Hdf5File::open(path)); }

bellhop::ShadeFile to_shade_file(const FieldData& field) {
  bellhop::ShadeFile file{.title = field.title,
                          .irregular = field.receivers.irregular,
                          .frequency = field.frequency,
                          .source_depths = field.source_depths,
                          .receiver_depths = field.receivers.depths,
                          .receiver_ranges = field.receivers.ranges,
                          .pressure = field.pressure,
                          .map = field.map};
  if (field.source == SourceKind::point)
    for (std::complex<float>& p : file.pressure) p = -p;
  return file;
}

FieldData from_shade_file(const bellhop::ShadeFile& file) {
  FieldData field{.title = file.title,
                  .frequency = file.frequency,
                  .source_depths = file.source_depths,
                  .receivers = {.depths = file.receiver_depths,
                                .ranges = file.receiver_ranges,
                                .irregular = file.irregular},
                  .pressure = file.pressure,
                  .map = file.map};
  for (std::complex<float>& p : field.pressure) p = -p;
  if (std::all_of(field.pressure.begin(), field.pressure.end(),
                  [](std::complex<float> p) { return p.imag() == 0.0f; }))
    field.kind = FieldKind::incoherent;
  return field;
}

}  // namespace asdic::detail
