#include "io/scenario/sections.h"

namespace asdic::scenario {

void read_noise(TomlTable table, Scenario& scenario) {
  if (table.has("spectral_level_db"))
    scenario.noise.spectral_level_db = table.number("spectral_level_db", level_quantity);
  table.finish();
}

}  // namespace asdic::scenario
