#include "io/ping/arrival_table.h"

#include <cmath>

#include "core/units.h"

namespace asdic::detail {
namespace {

using Type = ElementType;

std::vector<GrowingTable::Column> arrival_columns(bool on_earth) {
  std::vector<GrowingTable::Column> all = {
      {"ping", "number of the ping", "", Type::int32},
      {"leg", "0 source to target, 1 target to array, 2 source to array, 3 source to receiver", "",
       Type::int32},
      {"target", "number of the target, -1: none", "", Type::int32},
      {"array", "number of the array, -1: none", "", Type::int32},
      {"channel", "number of the array's phone, -1: the reference point", "", Type::int32},
      {"path", "number within its leg", "", Type::int32},
      {"bearing_deg", "of the line from start to end, true (clockwise from north)", "degree"},
      {"range", "horizontal distance of the leg", "m"},
      {"launch_elevation_deg", "elevation of travel at the start, positive up", "degree"},
      {"arrival_elevation_deg", "elevation of travel at the end, positive up", "degree"},
      {"launch_deflection_deg", "of travel at the start, clockwise from bearing_deg", "degree"},
      {"arrival_deflection_deg", "of travel at the end, clockwise from bearing_deg", "degree"},
      {"delay", "travel time", "s"},
      {"amplitude_real", "pressure re 1 m, real part", ""},
      {"amplitude_imag", "pressure re 1 m, imaginary part", ""},
      {"spreading_db", "spreading loss", "dB"},
      {"absorption_db", "absorption loss", "dB"},
      {"scattered", "mean intensity that rough boundaries scatter about the path, re 1 m", ""},
      {"path_length", "length along the ray", "m"},
      {"surface_bounces", "reflections at the surface", "", Type::int32},
      {"bottom_bounces", "reflections at the bottom", "", Type::int32},
      {"upper_turns", "turning points below the surface", "", Type::int32},
      {"lower_turns", "turning points above the bottom", "", Type::int32},
      {"caustics", "caustics passed", "", Type::int32},
      {"kind", "0 a ray, 1 diffracted: where no ray comes, 2 with the amplitude of waves", "",
       Type::int8},
      {"first_bounce", "first row of /bounces, -1: none", "", Type::int32},
      {"bounce_count", "rows of /bounces", "", Type::int32}};
  if (on_earth)
    all.insert(all.end(), {{"latitude", "latitude of the leg's end", "degrees_north", Type::float64,
                            cf::latitude},
                           {"longitude", "longitude of the leg's end", "degrees_east",
                            Type::float64, cf::longitude}});
  return all;
}

std::vector<GrowingTable::Column> bounce_columns() {
  return {{"boundary", "0 surface, 1 bottom", "", Type::int8},
          {"grazing_deg", "angle between ray and boundary", "degree"},
          {"range", "horizontal distance from the start of the leg", "m"}};
}

}  // namespace

ArrivalTable::ArrivalTable(Hdf5File& file, const EarthPlaces& earth)
    : earth_(earth),
      arrivals_(file, "arrivals", "arrival", arrival_columns(earth.known())),
      bounces_(file, "bounces", "bounce", bounce_columns()) {}

void ArrivalTable::add(int ping, const Leg& leg) {
  const GeographicPlace end = earth_.at(leg.end.x(), leg.end.y());
  for (std::size_t i = 0; i < leg.arrivals.size(); ++i) {
    const Arrival& a = leg.arrivals[i];
    const double first = a.bounces.empty() ? -1.0 : static_cast<double>(bounces_.rows());
    for (const Bounce& bounce : a.bounces)
      bounces_.row({bounce.boundary == BoundaryKind::surface ? 0.0 : 1.0, degrees(bounce.grazing),
                    bounce.range});
    std::vector<double> cells = {double(ping),
                                 double(static_cast<int>(leg.kind)),
                                 double(leg.target),
                                 double(leg.array),
                                 double(leg.channel),
                                 static_cast<double>(i),
                                 compass_degrees(leg.bearing),
                                 leg.range,
                                 degrees(a.launch_elevation),
                                 degrees(a.arrival_elevation),
                                 degrees(a.launch_deflection),
                                 degrees(a.arrival_deflection),
                                 a.delay,
                                 a.amplitude.real(),
                                 a.amplitude.imag(),
                                 -db_from_amplitude(a.spreading),
                                 a.absorption_db,
                                 a.scattered,
                                 a.path_length,
                                 double(a.surface_bounces),
                                 double(a.bottom_bounces),
                                 double(a.upper_turns),
                                 double(a.lower_turns),
                                 double(a.caustics),
                                 double(static_cast<int>(a.kind)),
                                 first,
                                 static_cast<double>(a.bounces.size())};
    if (earth_.known()) cells.insert(cells.end(), {end.latitude, end.longitude});
    arrivals_.row(cells);
  }
}

void ArrivalTable::write() {
  arrivals_.write();
  bounces_.write();
}

}  // namespace asdic::detail
