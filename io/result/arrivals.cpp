// Arrivals of tables.h.
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <tuple>

#include "core/error.h"
#include "core/units.h"
#include "io/hdf5/earth.h"
#include "io/ping/growing_table.h"
#include "io/result/tables.h"

namespace asdic::detail::result_tables {
namespace {

using bellhop::ArrivalRow;
using bellhop::ArrivalsFile;
using Type = ElementType;

/// Im τ that takes so many decibels at a frequency: A·exp(ω Im τ).
double imaginary_delay(double absorption_db, double frequency) {
  return frequency > 0.0 ? -absorption_db / db_per_neper / (2.0 * pi * frequency) : 0.0;
}

/// \param map  whether receivers lie in several planes of a map
std::vector<GrowingTable::Column> columns(bool map) {
  std::vector<GrowingTable::Column> all = {
      {"source_index", "index into source_depth", "", Type::int32},
      {"depth_index", "index into depth", "", Type::int32},
      {"range_index", "index into range", "", Type::int32},
      {"range", "horizontal distance of the receiver", "m"},
      {"launch_elevation_deg", "elevation of travel at the start, positive up", "degree"},
      {"arrival_elevation_deg", "elevation of travel at the end, positive up", "degree"},
      {"launch_deflection_deg", "of travel at the start, clockwise from the line to the receiver",
       "degree"},
      {"arrival_deflection_deg", "of travel at the end, clockwise from that line", "degree"},
      {"delay", "travel time", "s"},
      {"amplitude_real", "pressure re 1 m, real part", ""},
      {"amplitude_imag", "pressure re 1 m, imaginary part", ""},
      {"absorption_db", "absorption loss, contained in the amplitude", "dB"},
      {"amplitude", "magnitude of the pressure re 1 m without absorption", ""},
      {"phase_deg", "what reflections and caustics added, not wrapped", "degree"},
      {"delay_imaginary", "amplitude times exp(2 pi f delay_imaginary) has the absorption", "s"},
      {"surface_bounces", "reflections at the surface", "", Type::int32},
      {"bottom_bounces", "reflections at the bottom", "", Type::int32}};
  if (map)
    all.insert(all.end(), {{"source_x_index", "index into source_x", "", Type::int32},
                           {"source_y_index", "index into source_y", "", Type::int32},
                           {"azimuth_index", "index into azimuth", "", Type::int32}});
  return all;
}

/// The columns of a table that are needed here.
class Table {
 public:
  explicit Table(const Hdf5File& file) : file_(file) {
    delay = column("delay");
    launch = column("launch_elevation_deg");
    arrival = column("arrival_elevation_deg");
    if (has("launch_deflection_deg")) {  // since version 1.3
      launch_aside = column("launch_deflection_deg");
      arrival_aside = column("arrival_deflection_deg");
    }
    real = column("amplitude_real");
    imag = column("amplitude_imag");
    absorption = column("absorption_db");
    range = column("range");
    surface = column("surface_bounces");
    bottom = column("bottom_bounces");
  }

  [[nodiscard]] bool has(const std::string& name) const { return file_.has("arrivals/" + name); }

  [[nodiscard]] std::vector<double> column(const std::string& name) const {
    if (!has(name)) throw fault(name, "nothing", "a column (docs/formats/arrivals.md)");
    std::vector<double> values = file_.read<double>("arrivals/" + name);
    if (!delay.empty() && values.size() != delay.size())
      throw fault(name, std::to_string(values.size()) + " rows", std::to_string(delay.size()));
    return values;
  }

  [[nodiscard]] std::size_t rows() const { return delay.size(); }

  [[nodiscard]] ArrivalRow row(std::size_t i, double frequency) const {
    const std::complex<double> a(real[i], imag[i]);
    return {.amplitude = std::abs(a) * amplitude_from_db(absorption[i]),
            .phase_deg = degrees(std::arg(a)),
            .delay = delay[i],
            .delay_imaginary = imaginary_delay(absorption[i], frequency),
            .launch_angle_deg = -launch[i],  // declination
            .arrival_angle_deg = -arrival[i],
            .surface_bounces = static_cast<int>(surface[i]),
            .bottom_bounces = static_cast<int>(bottom[i]),
            .launch_deflection_deg = launch_aside.empty() ? 0.0 : launch_aside[i],
            .arrival_deflection_deg = arrival_aside.empty() ? 0.0 : arrival_aside[i]};
  }

