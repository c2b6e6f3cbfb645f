#include "io/ping/tables.h"

namespace asdic::detail::ping_file {
namespace {

using Type = ElementType;

}  // namespace

std::vector<GrowingTable::Column> echo_columns() {
  return {
      {"ping", "number of the ping", "", Type::int32},
      {"target", "number of the target", "", Type::int32},
      {"array", "number of the array", "", Type::int32},
      {"channel", "number of the array's phone, -1: the reference point", "", Type::int32},
      {"highlight", "number of the target's highlight, -1: a point", "", Type::int32},
      {"outgoing", "path of the leg source to target", "", Type::int32},
      {"returning", "path of the leg target to array", "", Type::int32},
      {"delay", "from the start of the ping to the echo's leading edge", "s"},
      {"struck", "from the start of the ping to when that edge meets the target", "s"},
      {"doppler_factor", "received over transmitted frequency", ""},
      {"level_db", "peak envelope over sqrt 2, pulse not windowed", "dB", Type::float64, cf::level},
      {"arrival_elevation_deg", "elevation of travel at the array, positive up", "degree"},
      {"arrival_bearing_deg", "of travel at the array, true (clockwise from north)", "degree"}};
}

std::vector<GrowingTable::Column> patch_columns(bool on_earth) {
  std::vector<GrowingTable::Column> columns = {
      {"ping", "number of the ping", "", Type::int32},
      {"boundary", "0 surface, 1 bottom, 2 volume", "", Type::int8},
      {"bearing_deg", "of the sector, true (clockwise from north); NaN: the whole ring", "degree"},
      {"range", "of the cell's centre from the point of the lattice that cells hang on", "m"},
      {"area", "of the ring, or of this sector and its mirror image", "m2"},
      {"delay", "there and back", "s"},
      {"grazing_in_deg", "angle at which sound comes to the surface", "degree"},
      {"grazing_out_deg", "angle at which sound leaves the surface", "degree"},
      {"launch_elevation_deg", "of the outgoing path, positive up", "degree"},
      {"arrival_elevation_deg", "of travel at the array, positive up", "degree"},
      {"scattering_strength_db",
       "of this pair of angles",
       "dB",
       Type::float64,
       {.reference = "1 of a boundary, 1/m of the volume"}},
      {"level_db", "expected, of that area, pulse not windowed", "dB", Type::float64,
       cf::pressure_level}};
  if (!on_earth) return columns;
  columns.push_back({"latitude", "latitude of the cell's centre; NaN: the whole ring",
                     "degrees_north", Type::float64, cf::latitude});
  columns.push_back({"longitude", "longitude of the cell's centre; NaN: the whole ring",
                     "degrees_east", Type::float64, cf::longitude});
  return columns;
}

std::vector<GrowingTable::Column> interference_columns() {
  return {{"ping", "number of the ping", "", Type::int32},
          {"interferer", "number of the ship", "", Type::int32},
          {"array", "number of the array", "", Type::int32},
          {"delay", "since it left the ship, at the record's first sample", "s"},
          {"doppler_factor", "received over transmitted frequency", ""},
          {"range", "from where the ship was, horizontal", "m"},
          {"bearing_deg", "of travel at the array, true (clockwise from north)", "degree"},
          {"launch_elevation_deg", "at the ship, positive up", "degree"},
          {"arrival_elevation_deg", "of travel at the array, positive up", "degree"},
          {"amplitude_real", "re 1 m", ""},
          {"amplitude_imag", "re 1 m", ""},
          {"surface_bounces", "reflections at the surface", "", Type::int32},
          {"bottom_bounces", "reflections at the bottom", "", Type::int32}};
}

}  // namespace asdic::detail::ping_file
