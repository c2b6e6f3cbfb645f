#include <cmath>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"

namespace asdic::scenario {
namespace {

constexpr Quantity spacing_quantity{
    .noun = "spacing", .unit = "m", .low = 0.0, .high = 1e4, .above = true};

/// The phones of every ping in turn: an array of { positions }.
void read_shapes(TomlTable& table, ReceiverArray& array) {
  for (TomlTable& shape : table.tables("shapes")) {
    array.shapes.push_back(shape.vectors("positions", quantity::coordinate));
    if (array.shapes.back().size() != array.shapes.front().size())
      throw shape.fault(
          "positions",
          "as many phones as in the first shape, " + std::to_string(array.shapes.front().size()),
          std::to_string(array.shapes.back().size()));
    shape.finish();
  }
  if (array.shapes.empty()) throw table.fault("shapes", "at least one { positions }");
  array.phones = array.shapes.front();
}

/// Where the phones are, from the reference point.
void read_phones(TomlTable& table, ReceiverArray& array) {
  const std::string kind =
      table.choice("kind", {"horizontal", "vertical", "line", "positions", "towed"});
  if (kind == "positions") {
    if (table.has("shapes")) {
      exclude(table, "shapes", {"positions"});
      read_shapes(table, array);
    } else {
      array.phones = table.vectors("positions", quantity::coordinate);
    }
  } else if (kind == "towed") {
    constexpr Quantity behind{.noun = "distance", .unit = "m", .low = 0.0, .high = 1e5};
    array.towed = TowedLine{
        .behind = table.numbers("behind", behind),
        .heading = radians(table.number("heading_deg", quantity::heading.in_degrees(), 0.0))};
    array.phones.resize(array.towed->behind.size());  // placed when the platforms are known
  } else {
    const int phones = static_cast<int>(table.integer("phones", 1, 4096));
    const double spacing = phones == 1 ? table.number("spacing", spacing_quantity, 1.0)
                                       : table.number("spacing", spacing_quantity);
    double heading = 0.0, pitch = 0.0;
    if (kind != "vertical")
      heading = radians(table.number("heading_deg", quantity::heading.in_degrees(), 0.0));
    if (kind == "vertical") pitch = pi / 2.0;
    if (kind == "line")
      pitch = radians(table.number(
          "pitch_deg", {.noun = "pitch", .unit = "degrees", .low = -90.0, .high = 90.0}, 0.0));
    array.phones = line_array(phones, spacing, heading, pitch).phones;
  }
}

/// One number per phone, or none.
std::vector<double> of_phones(TomlTable& table, const std::string& key, const Quantity& quantity,
                              std::size_t phones) {
  if (!table.has(key)) return {};
  const std::vector<double> values = table.numbers(key, quantity);
  if (values.size() != phones)
    throw table.fault(key, "one number for each of " + std::to_string(phones) + " phones",
                      std::to_string(values.size()) + " numbers");
  return values;
}

Electronics read_electronics(TomlTable table, std::size_t phones) {
  constexpr Quantity gain{.noun = "gain", .unit = "dB", .low = -200.0, .high = 200.0};
  constexpr Quantity spread{.noun = "standard deviation", .unit = "dB", .low = 0.0, .high = 40.0};
  constexpr Quantity turn{
      .noun = "standard deviation", .unit = "degrees", .low = 0.0, .high = 360.0};
  Electronics electronics;
  electronics.gain_db = of_phones(table, "gain_db", gain, phones);
  for (const double phase :
       of_phones(table, "phase_deg",
                 {.noun = "phase", .unit = "degrees", .low = -360.0, .high = 360.0}, phones))
    electronics.phase.push_back(radians(phase));
  electronics.gain_std_db = table.number("gain_std_db", spread, 0.0);
  electronics.phase_std = radians(table.number("phase_std_deg", turn, 0.0));
  if (table.has("dead"))
    for (const double phone : table.numbers("dead", {.noun = "phone", .low = 0.0})) {
      if (phone != std::floor(phone) || phone >= static_cast<double>(phones))
        throw table.fault("dead[" + std::to_string(electronics.dead.size()) + "]",
                          "the number of a phone, 0 to " + std::to_string(phones - 1));
      electronics.dead.push_back(static_cast<int>(phone));
    }
  if (table.has("band_pass")) {
    TomlTable filter = table.table("band_pass");
    Electronics::BandPass band;
    band.order = static_cast<int>(filter.integer("order", 1, 32, band.order));
    band.low = filter.number("low", quantity::frequency);
    band.high = filter.number("high", quantity::frequency);
    if (band.high <= band.low)
      throw filter.fault("high", "a frequency above low, " + to_text(band.low) + " Hz");
    filter.finish();
    electronics.band_pass = band;
  }
  if (table.has("converter")) {
    TomlTable converter = table.table("converter");
    electronics.converter = Electronics::Converter{
        .bits = static_cast<int>(converter.integer("bits", 2, 24)),
        .full_scale = converter.number(
            "full_scale",
            {.noun = "pressure", .unit = "Pa", .low = 0.0, .high = 1e9, .above = true})};
    converter.finish();
  }
  table.finish();
  return electronics;
}

}  // namespace

void read_arrays(std::vector<TomlTable> tables, Scenario& scenario) {
  scenario.arrays.clear();
  for (TomlTable& table : tables) {
    ReceiverArray array;
    array.name = read_name(table, "array", scenario.arrays, tables.size());
    array.platform = read_reference(table, "platform", scenario.platforms);
    read_phones(table, array);
    array.offset = table.vector("offset", quantity::coordinate, Vec3::Zero());
    if (table.has("electronics"))
      array.electronics = read_electronics(table.table("electronics"), array.phones.size());
    table.finish();
    scenario.arrays.push_back(std::move(array));
    if (scenario.arrays.back().towed)
      scenario.arrays.back().phones =
          phones_at(scenario, static_cast<int>(scenario.arrays.size()) - 1, 1, 0.0);
  }
}

}  // namespace asdic::scenario
