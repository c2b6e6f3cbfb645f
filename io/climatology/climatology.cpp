#include "io/climatology/climatology.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/climatology/floor.h"
#include "io/climatology/water.h"
#include "io/climatology/wind.h"
#include "raytrace/area/map_frame.h"

namespace asdic::detail {

OceanOrigin OceanSample::origin() const {
  return {.latitude = radians(latitude),
          .longitude = radians(longitude),
          .time = when.text(),
          .sources = sources};
}

namespace {

using climatology::Floor;
using climatology::Place;
using climatology::Tiles;
using climatology::Water;
using climatology::WaterColumn;
using climatology::Wind;

void check_request(const OceanRequest& request) {
  climatology::check_place(request.latitude, request.longitude);
  if (const auto month = request.when.month; month && (*month < 1 || *month > 12))
    throw InputError(
        {.where = "month", .got = std::to_string(*month), .expected = "a month from 1 to 12"});
  if (request.when.month && request.when.date)
    throw InputError({.where = "month", .got = "a month and a date", .expected = "one of them"});
}

std::string named(const Tiles& tiles) {
  std::string names = tiles.files()[0].path.filename().string();
  if (tiles.files().size() > 1)
    names += " and " + std::to_string(tiles.files().size() - 1) + " more";
  return names + ", " + tiles.files()[0].variable;
}

/// Adds files to the sources of a sample, each digested once.
class SourceList {
 public:
  explicit SourceList(OceanSample& ocean) : ocean_(ocean) {}

  void add(const std::string& quantity, const std::vector<DataFile>& files,
           const std::string& time) {
    for (const DataFile& file : files) {
      std::string& digest = digests_[file.path];
      if (digest.empty()) digest = digest_of(file.path);
      ocean_.sources.push_back({.quantity = quantity,
                                .name = file.path.filename().string(),
                                .variable = file.variable,
                                .digest = digest,
                                .time = time.starts_with("has ") ? "" : time});
    }
  }

