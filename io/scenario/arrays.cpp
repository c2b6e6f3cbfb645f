#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"

namespace asdic::scenario {
namespace {

constexpr Quantity heading_quantity{
    .noun = "heading", .unit = "degrees", .low = -360.0, .high = 360.0};
constexpr Quantity spacing_quantity{
    .noun = "spacing", .unit = "m", .low = 0.0, .high = 1e4, .above = true};

/// Where the phones are, from the reference point.
void read_phones(TomlTable& table, ReceiverArray& array) {
  const std::string kind = table.choice("kind", {"horizontal", "vertical", "line", "positions"});
  if (kind == "positions") {
    array.phones = table.vectors("positions", coordinate);
  } else {
    const int phones = static_cast<int>(table.integer("phones", 1, 4096));
    const double spacing = phones == 1 ? table.number("spacing", spacing_quantity, 1.0)
                                       : table.number("spacing", spacing_quantity);
    double heading = 0.0, pitch = 0.0;
    if (kind != "vertical") heading = radians(table.number("heading_deg", heading_quantity, 0.0));
    if (kind == "vertical") pitch = pi / 2.0;
    if (kind == "line")
      pitch = radians(table.number(
          "pitch_deg", {.noun = "pitch", .unit = "degrees", .low = -90.0, .high = 90.0}, 0.0));
    array.phones = line_array(phones, spacing, heading, pitch).phones;
  }
}

}  // namespace

void read_arrays(std::vector<TomlTable> tables, Scenario& scenario) {
  scenario.arrays.clear();
  for (TomlTable& table : tables) {
    ReceiverArray array;
    array.name = read_name(table, "array", scenario.arrays, tables.size());
    array.platform = read_reference(table, "platform", scenario.platforms);
    read_phones(table, array);
    array.offset = table.vector("offset", coordinate, Vec3::Zero());
    table.finish();
    scenario.arrays.push_back(std::move(array));
  }
}

}  // namespace asdic::scenario
