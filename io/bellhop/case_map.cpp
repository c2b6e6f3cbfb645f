// Part of case_parts.h: cases of BELLHOP3D, over a map.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/units.h"
#include "io/bellhop/case_parts.h"
#include "raytrace/area/area.h"

namespace asdic::detail::bellhop {
namespace {

constexpr std::int64_t most_map_places = 1'000'000;

/// Skips a count and its vector.
void skip_vector(ListReader& env) {
  env.begin("number");
  const std::int64_t n = env.need_integer("", 1, most_map_places);
  env.end();
  static_cast<void>(read_vector(env, n, "vector"));
}

std::vector<double> read_places(CaseReading& reading, const std::string& who, float factor,
                                const char* unit, double most) {
  ListReader& env = reading.env;
  env.begin("number of " + who);
  const std::int64_t n = env.need_integer("", 1, most_map_places);
  env.end();
  const GivenVector given = read_vector(env, n, who);
  for (const double value : given.values)
    if (!(std::abs(value) <= most))
      env.fail(who, shown(value) + unit,
               "a value from " + shown(-most) + " to " + shown(most) + unit);
  bool sorted = false;
  std::vector<double> places = single_precision(given, factor, sorted);
  if (sorted) reading.note(env.where("") + ": sorted, ascending");
  return places;
}

std::shared_ptr<const MapGrid> in_memory(const GridFile& file) {
  const std::size_t levels = std::max<std::size_t>(file.z.size(), 1);
  const std::size_t columns = file.x.size(), layer = columns * file.y.size();
  auto values = std::make_shared<std::vector<float>>(file.values.begin(), file.values.end());
  return std::make_shared<const MapGrid>(
      MapAxis("x", file.x), MapAxis("y", file.y), levels,
      [=](const MapGrid::Window& window, std::span<float> out) {
        std::size_t next = 0;
        for (std::size_t j = window.row; j < window.row + window.rows; ++j)
          for (std::size_t i = window.column; i < window.column + window.columns; ++i)
            for (std::size_t k = 0; k < levels; ++k)
              out[next++] = (*values)[k * layer + j * columns + i];
      });
}

bool is_level(const GridFile& grid) {
  return std::all_of(grid.values.begin(), grid.values.end(),
                     [&](double z) { return z == grid.values.front(); });
}

/// Whether a grid holds a place. [m]
bool grid_holds(const GridFile& grid, double x, double y) {
  return x >= grid.x.front() && x <= grid.x.back() && y >= grid.y.front() && y <= grid.y.back();
}

void check_grid_depths(const CaseReading& reading, const std::string& file, const GridFile& grid,
                       bool surface) {
  for (std::size_t i = 0; i < grid.values.size(); ++i) {
    const double z = grid.values[i];
    const bool wrong = surface ? z < reading.surface_depth : z > reading.bottom_depth;
    if (!wrong) continue;
    throw InputError(
        {.where = file + ": depth at x = " + shown(grid.x[i % grid.x.size()] / 1000.0) +
                  " km, y = " + shown(grid.y[i / grid.x.size()] / 1000.0) + " km",
         .got = shown(z) + " m",
         .expected =
             surface
                 ? "not above the profile, which begins at " + shown(reading.surface_depth) + " m"
                 : "not below the profile, which ends at " + shown(reading.bottom_depth) + " m"});
  }
}

void check_sources_on_grid(const CaseReading& reading, const std::string& file,
                           const GridFile& grid) {
  const MapInput& map = *reading.input.map;
  for (const double x : map.source_x)
    for (const double y : map.source_y)
      if (!grid_holds(grid, x, y))
        throw InputError(
            {.where = file,
             .got = "a grid that does not reach the source at x = " + shown(x / 1000.0) +
                    " km, y = " + shown(y / 1000.0) + " km",
             .expected = "one that goes from x = " + shown(grid.x.front() / 1000.0) + " to " +
                         shown(grid.x.back() / 1000.0) + " km and y = " +
                         shown(grid.y.front() / 1000.0) + " to " + shown(grid.y.back() / 1000.0) +
                         " km to hold all sources: its edge is not drawn on for them"});
}

ScalarMap surface_of(const GridFile& grid, const MapFrame& frame, const std::string& name) {
  return {in_memory(grid),
          frame,
          grid.curvilinear ? MapInterpolation::bicubic : MapInterpolation::faceted,
          1.0,
          {name}};
}

/// A sea floor of one depth under a volume of water.
GridFile level_floor(const GridFile& water, double depth) {
  return {.x = {water.x.front(), water.x.back()},
          .y = {water.y.front(), water.y.back()},
          .values = std::vector<double>(4, depth)};
}

/// A grid of as many x as y fits turned, too, and no document tells which way it stands.
void note_order(CaseReading& reading, const std::string& file, const GridFile& grid) {
  const std::size_t n = grid.x.size();
  if (grid.y.size() != n) return;
  bool turned_alike = grid.x == grid.y;
  for (std::size_t j = 0; turned_alike && j < n; ++j)
    for (std::size_t i = 0; i < j; ++i)
      turned_alike = turned_alike && grid.values[j * n + i] == grid.values[i * n + j];
  if (!turned_alike)
    reading.note(file +
                 ": a row of depths is taken for one y, and its numbers for the x; no document "
                 "tells whether BELLHOP3D does so, and this grid would fit the other way, too");
}

void read_altimetry(CaseReading& reading) {
  MapInput& map = *reading.input.map;
  const std::string file = reading.root + ".ati";
  map.altimetry = read_grid_file(reading.companion(".ati", "~"), false);
  check_grid_depths(reading, file, *map.altimetry, true);
  if (is_level(*map.altimetry)) {
    reading.ocean().surface.depth = map.altimetry->values.front();
    return;
  }
  note_order(reading, file, *map.altimetry);
  check_sources_on_grid(reading, file, *map.altimetry);
}

void read_bathymetry(CaseReading& reading) {
  MapInput& map = *reading.input.map;
  const std::string file = reading.root + ".bty";
  map.bathymetry = read_grid_file(reading.companion(".bty", "~"), false);
  check_grid_depths(reading, file, *map.bathymetry, false);
  if (is_level(*map.bathymetry)) {
    reading.ocean().bottom.depth = map.bathymetry->values.front();
    return;
  }
  check_sources_on_grid(reading, file, *map.bathymetry);
  note_order(reading, file, *map.bathymetry);
  if (map.bathymetry->curvilinear)
    reading.note(file +
                 ": type C is a bicubic surface through the depths here; BELLHOP3D is "
                 "taken to keep facets and to let their normals change across them");
  else
    reading.note(file +
                 ": type R is two triangles a cell here, parted from its corner of least x "
                 "and y to that across; no document says which diagonal BELLHOP3D takes");
  std::size_t dry = 0;
  for (const double z : map.bathymetry->values) dry += z <= reading.ocean().surface.depth ? 1 : 0;
  if (dry > 0)
    reading.note(file + ": " + std::to_string(dry) + " of " +
                 std::to_string(map.bathymetry->values.size()) +
                 " depths are at or above the surface: land, where sound ends");
}

void read_water(CaseReading& reading) {
  MapInput& map = *reading.input.map;
  const std::string file = reading.root + ".ssp";
  map.water = read_grid_file(reading.companion(".ssp", "H"), true);
  check_sources_on_grid(reading, file, *map.water);
  reading.note(file +
               ": a row of speeds is taken for one y of one depth, and its numbers for the x, all "
               "rows of a depth together; no document tells whether BELLHOP3D does so");
  reading.note(
      file +
      ": speeds run as cubics between the places of the grid, so that gradients are "
      "continuous; BELLHOP3D's are taken to be linear along each axis (H), which differs the "
      "less the finer the grid is");
  reading.note(reading.env.file() + ": the speeds of its profile mean nothing beside " + file +
               "; its densities and attenuations count");
}

/// The map's [0, 0] is the first source.
MapFrame frame_of(const MapInput& map) {
  return MapFrame::projected(map.source_x.front(), map.source_y.front());
}

void build_area(CaseReading& reading) {
  MapInput& map = *reading.input.map;
  Environment& ocean = reading.ocean();
  const bool relief = map.altimetry && !is_level(*map.altimetry);
  const bool slopes = map.bathymetry && !is_level(*map.bathymetry);
  if (!relief && !slopes && !map.water) return;
  if (relief && reading.run_case().dimension == 3)
    throw InputError({.where = reading.root + ".ati",
                      .got = "a surface with relief in a three-dimensional run",
                      .expected = "one depth everywhere, or run type letter 6 \"2\": rays in three "
                                  "dimensions know a flat surface only"});
  if (reading.run_case().dimension == 2) ocean.spreading = Spreading::cylindrical;
  const MapFrame frame = frame_of(map);
  if (relief) {
    Environment above = ocean;
    above.surface.depth = -1e9;  // nothing of it is land
    map.relief = std::make_shared<const Area>(
        Area::Maps{.floor = surface_of(*map.altimetry, frame, reading.root + ".ati")}, above);
  }
  const GridFile floor =
      slopes ? *map.bathymetry
             : level_floor(map.water ? *map.water : *map.altimetry, ocean.bottom.depth);
  Area::Maps maps{.floor = surface_of(floor, frame, reading.root + ".bty")};
  if (map.water)
    maps.water.emplace(in_memory(*map.water), frame, map.water->z,
                       MapOrigin{reading.root + ".ssp"});
  map.area = std::make_shared<const Area>(std::move(maps), ocean);
}

Vec2 place_of(const MapInput& map, std::size_t plane) {
  const std::size_t source = plane / map.azimuths_deg.size();
  return {map.source_x[source / map.source_y.size()] - map.source_x.front(),
          map.source_y[source % map.source_y.size()] - map.source_y.front()};
}

/// Clockwise from north [rad].
double bearing_of(double azimuth_deg) { return radians(90.0 - azimuth_deg); }

/// The map ends before the receivers do.
void note_short_map(CaseReading& reading) {
  const MapInput& map = *reading.input.map;
  const double last = reading.run_case().receivers.ranges.back();
  const auto beyond = [&](const GridFile& grid) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < map.planes(); ++i) {
      const Vec2 place = place_of(map, i);
      const double bearing = bearing_of(map.azimuth_deg(i));
      n += grid_holds(grid, map.source_x.front() + place.x() + last * std::sin(bearing),
                      map.source_y.front() + place.y() + last * std::cos(bearing))
               ? 0
               : 1;
    }
    return n;
  };
  for (const auto& [grid, ending] : {std::pair{&map.bathymetry, ".bty"}, {&map.water, ".ssp"}}) {
    if (!*grid) continue;
    if (const std::size_t n = beyond(**grid); n > 0)
      reading.note(reading.root + ending + ": on " + std::to_string(n) + " of " +
                   std::to_string(map.planes()) +
                   " azimuths receivers are beyond its grid, whose edge goes on there (BELLHOP3D "
                   "is taken to end its rays)");
  }
}

