#include "io/climatology/floor.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/climatology/words.h"
#include "raytrace/area/map_frame.h"

namespace asdic::detail::climatology {

Place Place::at(double distance, double bearing_deg) const {
  const double theta = radians(bearing_deg);
  const MapFrame::OnGrid there =
      MapFrame::geographic({latitude, longitude})
          .on_grid(distance * std::sin(theta), distance * std::cos(theta));
  return {there.v, there.u};
}

Floor::Floor(const std::vector<DataFile>& files, const OceanTime& when)
    : tiles_(files, bathymetry_quantity(), when), notes_(tiles_.remarks()) {
  sign_ = depth_sign(tiles_.first(), notes_);
}

double depth_sign(const DataGrid& grid, std::vector<std::string>& notes) {
  const std::string variable = lower(grid.variable()), standard = lower(grid.standard_name()),
                    about = lower(grid.long_name());
  const auto says = [&](const char* word) {
    return variable.find(word) != std::string::npos || standard.find(word) != std::string::npos;
  };
  if (says("depth") || variable == "deptho") return 1.0;
  const bool height =
      says("elevation") || says("height") || says("altitude") || says("topo") ||
      variable == "rose" || variable == "z" || about.find("elevation") != std::string::npos ||
      about.find("height") != std::string::npos || about.find("relief") != std::string::npos;
  if (!height && about.find("depth") != std::string::npos) return 1.0;
  if (!height)
    notes.push_back(grid.path().filename().string() + ": " + grid.variable() +
                    " does not say what it is: taken as a height, positive up");
  return -1.0;
}

double Floor::checked(double depth, const Place& place_) const {
  constexpr double most = 20'000.0;
  if (std::isnan(depth) || std::abs(depth) <= most) return depth;
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", std::abs(depth));
  throw InputError({.where = tiles_.name_at(place_.latitude, place_.longitude) + ": " +
                             place(place_.latitude, place_.longitude),
                    .got = "a " + std::string(depth > 0.0 ? "depth" : "height") + " of " +
                           std::string(text) + " m",
                    .expected = "at most 20000 m: a file tells which value stands for none, and "
                                "its unit"});
}

double Floor::require(const Place& place_) const {
  tiles_.check_holds(place_.latitude, place_.longitude);
  const double depth_there = depth(place_);
  if (depth_there > 0.0) return depth_there;
  throw InputError({.where = tiles_.name_at(place_.latitude, place_.longitude) + ": " +
                             place(place_.latitude, place_.longitude),
                    .got = std::isnan(depth_there)
                               ? "a hole: its nearest grid point has no value"
                               : "land, " + to_text(std::round(-depth_there)) + " m high",
                    .expected = "a place at sea, within the grid"});
}

namespace {

struct Sample {
  double range, depth;
};

/// Where a track crosses grid lines between two ranges.
std::vector<double> crossings(const Floor& floor, const Place& start, double bearing_deg,
                              double begin, double end) {
  const auto at = [&](double range) {
    const Place here = start.at(range, bearing_deg);
    return floor.tiles().grid_place(here.latitude, here.longitude);
  };
  const auto a = at(begin), b = at(end);
  std::vector<double> all;
  if (!a || !b || a->tile != b->tile) return all;
  const auto along = [&](double from, double to) {
    if (std::abs(to - from) > 1000.0) return;  // over the seam of the globe
    for (double line = std::ceil(std::min(from, to)); line <= std::max(from, to); line += 1.0)
      if (to != from) all.push_back(std::lerp(begin, end, (line - from) / (to - from)));
  };
  along(a->east, b->east);
  along(a->north, b->north);
  std::sort(all.begin(), all.end());
  return all;
}

/// Puts the samples between two others that are furthest off the straight line, as many as matter.
void refine(const std::vector<Sample>& between, const Sample& begin, const Sample& end,
            double apart, std::vector<Sample>& into) {
  const Sample* worst = nullptr;
  double most = 0.0;
  for (const Sample& sample : between) {
    if (sample.range < begin.range + apart || sample.range > end.range - apart) continue;
    const double share = (sample.range - begin.range) / (end.range - begin.range);
    const double off = std::abs(sample.depth - std::lerp(begin.depth, end.depth, share));
    if (off <= std::max(1.0, 2e-3 * sample.depth) || off <= most) continue;
    worst = &sample;
    most = off;
  }
  if (worst == nullptr) return;
  const Sample middle = *worst;
  refine(between, begin, middle, apart, into);
  into.push_back(middle);
  refine(between, middle, end, apart, into);
}

}  // namespace

Track sample_track(const Floor& floor, const Place& start, double bearing_deg, double range,
                   std::optional<double> step) {
  constexpr double most = 2e5;
  const double own = floor.tiles().spacing(start.latitude, start.longitude, bearing_deg);
  const double wanted = step.value_or(own);
  if (!(wanted > 0.0) || range / wanted > most)
    throw InputError({.where = "step",
                      .got = to_text(wanted) + " m over " + to_text(range) + " m",
                      .expected = "a step above 0 m and at most 200000 samples: a longer --step"});
  Track track;
  const int steps = std::max(1, static_cast<int>(std::ceil(range / wanted - 1e-9)));
  const bool whole = range / steps > 20.0;  // positions in whole metres lose nothing
  const double apart =
      whole ? std::max(1.0, std::floor(0.01 * range / steps)) : 0.01 * range / steps;
  Sample last{};
  double missed = 0.0, missed_at = 0.0;
  const auto coast = [&](double r) {
    track.notes.push_back("the transect ends at the coast, before " + to_text(r) + " m");
  };
  for (int i = 0; i <= steps; ++i) {
    const double exact = range * i / steps;
    const double r = whole && i < steps ? std::round(exact) : exact;
    const Place here = start.at(r, bearing_deg);
    const Sample sample{r, floor.between(here)};
    if (!(sample.depth > 0.0)) {
      if (i == 0) {
        static_cast<void>(floor.require(start));
        throw InputError({.where = floor.tiles().name_at(start.latitude, start.longitude) + ": " +
                                   place(start.latitude, start.longitude),
                          .got = "land among the grid points around",
                          .expected = "a transect that starts at sea"});
      }
      const auto rounded = [](double degree) { return std::round(1e4 * degree) / 1e4; };
      const std::string before = ", before " + to_text(r) + " m",
                        there = place(rounded(here.latitude), rounded(here.longitude));
      if (!std::isnan(sample.depth))
        coast(r);
      else if (floor.tiles().holds(here.latitude, here.longitude))
        track.notes.push_back("the transect ends at a hole in " +
                              floor.tiles().short_name_at(here.latitude, here.longitude) + before +
                              " at " + there + ": that is no coast");
      else {
        const Place left = start.at(last.range, bearing_deg);
        track.notes.push_back(
            "the transect leaves " + floor.tiles().short_name_at(left.latitude, left.longitude) +
            before + " at " + there + ": that is no coast, --bathymetry takes the next tile too");
      }
      break;
    }
    if (i > 0) {
      std::vector<Sample> between, finer;
      for (const double crossing : crossings(floor, start, bearing_deg, last.range, r)) {
        const double at = whole ? std::round(crossing) : crossing;
        const double depth = floor.between(start.at(at, bearing_deg));
        if (depth <= 0.0) {  // an island between two samples
          coast(at);
          return track;
        }
        if (!std::isnan(depth)) between.push_back({at, depth});
      }
      refine(between, last, sample, apart, finer);
      for (const Sample& one : finer) {
        if (step) {
          const double share = (one.range - last.range) / (sample.range - last.range);
          const double off = std::abs(one.depth - std::lerp(last.depth, sample.depth, share));
          if (off > missed) missed = off, missed_at = one.range;
          continue;
        }
        track.range.push_back(one.range);
        track.depth.push_back(one.depth);
      }
    }
    track.range.push_back(sample.range);
    track.depth.push_back(sample.depth);
    last = sample;
  }
  if (missed > 10.0)
    track.notes.push_back("steps of " + to_text(wanted) + " m leave out up to " +
                          to_text(std::round(missed)) + " m of the grid's sea floor, at " +
                          to_text(std::round(missed_at)) +
                          " m; without --step they follow the grid");
  return track;
}

}  // namespace asdic::detail::climatology
