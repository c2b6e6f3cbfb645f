#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/sections.h"
#include "io/settings/reader.h"

namespace asdic::scenario {
namespace {

/// `kind` and the parameters of the law that it names, of which other keys may stand beside them.
template <class Laws>
Laws read_law(TomlTable& table) {
  KnownSettings nothing;
  Laws law;
  TomlReader(table, nothing).one_of("kind", law, "the law of scattering");
  return law;
}

/// How the scatterers of a boundary or layer move, and how their weights are drawn.
/// \param moves  with the water: it has motion of its own and a current
void read_field(TomlTable& table, bool moves, ScattererField& field) {
  KnownSettings nothing;
  TomlReader reader(table, nothing);
  if (moves) field.motion.describe(reader);
  field.statistics.describe(reader);
}

VolumeLayer read_layer(TomlTable& table, const Environment& ocean) {
  VolumeLayer layer;
  const std::vector<double> depth = table.numbers("depth", quantity::depth);
  if (depth.size() != 2) throw table.fault("depth", "two depths, the deeper one last");
  if (depth[1] <= depth[0])
    throw table.fault("depth", "two depths, the deeper one last",
                      to_text(depth[0]) + " m and " + to_text(depth[1]) + " m");
  const double bottom = ocean.bottom.shape ? ocean.bottom.shape->deepest() : ocean.bottom.depth;
  const double surface =
      ocean.surface.shape ? ocean.surface.shape->shallowest() : ocean.surface.depth;
  if (depth[0] < surface || depth[1] > bottom)
    throw table.fault("depth", "a layer between the surface (" + to_text(surface) +
                                   " m) and the bottom (" + to_text(bottom) + " m)");
  layer.top = depth[0];
  layer.bottom = depth[1];
  layer.strength_db = table.number("strength_db", quantity::scattering_strength);
  if (table.has("sheets")) layer.sheets = static_cast<int>(table.integer("sheets", 1, 1000));
  read_field(table, true, layer.field);
  table.finish();
  return layer;
}

}  // namespace

void read_reverberation(TomlTable table, Scenario& scenario) {
  ReverberationSettings& settings = scenario.reverberation;
  settings.enabled = table.flag("enabled", settings.enabled);
  settings.azimuths = static_cast<int>(table.integer("azimuths", 1, 3600, settings.azimuths));
  settings.resolve_azimuth = table.flag("resolve_azimuth", settings.resolve_azimuth);
  settings.scatterers_per_cell =
      static_cast<int>(table.integer("scatterers_per_cell", 1, 1000, settings.scatterers_per_cell));
  settings.synthesis = read_word(table, "synthesis", settings.synthesis);
  settings.most_returns = static_cast<std::size_t>(table.integer(
      "most_returns", 1000, 1'000'000'000, static_cast<std::int64_t>(settings.most_returns)));
  if (table.has("ground_spacing"))
    settings.ground_spacing =
        table.number("ground_spacing", {.noun = "spacing", .unit = "m", .low = 0.01, .high = 1e5});
  TomlTable surface = table.table("surface");
  settings.surface_scatters = surface.flag("enabled", settings.surface_scatters);
  settings.surface = read_law<AnySurfaceScattering>(surface);
  read_field(surface, true, settings.surface_field);
  surface.finish();
  if (table.has("bottom")) {
    TomlTable bottom = table.table("bottom");
    settings.bottom = read_law<AnyBottomScattering>(bottom);
    read_field(bottom, false, settings.bottom_field);
    bottom.finish();
  }
  for (TomlTable& layer : table.tables("volume"))
    settings.volume.push_back(read_layer(layer, scenario.environment));
  table.finish();
  set_sea(settings.surface, scenario.wind_speed,
          scenario.environment.water.at(scenario.environment.surface.depth).c);
}

}  // namespace asdic::scenario
