#include "io/scenario/area.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/quantities.h"
#include "core/text.h"
#include "io/climatology/map_reader.h"
#include "io/scenario/materials/materials.h"
#include "io/settings/reader.h"

namespace asdic::detail::scenario {
namespace {

/// A map in a file.
struct MapTable {
  MapFile map = {};

  void describe(Fields& field) {
    field.file(required("file"), map.file, "a readable netCDF file or raster", "with the map");
    field(by_default("variable", "by its standard_name or a usual name"), map.variable,
          "its name in the file");
  }
};

/// [environment.area.bathymetry]
struct BathymetryTable {
  MapTable map = {};
  MapInterpolation interpolation = MapInterpolation::bicubic;
  double water_level = 0.0;

  void describe(Fields& field) {
    constexpr Quantity level{.noun = "height", .unit = "m", .low = -50.0, .high = 50.0};
    map.describe(field);
    field("interpolation", interpolation, "how the floor runs between the places of the grid");
    field(seldom("water_level"), water_level, level, "of the sea over the datum of the depths");
  }
};

/// [[environment.area.seabed.class]]
struct ClassTable {
  int number = 0;
  std::string name = {};
  AnyMaterialForm form = {};

  void describe(Fields& field) {
    field(required("number"), number, -1'000'000, 1'000'000, "in the map");
    field(seldom("name"), name, "of the kind of sea floor");
    field.one_of(required("kind"), form, "what is behind the boundary");
  }
};

/// [environment.area.seabed]
struct SeabedTable {
  MapTable map = {};
  std::vector<ClassTable> classes = {};

  void describe(Fields& field) {
    map.describe(field);
    field("class", classes, "what a number of the map stands for");
    if (field.checks() && classes.empty())
      field.fault("class", "[[environment.area.seabed.class]] for every number", "none");
  }
};

/// [environment.area], but for the kinds of sea floor where it is read.
struct AreaTable {
  double easting = 0.0, northing = 0.0;
  BathymetryTable bathymetry = {};
  std::optional<MapTable> sound_speed = {};
  std::optional<SeabedTable> seabed = {};
  std::optional<MapTable> wind = {};

  void describe(Fields& field) {
    constexpr Quantity axis{.noun = "coordinate", .unit = "m", .low = -1e8, .high = 1e8};
    field(seldom("easting"), easting, axis, "of the map's [0, 0] on projected grids");
    field(seldom("northing"), northing, axis, "of the map's [0, 0] on projected grids");
    field(required("bathymetry"), bathymetry, "depth of the sea floor over the map");
    field("sound_speed", sound_speed, "over depth and map");
    field("seabed", seabed, "the kind of sea floor, by number");
    field("wind", wind, "at 10 m height [m/s]");
  }
};

AreaTable table_of(const AreaSettings& settings) {
  AreaTable table{.easting = settings.easting, .northing = settings.northing};
  table.bathymetry = {{settings.bathymetry}, settings.interpolation, settings.water_level};
  if (settings.sound_speed) table.sound_speed = MapTable{*settings.sound_speed};
  if (settings.seabed) {
    table.seabed = SeabedTable{{*settings.seabed}, {}};
    for (const SeabedClass& one : settings.classes) {
      ClassTable& shown = table.seabed->classes.emplace_back(ClassTable{one.number, one.name});
      find_form(one.material, shown.form);
    }
  }
  if (settings.wind) table.wind = MapTable{*settings.wind};
  return table;
}

/// Whether maps lie where the others do, as far as their files tell how they are projected.
class PlacesOfMaps {
 public:
  PlacesOfMaps(const AreaSettings& settings) : settings_(&settings) {}

  /// \return a fault: what was found, what was expected; {}: none
  struct Fault {
    std::string got, expected;
  };
  [[nodiscard]] std::optional<Fault> of(const OpenedMap& map) {
    (map.geographic ? geographic_ : projected_) |= true;
    const std::string& projection = map.file->projection();
    if (!projection.empty()) {
      if (!first_) first_ = map;
      if (first_->file->projection() != projection)
        return Fault{map.name + " in " + map.file->projection_name() + ", " + first_->name +
                         " in " + first_->file->projection_name(),
                     "maps of one projection: \"gdalwarp -t_srs\" makes such"};
    }
    if (!first_ || !settings_->origin) return {};
    const double x = settings_->easting, y = settings_->northing;
    const MapFrame frame = MapFrame::geographic(*settings_->origin);
    const auto off = [&](double east, double north) {
      const auto there = first_->file->on_earth(x + east, y + north);
      return there ? (frame.on_map(there->longitude, there->latitude) - Vec2(east, north)).norm()
                   : 0.0;
    };
    if (const double away = off(0.0, 0.0); away > nearby) {
      const auto there = *first_->file->on_earth(x, y);
      return Fault{"[0, 0] in two places " + kilometres(away) + " apart: at " +
                       degrees_text(settings_->origin->latitude, settings_->origin->longitude) +
                       " by [environment.origin], at " +
                       degrees_text(there.latitude, there.longitude) +
                       " by easting and northing (" + first_->name + ", " +
                       first_->file->projection_name() + ")",
                   "one place"};
    }
    if (!geographic_ || !projected_) return {};
    const double turned = std::max(off(baseline, 0.0), off(0.0, baseline));
    if (turned > nearby)
      return Fault{"maps in degrees and one in " + first_->file->projection_name() + ", " +
                       first_->name + ", that part by " + kilometres(turned) + " " +
                       kilometres(baseline) + " from [0, 0]",
                   "all in degrees or all in one projection: \"gdalwarp -t_srs\" makes such"};
    return {};
  }

