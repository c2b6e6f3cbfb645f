#include "io/processing/table.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace asdic::detail {
namespace processing {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
using Type = ElementType;

double bearing_degrees(double bearing) {
  return std::isnan(bearing) ? none : compass_degrees(bearing);
}

/// The columns of one of a detection's places.
std::vector<GrowingTable::Column> place_columns(const std::string& prefix,
                                                const std::string& side) {
  return {{prefix + "x", "east, where it was struck" + side, "m"},
          {prefix + "y", "north" + side, "m"},
          {prefix + "depth", "assumed or traced" + side, "m"},
          {prefix + "range", "horizontal, from the array when it received it" + side, "m"},
          {prefix + "bearing_deg", "from there, true (clockwise from north)" + side, "degree"},
          {prefix + "path_elevation_deg", "look elevation of the returning path" + side, "degree"},
          {prefix + "range_rate", "of half the horizontal way there and back" + side, "m/s"},
          {prefix + "surface_bounces", "there and back" + side, "", Type::int32},
          {prefix + "bottom_bounces", "there and back" + side, "", Type::int32}};
}

/// Of places on the Earth, the last columns where they are known.
void add_earth_columns(std::vector<GrowingTable::Column>& columns, const std::string& prefix,
                       const std::string& what) {
  columns.push_back(
      {prefix + "latitude", "latitude " + what, "degrees_north", Type::float64, cf::latitude});
  columns.push_back(
      {prefix + "longitude", "longitude " + what, "degrees_east", Type::float64, cf::longitude});
}

void add_earth_place(std::vector<double>& row, const EarthPlaces& earth, double x, double y) {
  const GeographicPlace there = earth.at(x, y);
  row.insert(row.end(), {there.latitude, there.longitude});
}

void add_earth_place(std::vector<double>& row, const EarthPlaces& earth, const Detection& d,
                     std::size_t side) {
  const bool known = d.locations.size() > side && !std::isnan(d.locations[side].bearing);
  add_earth_place(row, earth, known ? d.locations[side].position.x() : none,
                  known ? d.locations[side].position.y() : none);
}

void add_place(std::vector<double>& row, const Detection& d, std::size_t side) {
  if (d.locations.size() <= side) {
    row.insert(row.end(), {none, none, none, none, none, none, none, -1.0, -1.0});
    return;
  }
  const Location& p = d.locations[side];
  const bool known = !std::isnan(p.bearing);
  row.insert(row.end(), {known ? p.position.x() : none, known ? p.position.y() : none,
                         p.position.z(), p.range, bearing_degrees(p.bearing), degrees(p.elevation),
                         p.range_rate, double(p.surface_bounces), double(p.bottom_bounces)});
}

}  // namespace