 private:
  OceanSample& ocean_;
  std::map<std::filesystem::path, std::string> digests_;
};

/// What is told of the time of a quantity; nothing where the data have none and none was asked for.
void tell_time(const Tiles& tiles, const std::string& what, OceanSample& ocean) {
  const auto& time = tiles.time_at(ocean.latitude, ocean.longitude);
  if (time.fit == 3 && !ocean.when.month && !ocean.when.date) return;
  ocean.notes.push_back(what + (time.said.starts_with("has ") ? " " : ": ") + time.said);
}

void read_wind(const std::vector<DataFile>& files, OceanSample& ocean, SourceList& sources) {
  if (files.empty()) {
    ocean.notes.push_back("no file of winds was named: a scenario takes its own wind_speed");
    return;
  }
  const Wind wind(files, ocean.when);
  const Tiles& tiles = wind.first();
  const auto& time = tiles.time_at(ocean.latitude, ocean.longitude);
  if (wind.second() == nullptr) {
    ocean.origins.push_back("wind: " + named(tiles));
    sources.add("wind", tiles.files(), time.said);
  } else {
    ocean.origins.push_back("wind: " + named(tiles) + " and " + wind.second()->files()[0].variable);
    sources.add("eastward wind", tiles.files(), time.said);
    sources.add("northward wind", wind.second()->files(), time.said);
    if (time.parts.size() == 1 && tiles.first().times() <= 12)
      ocean.notes.push_back(
          "the wind speed is that of its components, which is less than the mean speed where they "
          "are means");
  }
  tell_time(tiles, "the wind", ocean);
  ocean.notes.insert(ocean.notes.end(), tiles.remarks().begin(), tiles.remarks().end());
  const double speed = wind.at(ocean.latitude, ocean.longitude);
  if (!std::isnan(speed))
    ocean.wind_speed = speed;
  else
    ocean.notes.push_back(
        "the wind is not known there: " + tiles.short_name_at(ocean.latitude, ocean.longitude) +
        (tiles.holds(ocean.latitude, ocean.longitude) ? " has a hole at " : " does not reach ") +
        climatology::place(ocean.latitude, ocean.longitude));
}

void read_profile(const OceanSources& files, OceanSample& ocean, SourceList& sources) {
  const Water water(files, ocean.when, ocean.latitude, ocean.longitude);
  const WaterColumn column = water.require(ocean.latitude, ocean.longitude);
  ocean.depth = column.depth;
  ocean.temperature = column.temperature;
  ocean.salinity = column.salinity;
  ocean.speed = column.speed;
  if (ocean.depth.back() < ocean.water_depth)
    ocean.notes.push_back(
        "the profile ends at " + to_text(std::round(10.0 * ocean.depth.back()) / 10.0) +
        " m; below, its last " +
        (ocean.speed.empty() ? "temperature and salinity go on" : "speed grows with pressure") +
        " to the bottom at " + to_text(std::round(ocean.water_depth)) + " m");
  for (const std::string& origin : water.origins()) ocean.origins.push_back(origin);
  for (const std::string& note : water.notes(ocean.latitude, ocean.longitude))
    ocean.notes.push_back(note);
  for (const Water::Source& source : water.used(ocean.latitude, ocean.longitude))
    sources.add(source.quantity, source.files, source.time);
}

void read_sediment(const std::vector<DataFile>& files, OceanSample& ocean, SourceList& sources) {
  if (!files.empty()) {
    const SedimentMap map(files, ocean.when);
    sources.add("sediment", map.tiles().files(),
                map.tiles().time_at(ocean.latitude, ocean.longitude).said);
    ocean.origins.push_back("sediment: " + named(map.tiles()));
    if (const auto there = map.at(ocean.latitude, ocean.longitude)) {
      ocean.sediment = *there;
      ocean.sediment_by =
          "of the map " + map.tiles().short_name_at(ocean.latitude, ocean.longitude);
      return;
    }
    ocean.notes.push_back("the map of sediments says nothing of " +
                          climatology::place(ocean.latitude, ocean.longitude));
  }
  ocean.sediment = sediment_at_depth(ocean.water_depth);
  ocean.sediment_by = "the data say nothing of the sediment: of the " +
                      std::string(province_at_depth(ocean.water_depth)) + ", " +
                      ocean.sediment.name + " was taken";
  ocean.notes.push_back(ocean.sediment_by + "; --sediment takes a map");
}

}  // namespace

OceanSample sample_ocean(const OceanSources& sources, const OceanRequest& request) {
  check_request(request);
  OceanSample ocean{
      .latitude = request.latitude, .longitude = request.longitude, .when = request.when};
  SourceList list(ocean);
  const Floor floor(sources.bathymetry, {});
  ocean.water_depth = floor.require({request.latitude, request.longitude});
  read_profile(sources, ocean, list);
  ocean.origins.push_back("depth: " + named(floor.tiles()));
  list.add("bathymetry", floor.tiles().files(), "");
  ocean.notes.insert(ocean.notes.end(), floor.notes().begin(), floor.notes().end());
  read_wind(sources.wind, ocean, list);
  read_sediment(sources.sediment, ocean, list);
  return ocean;
}

// Water and sea floor along a great circle.

namespace {

/// Levels for straight lines: the measured ones, where the curve's bend changes, and between them
/// some 5 m apart near the surface, a thirtieth of the depth further down. A curve leaves its chord
/// by h²c″/8: 0.02 m/s in a thermocline of 5e-3 m/s per m², 0.035 m/s where PCHIP bends most about
/// the axis of the sound channel.
std::vector<double> levels_down_to(double deepest, const std::vector<double>& measured) {
  std::vector<double> levels = {0.0};
  const auto go_to = [&](double end) {
    const double begin = levels.back(), width = end - begin;
    const int pieces = static_cast<int>(std::ceil(width / std::max(5.0, begin / 30.0)));
    for (int i = 1; i <= pieces; ++i) levels.push_back(std::round(begin + width * i / pieces));
  };
  deepest = std::ceil(deepest);
  for (const double depth : measured)
    if (depth >= levels.back() + 1.0 && depth <= deepest - 1.0) go_to(depth);
  go_to(deepest);
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

/// Profiles in the middle of the spans that they are nearest to.
void read_stations(const Water& water, const Place& start, OceanSection& section) {
  struct Segment {
    WaterColumn column;
    double first, last;
    Place place;
  };
  std::vector<Segment> segments;
  Place before = start;
  bool known = false;
  for (const double r : section.range) {
    const Place here = start.at(r, section.bearing_deg);
    if (known && water.same(here.latitude, here.longitude, before.latitude, before.longitude)) {
      segments.back().last = r;
      before = here;
      continue;
    }
    WaterColumn column = water.at(here.latitude, here.longitude);
    known = !column.depth.empty();
    before = here;
    if (!known) continue;  // land in the grid: the neighbours' water goes on
    if (!segments.empty() && column == segments.back().column)
      segments.back().last = r;
    else
      segments.push_back({std::move(column), r, r, here});
  }
  if (segments.empty()) static_cast<void>(water.require(start.latitude, start.longitude));
  const double deepest = *std::max_element(section.floor.begin(), section.floor.end());
  section.depth = levels_down_to(deepest, water.levels());
  for (const Segment& segment : segments) {
    section.station.push_back(0.5 * (segment.first + segment.last));
    const auto speed =
        climatology::speeds_of(segment.column, section.depth, segment.place.latitude);
    section.speed.insert(section.speed.end(), speed.begin(), speed.end());
  }
}

/// What the sea floor is along the track: of the map, or as at its start.
void read_sediments(const OceanSources& sources, const OceanRequest& request,
                    OceanSection& section) {
  const Place start{request.latitude, request.longitude};
  if (sources.sediment.empty()) {
    const auto province = province_at_depth(section.floor.front());
    for (std::size_t i = 0; i < section.floor.size(); ++i)
      if (province_at_depth(section.floor[i]) != province) {
        section.notes.push_back(
            "the sediment is that of the start all along the track, which from " +
            to_text(section.range[i]) + " m on is not the " + std::string(province) +
            "; --sediment takes a map");
        break;
      }
    return;
  }
  const SedimentMap map(sources.sediment, request.when);
  bool by_depth = false;
  for (std::size_t i = 0; i < section.range.size(); ++i) {
    const Place here = start.at(section.range[i], section.bearing_deg);
    const auto there = map.at(here.latitude, here.longitude);
    by_depth = by_depth || !there;
    section.sediment.push_back(there.value_or(sediment_at_depth(section.floor[i])));
  }
  if (by_depth)
    section.notes.push_back("where the map of sediments says nothing, it was taken by the depth");
  const bool same = std::all_of(section.sediment.begin(), section.sediment.end(),
                                [&](const Sediment& s) { return s == section.sediment[0]; });
  if (same) section.sediment.clear();
}

}  // namespace

OceanSection sample_section(const OceanSources& sources, const OceanRequest& request) {
  check_request(request);
  if (!(request.range > 0.0 && request.range <= pi * MapFrame::earth_radius))
    throw InputError({.where = "range",
                      .got = to_text(request.range) + " m",
                      .expected = "a range above 0 and at most half way round the Earth"});
  const Floor floor(sources.bathymetry, {});
  const Place start{request.latitude, request.longitude};
  climatology::Track track =
      climatology::sample_track(floor, start, request.bearing_deg, request.range, request.step);
  OceanSection section{.bearing_deg = request.bearing_deg,
                       .range = std::move(track.range),
                       .floor = std::move(track.depth),
                       .notes = std::move(track.notes)};
  read_stations(Water(sources, request.when, request.latitude, request.longitude), start, section);
  read_sediments(sources, request, section);
  return section;
}

}  // namespace asdic::detail