void note_azimuths(CaseReading& reading) {
  const MapInput& map = *reading.input.map;
  if (map.fan == 1) reading.note("a fan of one azimuth: taken for a source that shines all around");
  std::size_t dark = 0;
  for (const double azimuth : map.azimuths_deg) dark += map.shines_at(azimuth) ? 0 : 1;
  if (dark > 0 && reading.run_case().dimension == 3)
    reading.note(std::to_string(dark) + " of " + std::to_string(map.azimuths_deg.size()) +
                 " azimuths of receivers lie outside of the fan of azimuths: only what is turned "
                 "there out of the fan comes");
  if (dark > 0 && reading.run_case().dimension == 2)
    reading.note(std::to_string(dark) + " of " + std::to_string(map.azimuths_deg.size()) +
                 " azimuths of receivers lie outside of the fan of azimuths, which means nothing "
                 "where every plane is a run of its own (run type letter 6 \"2\")");
}

/// Of the box as the source has it about itself, along an azimuth [m].
double box_along(const MapInput& map, double azimuth_deg) {
  const double x = std::abs(std::cos(radians(azimuth_deg))),
               y = std::abs(std::sin(radians(azimuth_deg)));
  return std::min(x > 1e-9 ? map.box_x / x : infinity, y > 1e-9 ? map.box_y / y : infinity);
}

}  // namespace