 private:
  static constexpr double nearby = 100.0, baseline = 10e3;  // [m]
  static std::string kilometres(double metres) {
    return to_text(std::round(metres / 10.0) / 100.0) + " km";
  }
  static std::string degrees_text(double latitude, double longitude) {
    return climatology::place(std::round(1e5 * latitude) / 1e5, std::round(1e5 * longitude) / 1e5);
  }

  const AreaSettings* settings_;
  std::optional<OpenedMap> first_;  // whose projection is known
  bool geographic_ = false, projected_ = false;
};

}  // namespace

AreaReading::AreaReading(TomlTable table, const OceanReading& reading,
                         const std::optional<OceanOrigin>& of_map)
    : table_(std::move(table)), reading_(reading) {
  KnownSettings known{.numbers = {{"frequency", reading.frequency},
                                  {"water.speed", 1500.0},
                                  {"water.density", 1025.0}},
                      .folder = reading.folder};
  AreaTable form;
  TomlReader reader(table_, known);
  form.describe(reader);
  std::optional<GeographicPlace> origin;
  if (of_map) origin = {degrees(of_map->latitude), degrees(of_map->longitude)};
  settings_ = {.origin = origin,
               .easting = form.easting,
               .northing = form.northing,
               .bathymetry = form.bathymetry.map.map,
               .interpolation = form.bathymetry.interpolation,
               .water_level = form.bathymetry.water_level};
  if (form.sound_speed) settings_.sound_speed = form.sound_speed->map;
  if (form.seabed) settings_.seabed = form.seabed->map.map;
  if (form.wind) settings_.wind = form.wind->map;

  PlacesOfMaps places(settings_);
  const auto check_place = [&](const OpenedMap& opened, const char* key) {
    if (const auto wrong = places.of(opened)) throw table_.fault(key, wrong->expected, wrong->got);
  };
  const auto open = [&](const MapFile& map, const climatology::GriddedQuantity& quantity,
                        const char* key, bool volume) {
    OpenedMap opened = open_map(reading.folder / map.file, map.variable, quantity,
                                origin ? origin->longitude : 0.0, reading_.notes);
    if (opened.geographic && !origin)
      throw table_.fault(key,
                         "[environment.origin] with latitude_deg and longitude_deg, where the "
                         "map's [0, 0] is",
                         "a grid of longitude and latitude, " + opened.name);
    check_place(opened, key);
    if (opened.depths.empty() == volume)
      throw table_.fault(key, volume ? "a variable over depth and map" : "a map without depths",
                         opened.name);
    return opened;
  };
  const auto frame = [&](const OpenedMap& opened) {
    return opened.geographic ? MapFrame::geographic(*origin)
                             : MapFrame::projected(settings_.easting, settings_.northing);
  };
  const OpenedMap floor =
      open(settings_.bathymetry, climatology::bathymetry_quantity(), "bathymetry", false);
  floor_.emplace(floor.grid, frame(floor), settings_.interpolation, floor.depth_sign,
                 MapOrigin{floor.name}, settings_.water_level);
  if (origin && !floor.geographic)
    reading_.notes.push_back("environment.area: " + floor.name +
                             " is on projected axes, which may be turned against the meridian: "
                             "results have no latitudes and longitudes but those of "
                             "environment.origin");
  if (!floor_->covers(0.0, 0.0)) {
    const auto rounded = [](double degree) { return std::round(1e4 * degree) / 1e4; };
    throw table_.fault(
        "bathymetry",
        "a map that holds the scenario's [0, 0]: " +
            (floor.geographic
                 ? "[environment.origin] says that it is at " +
                       climatology::place(rounded(origin->latitude), rounded(origin->longitude))
                 : "environment.area.easting and environment.area.northing, now " +
                       to_text(settings_.easting) + " and " + to_text(settings_.northing) +
                       " m, say where it is on the grid"),
        floor.name + ", " + extent_text(*floor_, true));
  }
  if (settings_.sound_speed) {
    const OpenedMap water =
        open(*settings_.sound_speed, climatology::sound_speed_quantity(), "sound_speed", true);
    water_.emplace(water.grid, frame(water), water.depths, MapOrigin{water.name});
  }
  if (settings_.seabed) {
    const OpenedMap seabed =
        open(*settings_.seabed, climatology::sediment_quantity(), "seabed", false);
    seabed_.emplace(seabed.grid, frame(seabed), MapOrigin{seabed.name});
  }
  if (settings_.wind) {
    const OpenedMap wind = open(*settings_.wind, climatology::wind_speed_quantity(), "wind", false);
    wind_.emplace(wind.grid, frame(wind), MapInterpolation::faceted, 1.0, MapOrigin{wind.name});
  }
}

std::optional<double> AreaReading::wind_speed(double x, double y) const {
  if (!wind_) return std::nullopt;
  return wind_->at(x, y).value;
}

std::shared_ptr<const Area> AreaReading::build(const Environment& ocean, const Transect& transect) {
  std::map<int, BoundaryMaterial> materials;
  const double depth = ocean.bottom.depth;
  const WaterAtBoundary water{.speed = ocean.water.at(depth).c,
                              .density = ocean.water_density.at(depth)};
  if (settings_.seabed) {
    TomlTable seabed = table_.table("seabed");
    for (TomlTable& table : seabed.tables("class")) {
      KnownSettings known{.numbers = {{"frequency", reading_.frequency},
                                      {"water.speed", water.speed},
                                      {"water.density", water.density}},
                          .folder = reading_.folder};
      ClassTable one;
      TomlReader reader(table, known);
      one.describe(reader);
      const MaterialPlace place{table, reading_, water};
      const auto material = std::visit(
          [&](const auto& form) { return BoundaryMaterial(form.build(place)); }, one.form);
      if (!materials.emplace(one.number, material).second)
        throw table.fault("number", "a number that no other class has");
      settings_.classes.push_back({one.number, std::move(one.name), material});
    }
  }
  table_.finish();
  return std::make_shared<const Area>(Area::Maps{.floor = *floor_,
                                                 .water = water_,
                                                 .seabed = seabed_,
                                                 .materials = std::move(materials),
                                                 .wind = wind_},
                                      ocean, settings_, transect);
}

std::string extent_text(const ScalarMap& map, bool on_its_axes) {
  const MapAxis &across = map.grid().x(), &up = map.grid().y();
  const double half_u = 0.5 * across.mean_spacing(), half_v = 0.5 * up.mean_spacing();
  const MapFrame& frame = map.frame();
  const auto span = [](double begin, double end, double digits) {
    return to_text(std::round(digits * begin) / digits) + " to " +
           to_text(std::round(digits * end) / digits);
  };
  const double west = across.begin() - half_u, east = across.end() + half_u,
               south = up.begin() - half_v, north = up.end() + half_v;
  const auto metres = [&](const char* about, double x0, double x1, double y0, double y1) {
    return "x from " + std::string(about) + span(x0, x1, 1.0) + " m, y from " + about +
           span(y0, y1, 1.0) + " m";
  };
  if (!frame.is_geographic()) {
    if (on_its_axes) return metres("", west, east, south, north);
    const Vec2 a = frame.on_map(west, south), b = frame.on_map(east, north);
    return metres("", a.x(), b.x(), a.y(), b.y());
  }
  const std::string degrees = span(south, north, 1e4) + " N, " + span(west, east, 1e4) + " E";
  constexpr double wide = 20.0;  // [°], beyond which metres of the map are no measure
  if (on_its_axes || east - west > wide || north - south > wide) return degrees;
  const GeographicPlace& origin = frame.origin();
  return degrees + ", " +
         metres("about ", frame.on_map(west, origin.latitude).x(),
                frame.on_map(east, origin.latitude).x(), frame.on_map(origin.longitude, south).y(),
                frame.on_map(origin.longitude, north).y());
}

bool seems_all_land(const ScalarMap& map) {
  constexpr std::size_t lines = 16;
  const auto across = map.grid().x().places(), up = map.grid().y().places();
  bool any = false;
  for (std::size_t j = 0; j < lines; ++j)
    for (std::size_t i = 0; i < lines; ++i) {
      const Vec2 place = map.frame().on_map(across[i * (across.size() - 1) / (lines - 1)],
                                            up[j * (up.size() - 1) / (lines - 1)]);
      try {
        if (map.at(place.x(), place.y()).value > 0.0) return false;
        any = true;
      } catch (const InputError&) {  // a hole
      }
    }
  return any;
}

void describe_area(Fields& field, const AreaSettings* settings) {
  std::optional<AreaTable> table;
  if (settings != nullptr) table = table_of(*settings);
  field("area", table, "an ocean over the map");
}

}  // namespace asdic::detail::scenario