std::vector<GrowingTable::Column> detection_columns() {
  std::vector<GrowingTable::Column> columns{
      {"time", "of the leading edge, after the start of the ping", "s"},
      {"doppler_factor", "received over transmitted frequency", ""},
      {"doppler_sigma", "its standard deviation; a sweep's time errs with it along the ridge", ""},
      {"snr_db", "peak of the envelope over its mean square around it", "dB"},
      {"excess_db", "peak over the threshold", "dB"},
      {"level_db", "of an echo from there, peak envelope over sqrt 2", "dB", Type::float64,
       cf::level},
      {"axis_cosine", "of the angle between look direction and a line's axis", ""},
      {"look_bearing_deg",
       "true (clockwise from north), as if it came horizontally, right of a line", "degree"},
      {"look_elevation_deg", "positive up; NaN where the array tells none", "degree"},
      {"target", "whose echo it is, -1: a false alarm, -2: the transmitter's own sound", "",
       Type::int32},
      {"places", "that fit it: 2 where two sides cannot be resolved", "", Type::int32}};
  for (const auto& more : {place_columns("", ""), place_columns("mirror_", ", the other side")})
    columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

std::vector<double> detection_row(const Detection& d, int owner) {
  std::vector<double> row{d.time,
                          d.doppler,
                          d.doppler_sigma,
                          d.snr_db,
                          d.excess_db,
                          d.level_db,
                          d.cosine,
                          bearing_degrees(d.bearing),
                          degrees(d.elevation),
                          double(owner),
                          double(d.locations.size())};
  add_place(row, d, 0);
  add_place(row, d, 1);
  return row;
}

Table detections_table(const ProcessedRun& run) {
  Table table;
  table.columns = {{"ping", "number of the ping", "", Type::int32},
                   {"array", "number of the array", "", Type::int32}};
  for (GrowingTable::Column& column : detection_columns())
    table.columns.push_back(std::move(column));
  if (run.earth.known()) {
    add_earth_columns(table.columns, "", "of where it was struck");
    add_earth_columns(table.columns, "mirror_", "of where it was struck, the other side");
  }
  for (const ProcessedPing& ping : run.pings)
    for (std::size_t i = 0; i < ping.array.result.detections.size(); ++i) {
      const Detection& d = ping.array.result.detections[i];
      std::vector<double> row{double(d.ping), double(d.array)};
      const std::vector<double> numbers =
          detection_row(d, i < ping.score.owner.size() ? ping.score.owner[i] : -1);
      row.insert(row.end(), numbers.begin(), numbers.end());
      if (run.earth.known())
        for (const std::size_t side : {0U, 1U}) add_earth_place(row, run.earth, d, side);
      table.rows.push_back(std::move(row));
    }
  return table;
}

Table tracks_table(const ProcessedRun& run) {
  Table table;
  table.columns = {{"track", "number of the track, from 1", "", Type::int32},
                   {"array", "number of the array", "", Type::int32},
                   {"side", "0: right of a line (or the only one), 1: left", "", Type::int32},
                   {"ambiguous", "1 if there is one like it on the other side", "", Type::int32},
                   {"ping", "number of the ping", "", Type::int32},
                   {"detection", "row of detections, -1: none in this ping", "", Type::int32},
                   {"time", "since the start of the scenario", "s"},
                   {"x", "east", "m"},
                   {"y", "north", "m"},
                   {"vx", "velocity, east", "m/s"},
                   {"vy", "velocity, north", "m/s"},
                   {"range", "horizontal, where the array tells no bearing", "m"},
                   {"range_rate", "where the array tells no bearing", "m/s"},
                   {"position_sigma", "root of the trace of its covariance", "m"},
                   {"velocity_sigma", "root of the trace of its covariance", "m/s"},
                   {"target", "that most of its detections are of, -1: none", "", Type::int32},
                   {"error", "from that target: distance, or of the range alone", "m"}};
  if (run.earth.known()) add_earth_columns(table.columns, "", "of the track");
  for (std::size_t k = 0; k < run.tracks.size(); ++k) {
    const ProcessedTrack& t = run.tracks[k];
    for (std::size_t i = 0; i < t.track.points.size(); ++i) {
      const TrackPoint& p = t.track.points[i];
      const bool place = t.has_bearing;
      table.rows.push_back({static_cast<double>(k + 1), double(t.array), double(t.side),
                            t.ambiguous ? 1.0 : 0.0, double(p.ping), double(t.rows[i]), p.time,
                            place ? p.position.x() : none, place ? p.position.y() : none,
                            place ? p.velocity.x() : none, place ? p.velocity.y() : none,
                            place ? none : p.position.y(), place ? none : p.velocity.y(),
                            p.position_sigma, p.velocity_sigma, double(t.target), t.error[i]});
      if (run.earth.known())
        add_earth_place(table.rows.back(), run.earth, place ? p.position.x() : none,
                        place ? p.position.y() : none);
    }
  }
  return table;
}

Table targets_table(const ProcessedRun& run) {
  Table table;
  table.columns = {
      {"ping", "number of the ping", "", Type::int32},
      {"array", "number of the array", "", Type::int32},
      {"target", "number of the target", "", Type::int32},
      {"present", "1 if the target is there", "", Type::int32},
      {"detectable", "1 if an echo over the threshold is in the time searched", "", Type::int32},
      {"hit", "1 if it was detected", "", Type::int32},
      {"detection", "row of detections, the loudest; -1: none", "", Type::int32},
      {"position_error", "horizontal, of the better of two places", "m"},
      {"range_error", "found minus actual, from the array", "m"},
      {"bearing_error_deg", "found minus actual", "degree"}};
  for (std::size_t k = 0; k < run.pings.size(); ++k) {
    const ProcessedPing& ping = run.pings[k];
    const int first = first_row(run, k);
    for (const TargetScore& s : ping.score.targets)
      table.rows.push_back({double(ping.array.ping), double(ping.array.array), double(s.target),
                            s.present ? 1.0 : 0.0, s.detectable ? 1.0 : 0.0, s.hit ? 1.0 : 0.0,
                            double(s.detection < 0 ? -1 : first + s.detection), s.position_error,
                            s.range_error, degrees(s.bearing_error)});
  }
  return table;
}

namespace {

std::string csv(const Table& table) {
  std::ostringstream text;
  text.precision(10);
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    text << (i == 0 ? "" : ",") << table.columns[i].name;
  text << '\n';
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text << ',';
      if (!std::isnan(row[i])) text << row[i];
    }
    text << '\n';
  }
  return text.str();
}

}  // namespace
}  // namespace processing

int first_row(const ProcessedRun& run, std::size_t ping) {
  std::size_t row = 0;
  for (std::size_t k = 0; k < ping; ++k) row += run.pings[k].array.result.detections.size();
  return static_cast<int>(row);
}

std::string detections_csv(const ProcessedRun& run) {
  return processing::csv(processing::detections_table(run));
}
std::string tracks_csv(const ProcessedRun& run) {
  return processing::csv(processing::tracks_table(run));
}

}  // namespace asdic::detail
