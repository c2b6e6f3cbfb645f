#include <array>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/columns.h"
#include "io/scenario/ocean.h"

namespace asdic::scenario {
namespace {

constexpr Quantity bottom_depth{
    .noun = "depth", .unit = "m", .low = 0.0, .high = 12000.0, .above = true};

/// `transect` is what this table was called while only its first depth was used.
std::string shape_key(TomlTable& boundary) {
  const bool older = boundary.has("transect");
  return boundary.has("shape") || !older ? "shape" : "transect";
}

ShapeInterpolation read_interpolation(TomlTable& table) {
  const std::array all = {ShapeInterpolation::piecewise_linear, ShapeInterpolation::smooth,
                          ShapeInterpolation::curvilinear};
  std::vector<std::string> names;
  for (const auto kind : all) names.emplace_back(name(kind));
  const std::string chosen = table.choice("interpolation", names, names[0]);
  for (const auto kind : all)
    if (chosen == name(kind)) return kind;
  return all[0];
}

BoundaryShape read_shape(TomlTable& table, const OceanReading& reading) {
  const Columns columns = read_columns(
      table, reading.folder, {{"range", quantity::range}, {"depth", quantity::water_depth}});
  require_increasing(columns);
  return {columns.values[0], columns.values[1], read_interpolation(table)};
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
    materials.push_back(read_material(tables[i], reading, water, std::nullopt));
    tables[i].finish();
  }
  return materials;
}

}  // namespace

Boundary read_boundary_place(TomlTable& table, const OceanReading& reading, bool surface) {
  const std::string key = shape_key(table);
  if (!table.has(key)) {
    if (surface) return {.depth = table.number("depth", quantity::water_depth, 0.0)};
    return {.depth = table.number("depth", bottom_depth)};
  }
  if (table.has("depth"))
    throw table.fault("depth", "no \"depth\" beside \"" + key + "\", which says it");
  TomlTable shape = table.table(key);
  Boundary boundary{.depth = 0.0, .material = Vacuum{}, .shape = read_shape(shape, reading)};
  boundary.depth = boundary.shape->depth_at(0.0);
  return boundary;
}

void read_boundary_materials(TomlTable& table, const OceanReading& reading,
                             const Environment& ocean, std::optional<std::string> fallback,
                             Boundary& boundary) {
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
  boundary.material =
      read_material(table, reading, water_at(ocean, 0.0, boundary.depth), std::move(fallback));
}

}  // namespace asdic::scenario