bool MapInput::shines_all_around() const noexcept {
  return fan == 1 || highest_azimuth_deg - lowest_azimuth_deg + 2.0 * margin_deg() >= 360.0;
}

double MapInput::margin_deg() const noexcept {
  return fan > 1 ? 0.5 * (highest_azimuth_deg - lowest_azimuth_deg) / double(fan - 1) : 0.0;
}

bool MapInput::shines_at(double azimuth_deg) const noexcept {
  if (shines_all_around()) return true;
  const double spread = highest_azimuth_deg - lowest_azimuth_deg;
  const double from_middle =
      std::remainder(azimuth_deg - 0.5 * (lowest_azimuth_deg + highest_azimuth_deg), 360.0);
  return std::abs(from_middle) <= 0.5 * spread + margin_deg() + 1e-9;
}

bool is_over_map(const CaseReading& reading) {
  ListReader env = reading.env;
  try {
    env.begin("bottom options");
    std::string letters;
    if (!env.text(letters, "")) return false;
    env.end();
    if (!letters.empty() && (letters[0] == 'A' || letters[0] == 'G')) {
      env.begin("half space");
      double ignored = 0.0;
      for (int i = 0; i < (letters[0] == 'A' ? 6 : 2); ++i) env.real(ignored, "");
      env.end();
    }
    for (int i = 0; i < 3; ++i) skip_vector(env);
  } catch (const InputError&) {  // told when it is read
    return reading.options.profile == 'H';
  }
  try {
    env.begin("run type, or a fourth vector");
    return env.need_integer("", 1, most_map_places) > 0;
  } catch (const InputError&) {
    return false;
  }
}

void require_profile_of_a_plane(const CaseReading& reading) {
  if (reading.options.profile == 'H')
    throw InputError({.where = reading.env.file() + ": top options: letter 1",
                      .got = "\"H\", a volume of water, in a case of one plane",
                      .expected = "\"Q\" for water that varies with range; or the six vectors of "
                                  "BELLHOP3D: source x, y and depths, receiver depths, ranges and "
                                  "azimuths"});
}

