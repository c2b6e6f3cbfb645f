// Part of ocean.h: [environment.surface] and [environment.bottom].
#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/area.h"
#include "io/scenario/ocean.h"
#include "io/settings/columns.h"
#include "io/settings/reader.h"

namespace asdic::detail::scenario {
namespace {

constexpr Quantity bottom_depth{.noun = "depth", .unit = "m", .low = 0.01, .high = 12000.0};

enum class Bubbles { none, apl_uw };
constexpr std::string_view bubbles_words[] = {"none", "apl-uw"};
constexpr std::span<const std::string_view> words(Bubbles) { return bubbles_words; }

/// `transect` is what this table was called while only its first depth was used.
std::string shape_key(TomlTable& boundary) {
  const bool older = boundary.has("transect");
  return boundary.has("shape") || !older ? "shape" : "transect";
}

/// [….shape]: the nodes of a boundary that is not flat.
struct ShapeTable {
  ShapeInterpolation interpolation = ShapeInterpolation::piecewise_linear;
  std::vector<double> range = {}, depth = {};

  void describe(Fields& field) {
    field("interpolation", interpolation, "how the boundary runs between its nodes");
    field.columns({{"range", range, quantity::range, "of the nodes along the transect, rising"},
                   {"depth", depth, quantity::water_depth, "of each node"}},
                  {.file = true});
  }
};

BoundaryShape read_shape(TomlTable& table, const OceanReading& reading) {
  KnownSettings known{.folder = reading.folder};
  ShapeTable settings;
  TomlReader reader(table, known);
  settings.describe(reader);
  return {settings.range, settings.depth, settings.interpolation};
}

void describe_depth(Fields& field, bool surface, double& depth) {
  field(surface ? "depth" : required("depth"), depth,
        surface ? quantity::water_depth : bottom_depth, "where it is flat");
}

WaterAtBoundary water_at(const Environment& ocean, double range, double depth) {
  return {.speed = sound_speed(ocean, range, depth).c, .density = ocean.water_density.at(depth)};
}

/// Columns of a shape's CSV file that make a fluid, or with shear an elastic, half space a node.
std::vector<BoundaryMaterial> materials_of_file(TomlTable& table, const OceanReading& reading) {
  if (!read_csv_of(table, reading.folder).has("speed")) return {};
  const bool elastic = read_csv_of(table, reading.folder).has("shear_speed");
  const Quantity loss{.noun = "attenuation", .unit = "dB per wavelength", .low = 0.0, .high = 50.0};
  std::vector<std::pair<std::string, Quantity>> wanted = {{"range", quantity::range},
                                                          {"speed", quantity::sound_speed},
                                                          {"density", quantity::density},
                                                          {"attenuation_db_per_wavelength", loss}};
  if (elastic) {
    wanted.push_back({"shear_speed", {.noun = "speed", .unit = "m/s", .low = 0.0, .high = 1e5}});
    wanted.push_back({"shear_attenuation_db_per_wavelength", loss});
  }
  const auto columns = read_columns(table, reading.folder, wanted).values;
  std::vector<BoundaryMaterial> materials;
  for (std::size_t i = 0; i < columns[0].size(); ++i) {
    if (elastic && columns[4][i] > 0.0)
      materials.emplace_back(
          ElasticHalfSpace{.speed = columns[1][i],
                           .shear_speed = columns[4][i],
                           .density = columns[2][i],
                           .attenuation_db_per_wavelength = columns[3][i],
                           .shear_attenuation_db_per_wavelength = columns[5][i]});
    else
      materials.emplace_back(FluidHalfSpace{.speed = columns[1][i],
                                            .density = columns[2][i],
                                            .attenuation_db_per_wavelength = columns[3][i]});
  }
  return materials;
}

/// One material a node: [[environment.bottom.shape.material]], or columns of the file.
std::vector<BoundaryMaterial> read_materials(TomlTable& table, const OceanReading& reading,
                                             const Environment& ocean, const BoundaryShape& shape) {
  if (!table.has("material"))
    return table.has("file") ? materials_of_file(table, reading) : std::vector<BoundaryMaterial>{};
  std::vector<BoundaryMaterial> materials;
  auto tables = table.tables("material");
  const std::size_t n = shape.ranges().size();
  if (tables.size() != n)
    throw table.fault("material", "one for each of the " + std::to_string(n) + " nodes");
  for (std::size_t i = 0; i < n; ++i) {
    const auto water = water_at(ocean, shape.ranges()[i], shape.depths()[i]);
    materials.push_back(read_material(tables[i], reading, water, false));
    tables[i].finish();
  }
  return materials;
}

}  // namespace

Boundary read_boundary_place(TomlTable& table, const OceanReading& reading, bool surface) {
  const std::string key = shape_key(table);
  if (reading.area != nullptr && (table.has(key) || (!surface && table.has("depth"))))
    throw table.fault(table.has(key) ? key : "depth",
                      surface ? "a flat surface over [environment.area]"
                              : "no " + in_quotes(table.has(key) ? key : "depth") +
                                    " beside [environment.area.bathymetry], which says it");
  if (reading.area != nullptr && !surface)
    return {.depth = std::max(1.0, reading.area->floor().at(0.0, 0.0).value)};
  if (!table.has(key)) {
    KnownSettings known;
    TomlReader reader(table, known);
    Boundary flat{.depth = 0.0};
    describe_depth(reader, surface, flat.depth);
    return flat;
  }
  if (table.has("depth"))
    throw table.fault("depth", "no \"depth\" beside \"" + key + "\", which says it");
  TomlTable shape = table.table(key);
  Boundary boundary{.depth = 0.0, .material = Vacuum{}, .shape = read_shape(shape, reading)};
  boundary.depth = boundary.shape->depth_at(0.0);
  return boundary;
}

void read_boundary_materials(TomlTable& table, const OceanReading& reading,
                             const Environment& ocean, bool surface, Boundary& boundary) {
  if (boundary.shape) {
    TomlTable shape = table.table(shape_key(table));
    for (const char* key : {"range", "depth", "file", "interpolation", "note"})
      static_cast<void>(shape.has(key));
    auto materials = read_materials(shape, reading, ocean, *boundary.shape);
    shape.finish();
    const bool of_its_own = table.has("kind");
    if (!materials.empty()) {
      const BoundaryShape& place = *boundary.shape;
      boundary.material = materials.front();
      boundary.shape = BoundaryShape(place.ranges(), place.depths(), place.interpolation(),
                                     std::move(materials));
      if (!of_its_own) return;
    }
  }
  boundary.material = read_material(table, reading, water_at(ocean, 0.0, boundary.depth), surface);
}

namespace {

/// `roughness` [m], or "wind": the wind's sea; its spectrum is known. `bubbles`: under it.
struct RoughnessTable {
  Roughness rough = {};
  bool surface = false;