  [[nodiscard]] InputError fault(const std::string& name, const std::string& got,
                                 const std::string& expected) const {
    return InputError(
        {.where = file_.path().string() + ": arrivals/" + name, .got = got, .expected = expected});
  }

  std::vector<double> delay, launch, arrival, launch_aside, arrival_aside, real, imag, absorption,
      range, surface, bottom;

 private:
  const Hdf5File& file_;
};

/// What write_arrivals() wrote: receivers by index.
void read_grid(const Hdf5File& file, const Table& table, ArrivalsFile& result) {
  const auto axis = [&](const char* name) {
    std::vector<double> values;
    if (file.has(name)) values = file.read<double>(name);
    if (values.empty()) throw table.fault(name, "nothing", "an axis");
    return values;
  };
  result.source_depths = axis("source_depth");
  result.receiver_depths = axis("depth");
  result.receiver_ranges = axis("range");
  result.irregular =
      file.has_attribute("", "irregular") && file.attribute_number("", "irregular") != 0.0;
  const std::size_t rows = result.irregular ? 1 : result.receiver_depths.size();
  const std::size_t ranges = result.receiver_ranges.size();
  std::vector<double> source_x, source_y, azimuth;
  if (table.has("azimuth_index")) {
    result.three_dimensional = true;
    result.map = {.source_x = axis("source_x"),
                  .source_y = axis("source_y"),
                  .azimuths_deg = axis("azimuth")};
    source_x = table.column("source_x_index");
    source_y = table.column("source_y_index");
    azimuth = table.column("azimuth_index");
  }
  const bellhop::MapPlaces& map = result.map;
  result.arrivals.resize(map.planes() * result.source_depths.size() * rows * ranges);
  const auto source = table.column("source_index"), depth = table.column("depth_index"),
             range = table.column("range_index"), amplitude = table.column("amplitude"),
             phase = table.column("phase_deg"), imaginary = table.column("delay_imaginary");
  const auto index = [&](const char* name, double value, std::size_t size) {
    if (!(value >= 0.0 && value < static_cast<double>(size)))
      throw table.fault(name, std::to_string(value), "an index below " + std::to_string(size));
    return static_cast<std::size_t>(value);
  };
  for (std::size_t i = 0; i < table.rows(); ++i) {
    ArrivalRow row = table.row(i, result.frequency);
    row.amplitude = amplitude[i];
    row.phase_deg = phase[i];
    row.delay_imaginary = imaginary[i];
    const std::size_t s = index("source_index", source[i], result.source_depths.size());
    const std::size_t z = index("depth_index", depth[i], rows);
    const std::size_t r = index("range_index", range[i], ranges);
    std::size_t plane = 0;
    if (result.three_dimensional)
      plane = (index("source_x_index", source_x[i], map.source_x.size()) * map.source_y.size() +
               index("source_y_index", source_y[i], map.source_y.size())) *
                  map.azimuths_deg.size() +
              index("azimuth_index", azimuth[i], map.azimuths_deg.size());
    result.arrivals[((plane * result.source_depths.size() + s) * rows + z) * ranges + r].push_back(
        row);
  }
}

/// Tables of `asdic arrivals` and `asdic ping`: a leg is a receiver, one after another.
void read_legs(const Hdf5File& file, const Table& table, ArrivalsFile& result) {
  const auto number = [&](const char* key) {
    return file.has_attribute("", key) ? file.attribute_number("", key) : 0.0;
  };
  result.source_depths = {number("source_depth_m")};
  const auto ping = table.column("ping"), leg = table.column("leg"),
             target = table.column("target"), channel = table.column("channel");
  std::map<std::tuple<double, double, double, double>, std::size_t> receivers;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto [place, is_new] =
        receivers.try_emplace({ping[i], leg[i], target[i], channel[i]}, result.arrivals.size());
    if (is_new) {
      result.arrivals.emplace_back();
      result.receiver_ranges.push_back(table.range[i]);
      result.receiver_depths.push_back(number("receiver_depth_m"));
    }
    result.arrivals[place->second].push_back(table.row(i, result.frequency));
  }
  result.irregular = result.arrivals.size() > 1;
}

}  // namespace