void check_map_run(CaseReading& reading, const std::string& letters) {
  ListReader& env = reading.env;
  PropagationCase& run_case = reading.run_case();
  const MapInput& map = *reading.input.map;
  run_case.dimension = letters[5] == '3' ? 3 : 2;
  if (letters[5] != '2' && letters[5] != '3' && letters[5] != ' ')
    reading.note("run type, letter 6: " + shown(letters.substr(5, 1)) +
                 " means nothing; 2, a run in every plane");
  const bool drawn = run_case.task != Task::arrivals && run_case.task != Task::field;
  if (drawn && run_case.dimension == 3)
    env.fail(
        "letter 6", "\"3\" in a run that draws rays",
        "2: rays are drawn in planes; arrivals (A, a) and fields (C, I) go in three dimensions");
  if (drawn && map.planes() > 1)
    env.fail("letter 1",
             shown(letters.substr(0, 1)) + " in " + std::to_string(map.planes()) + " planes",
             "one source place and one azimuth: a .ray file holds one plane");
  if (letters[0] == 'S' && run_case.dimension == 3)
    env.fail("letter 1", "\"S\" in three dimensions", "C or I, or letter 6 \"2\"");
  if (std::string_view("CRS").find(letters[1]) < 3)
    env.fail("letter 2", shown(letters.substr(1, 1)),
             "G, g, B or b: what BELLHOP3D has, over a map");
  if (letters[3] == 'X')
    env.fail("letter 4", "\"X\"", "R, a point source: a line makes no sense over a map");
}

void read_map_case(CaseReading& reading) {
  ListReader& env = reading.env;
  if (reading.options.profile == 'Q')
    throw InputError({.where = env.file() + ": top options: letter 1",
                      .got = "\"Q\", water along one plane, in a case over a map",
                      .expected = "\"H\", over map and depth, or a profile"});
  if (reading.options.single_beam)
    throw InputError({.where = env.file() + ": top options: letter 6",
                      .got = "\"I\", a single beam, in a case over a map",
                      .expected = "a blank"});
  reading.input.map.emplace();
  MapInput& map = *reading.input.map;
  map.profile_top = reading.ocean().surface.depth;
  map.profile_depth = reading.bottom_depth;
  read_bottom_options(reading);
  map.source_x = read_places(reading, "source x", 1000.0F, " km", 1e6);
  map.source_y = read_places(reading, "source y", 1000.0F, " km", 1e6);
  read_receivers(reading);
  map.azimuths_deg = read_places(reading, "receiver azimuths", 1.0F, " degrees", 720.0);
  read_run(reading);
  if (reading.options.altimetry) read_altimetry(reading);
  if (reading.options.bathymetry) read_bathymetry(reading);
  if (reading.options.profile == 'H') read_water(reading);
  build_area(reading);
  reading.note(std::string("a case of BELLHOP3D: x is east and y north; azimuths are "
                           "counter-clockwise from x, so that a bearing is 90 degrees less the "
                           "azimuth; ") +
               (reading.run_case().dimension == 3 ? "rays in three dimensions"
                                                  : "a run in the plane of every azimuth (Nx2D)"));
  if (reading.run_case().dimension == 3 && map.area)
    reading.note(
        "three dimensions take from a tenth of a second to minutes a receiver, most over "
        "facets and under profiles of several rows; planes (run type letter 6 \"2\") a "
        "fraction of that");
  note_short_map(reading);
  note_azimuths(reading);
  reading.run_case() = on_plane(reading.input, 0);
}

PropagationCase on_plane(const Input& input, std::size_t plane) {
  PropagationCase run_case = input.run_case;
  if (!input.map) return run_case;
  const MapInput& map = *input.map;
  const double azimuth = map.azimuth_deg(plane);
  run_case.box_range = box_along(map, azimuth);
  if (!map.area) return run_case;
  const Vec2 place = place_of(map, plane);
  const double bearing = bearing_of(azimuth), last = run_case.receivers.ranges.back();
  const double reach =
      run_case.task == Task::rays ? run_case.box_range : std::min(run_case.box_range, 1.5 * last);
  run_case.environment = map.area->section(place, bearing, std::max(reach, last));
  if (map.relief) {
    const Boundary surface = map.relief->section(place, bearing, std::max(reach, last)).bottom;
    run_case.environment.surface.depth = surface.depth;
    run_case.environment.surface.shape = surface.shape;
  }
  if (run_case.dimension == 2) return run_case;
  run_case.on_area = {.area = map.area, .place = place, .bearing = bearing};
  return run_case;
}

}  // namespace asdic::detail::bellhop
