// Water and sea floor along a great circle.
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "io/climatology/climatology.h"
#include "io/climatology/grids.h"
#include "raytrace/ocean/seawater.h"
#include "raytrace/ocean/sound_speed.h"

namespace asdic::detail {
namespace {

using namespace climatology;

/// Speed of sound at depths [m], in the way of scenarios of temperature and salinity: PCHIP between
/// measured levels, the last one's water going on below.
std::vector<double> speeds_of(const Column& column, const std::vector<double>& depths,
                              double latitude) {
  std::vector<double> z, c;
  const auto add = [&](double depth, std::size_t level) {
    z.push_back(depth);
    c.push_back(sound_speed(SeawaterEquation::chen_millero, column.temperature[level],
                            column.salinity[level], depth, latitude));
  };
  if (column.depth.front() > 0.0) add(0.0, 0);
  for (std::size_t level = 0; level < column.depth.size(); ++level) add(column.depth[level], level);
  while (z.back() < depths.back()) add(z.back() + 250.0, column.depth.size() - 1);
  const auto profile = SoundSpeedProfile::table(z, c, Interpolation::pchip);
  std::vector<double> speed;
  speed.reserve(depths.size());
  for (const double depth : depths) speed.push_back(profile.at(depth).c);
  return speed;
}

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
  return levels;
}

/// A place on the sphere at a distance [m] along a great circle: the direct problem,
/// sin φ₂ = sin φ cos δ + cos φ sin δ cos θ.
struct Place {
  double latitude, longitude;  // [°]

  [[nodiscard]] Place at(double distance, double bearing_deg) const {
    const double phi = radians(latitude), theta = radians(bearing_deg);
    const double delta = distance / earth_radius;
    const double sine =
        std::sin(phi) * std::cos(delta) + std::cos(phi) * std::sin(delta) * std::cos(theta);
    const double turn = std::atan2(std::sin(theta) * std::sin(delta) * std::cos(phi),
                                   std::cos(delta) - std::sin(phi) * sine);
    return {degrees(std::asin(std::clamp(sine, -1.0, 1.0))), longitude + degrees(turn)};
  }
};

/// Profiles in the middle of the spans that they are nearest to.
void read_stations(const Hydrography& hydrography, const Place& start, OceanSection& section) {
  struct Segment {
    Column column;
    double first, last, latitude;
  };
  std::vector<Segment> segments;
  for (const double r : section.range) {
    const Place here = start.at(r, section.bearing_deg);
    Column column = hydrography.at(here.latitude, here.longitude);
    if (column.depth.empty()) continue;  // land in the grid: the neighbours' water goes on
    if (!segments.empty() && column == segments.back().column)
      segments.back().last = r;
    else
      segments.push_back({std::move(column), r, r, here.latitude});
  }
  const double deepest = *std::max_element(section.floor.begin(), section.floor.end());
  section.depth = levels_down_to(deepest, hydrography.levels());
  for (const Segment& segment : segments) {
    section.station.push_back(0.5 * (segment.first + segment.last));
    const auto speed = speeds_of(segment.column, section.depth, segment.latitude);
    section.speed.insert(section.speed.end(), speed.begin(), speed.end());
  }
}

}  // namespace

OceanSection sample_section(const OceanSources& sources, double latitude, double longitude,
                            double bearing_deg, double range, std::optional<int> month) {
  check_place(latitude, longitude);
  if (!(range > 0.0 && range <= pi * earth_radius))
    throw InputError({.where = "range",
                      .got = to_text(range) + " m",
                      .expected = "a range above 0 and at most half way round the Earth"});
  const Bathymetry bathymetry(sources.bathymetry);
  OceanSection section{.bearing_deg = bearing_deg};
  const Place start{latitude, longitude};
  const int steps = std::max(1, static_cast<int>(std::ceil(range / 5000.0)));
  for (int i = 0; i <= steps; ++i) {
    const double r = range * i / steps;
    const Place here = start.at(r, bearing_deg);
    const double depth = bathymetry.between(here.latitude, here.longitude);
    if (!(depth > 0.0)) {
      if (i == 0)
        throw InputError({.where = sources.bathymetry.string() + ": " + place(latitude, longitude),
                          .got = "no sea",
                          .expected = "a transect that starts at sea"});
      section.notes.push_back("the transect ends at the coast, before " + to_text(r) + " m");
      break;
    }
    section.range.push_back(r);
    section.floor.push_back(depth);
  }
  std::vector<std::string> told_with_the_profile;
  read_stations(Hydrography(sources.hydrography, month, told_with_the_profile), start, section);
  return section;
}

}  // namespace asdic::detail