void write_arrivals(Hdf5File& file, const ArrivalsFile& arrivals, const EarthLine& earth) {
  file.set_attribute("", "frequency_hz", arrivals.frequency);
  file.set_attribute("", "irregular", std::int64_t{arrivals.irregular});
  write_scale(file, "source_depth", "source_depth", arrivals.source_depths,
              "depth of the source, positive down", "m", cf::depth);
  write_scale(file, "depth", "depth", arrivals.receiver_depths,
              "depth of the receiver, positive down", "m", cf::depth_axis);
  write_scale(file, "range", "range", arrivals.receiver_ranges,
              "horizontal distance from the source", "m", cf::range_axis);
  write_on_earth(file, earth, "", "of the receiver", arrivals.receiver_ranges,
                 {arrivals.receiver_ranges.size()}, {"range"});
  const std::size_t ranges = arrivals.receiver_ranges.size();
  const std::size_t rows = arrivals.irregular ? 1 : arrivals.receiver_depths.size();
  const bellhop::MapPlaces& map = arrivals.map;
  if (arrivals.three_dimensional) {
    write_scale(file, "source_x", "source_x", map.source_x, "place of the source, to the east",
                "m");
    write_scale(file, "source_y", "source_y", map.source_y, "place of the source, to the north",
                "m");
    write_scale(file, "azimuth", "azimuth", map.azimuths_deg,
                "of the line of receivers, counter-clockwise from east; bearing = 90 - azimuth",
                "degree");
  }
  GrowingTable table(file, "arrivals", "arrival", columns(arrivals.three_dimensional));
  const double w = 2.0 * pi * arrivals.frequency;
  for (std::size_t i = 0; i < arrivals.arrivals.size(); ++i)
    for (const ArrivalRow& a : arrivals.arrivals[i]) {
      const std::complex<double> pressure =
          std::polar(a.amplitude * std::exp(w * a.delay_imaginary), radians(a.phase_deg));
      const std::size_t source = i / (rows * ranges), sources = arrivals.source_depths.size();
      std::vector<double> cells = {static_cast<double>(source % sources),
                                   static_cast<double>(i / ranges % rows),
                                   static_cast<double>(i % ranges),
                                   arrivals.receiver_ranges[i % ranges],
                                   -a.launch_angle_deg,
                                   -a.arrival_angle_deg,
                                   a.launch_deflection_deg,
                                   a.arrival_deflection_deg,
                                   a.delay,
                                   pressure.real(),
                                   pressure.imag(),
                                   -w * a.delay_imaginary * db_per_neper,
                                   a.amplitude,
                                   a.phase_deg,
                                   a.delay_imaginary,
                                   double(a.surface_bounces),
                                   double(a.bottom_bounces)};
      if (arrivals.three_dimensional) {
        const std::size_t azimuths = map.azimuths_deg.size(), place = source / sources / azimuths;
        cells.insert(cells.end(), {static_cast<double>(place / map.source_y.size()),
                                   static_cast<double>(place % map.source_y.size()),
                                   static_cast<double>(source / sources % azimuths)});
      }
      table.row(cells);
    }
  table.write();
}

ArrivalsFile read_arrivals(const Hdf5File& file) {
  ArrivalsFile result;
  if (file.has_attribute("", "frequency_hz"))
    result.frequency = file.attribute_number("", "frequency_hz");
  const Table table(file);
  if (table.has("range_index"))
    read_grid(file, table, result);
  else
    read_legs(file, table, result);
  return result;
}

}  // namespace asdic::detail::result_tables
