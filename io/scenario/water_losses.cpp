#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/columns.h"
#include "io/scenario/ocean.h"
#include "io/scenario/sections.h"

namespace asdic::scenario {
namespace {

/// Of a law that knows the water.
template <class Law>
Law read_law_of_water(TomlTable& table) {
  Law law;
  law.temperature = table.number("temperature", quantity::temperature, law.temperature);
  law.salinity = table.number("salinity", quantity::salinity, law.salinity);
  law.ph = table.number("ph", {.noun = "pH", .low = 6.0, .high = 9.0}, law.ph);
  law.depth = table.number("depth", quantity::depth, law.depth);
  return law;
}

Absorption read_absorption(TomlTable table) {
  const std::string kind =
      table.choice("kind", {"none", "thorp", "francois-garrison", "ainslie-mccolm"}, "thorp");
  Absorption absorption = NoAbsorption{};
  if (kind == Thorp::name) absorption = Thorp{};
  if (kind == FrancoisGarrison::name) absorption = read_law_of_water<FrancoisGarrison>(table);
  if (kind == AinslieMcColm::name) absorption = read_law_of_water<AinslieMcColm>(table);
  table.finish();
  return absorption;
}

/// A number, or a table of `depth` and `name`: straight lines, two equal depths are a step.
DepthFunction read_depth_function(TomlTable& table, const OceanReading& reading,
                                  const std::string& name, const Quantity& quantity) {
  const Columns columns =
      read_columns(table, reading.folder, {{"depth", quantity::water_depth}, {name, quantity}});
  for (std::size_t i = 1; i < columns.rows(); ++i)
    if (columns.values[0][i] < columns.values[0][i - 1])
      throw columns.fault(
          0, i, "a depth not above the one before it, " + to_text(columns.values[0][i - 1]) + " m",
          "m");
  return DepthFunction::table(columns.values[0], columns.values[1]);
}

BiologicalLayer read_layer(TomlTable& table) {
  BiologicalLayer layer;
  layer.top = table.number("top", quantity::water_depth);
  layer.bottom = table.number("bottom", quantity::water_depth);
  if (!(layer.bottom > layer.top))
    throw table.fault("bottom", "a depth below the layer's top, " + to_text(layer.top) + " m");
  layer.resonance = table.number("resonance", quantity::frequency);
  layer.quality = table.number("quality_factor",
                               {.noun = "quality factor", .low = 0.0, .high = 1e4, .above = true});
  layer.strength = table.number("strength_db_per_km",
                                {.noun = "strength", .unit = "dB/km", .low = 0.0, .high = 1e6});
  table.finish();
  return layer;
}

}  // namespace

void read_water_losses(TomlTable& table, const OceanReading& reading, Environment& ocean) {
  if (table.is_table("water_density")) {
    TomlTable columns = table.table("water_density");
    ocean.water_density = read_depth_function(columns, reading, "density", quantity::density);
    columns.finish();
  } else {
    ocean.water_density =
        table.number("water_density", quantity::density, ocean.water_density.at(0.0));
  }
  ocean.absorption = read_absorption(table.table("absorption"));
  for (TomlTable& layer : table.tables("biology")) ocean.biology.push_back(read_layer(layer));

  constexpr Quantity loss{.noun = "attenuation", .unit = "dB/km", .low = 0.0, .high = 1e6};
  TomlTable attenuation = table.table("attenuation");
  const bool has_depth = attenuation.has("depth"), has_file = attenuation.has("file");
  if (has_depth || has_file)
    ocean.attenuation_db_per_km = read_depth_function(attenuation, reading, "db_per_km", loss);
  else
    ocean.attenuation_db_per_km = attenuation.number("db_per_km", loss, 0.0);
  attenuation.finish();
}

}  // namespace asdic::scenario