  void describe(Fields& field) {
    Fields::Ways ways;
    if (const auto way = field.way(ways, {"roughness", "roughness_wind", "roughness_floor_db"},
                                   rough.rms_height > 0.0))
      describe_height(field);
    if (surface) describe_bubbles(field);
  }

 private:
  void describe_height(Fields& field) {
    constexpr Quantity height{.noun = "rms height", .unit = "m", .low = 0.0, .high = 20.0};
    constexpr Quantity floor{.noun = "floor", .unit = "dB", .low = -300.0, .high = 0.0};
    std::optional<double> given = rough.rms_height;
    field(surface ? or_word("roughness", "wind") : "roughness", given, height,
          "standard deviation of the boundary; \"wind\": of the wind's sea");
    if (given) {
      rough.rms_height = *given;
      field(seldom("roughness_wind"), rough.sea_wind, quantity::wind_speed,
            "over the sea that it is");
    } else {
      rough.sea_wind = field.known("environment.wind_speed");
      rough.rms_height = pierson_moskowitz_height(rough.sea_wind);
    }
    if (field.reads() || field.exhaustive())
      rough.floor_db = floor.low;  // what leaves the mean field is not lost
    field("roughness_floor_db", rough.floor_db, floor,
          "the least that a bounce leaves of the mean");
  }
  void describe_bubbles(Fields& field) {
    Bubbles bubbles = rough.bubble_wind > 0.0 ? Bubbles::apl_uw : Bubbles::none;
    field(seldom("bubbles"), bubbles, "what bubbles under the surface take");
    if (const auto only = field.only("bubbles", bubbles, Bubbles::apl_uw))
      field(inherited("bubbles_wind", "environment.wind_speed"), rough.bubble_wind,
            quantity::wind_speed, "over the bubbles");
  }
};

/// A boundary for a walker that does not read.
struct BoundaryTable {
  const Boundary& boundary;
  bool surface;
  bool by_map;

  void describe(Fields& field) const {
    if (!by_map) describe_place(field);
    const SettingKey kind = required(by_default("kind", "required but with a material each node"));
    describe_material(field, boundary.material, surface ? "kind" : kind);
    RoughnessTable{boundary.roughness, surface}.describe(field);
    if (by_map) return;
    std::optional<ShownShape> shape;
    if (boundary.shape) shape = shown(*boundary.shape);
    field("shape", shape, "where it is not flat");
  }

 private:
  void describe_place(Fields& field) const {
    Fields::Ways ways;
    static_cast<void>(field.way(ways, {"shape"}, boundary.shape.has_value()));  // it comes last
    double depth = boundary.depth;
    if (const auto way = field.otherwise(ways, {"depth"})) describe_depth(field, surface, depth);
  }
  struct ShownMaterial {
    BoundaryMaterial material = FluidHalfSpace{};
    void describe(Fields& field) const { describe_material(field, material, required("kind")); }
  };
  struct ShownShape {
    ShapeTable nodes = {};
    std::vector<ShownMaterial> materials = {};

    void describe(Fields& field) {
      nodes.describe(field);
      field("material", materials, "behind the boundary, from node to node");
    }
  };
  static ShownShape shown(const BoundaryShape& shape) {
    ShownShape made{.nodes = {shape.interpolation(),
                              {shape.ranges().begin(), shape.ranges().end()},
                              {shape.depths().begin(), shape.depths().end()}}};
    for (const BoundaryMaterial& one : shape.materials()) made.materials.push_back({one});
    return made;
  }
};

}  // namespace

void read_roughness(TomlTable& table, double wind_speed, bool surface, Roughness& roughness) {
  KnownSettings known{.numbers = {{"environment.wind_speed", wind_speed}}};
  RoughnessTable settings{roughness, surface};
  TomlReader reader(table, known);
  settings.describe(reader);
  roughness = settings.rough;
}

void describe_boundary(Fields& field, bool surface, const Boundary& boundary, bool by_map) {
  BoundaryTable settings{boundary, surface, by_map};
  field(surface ? "surface" : "bottom", settings, surface ? "above the water" : "below the water");
}

}  // namespace asdic::detail::scenario
