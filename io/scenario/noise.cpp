#include <array>

#include "core/quantities.h"
#include "core/text.h"
#include "io/scenario/angles.h"
#include "io/scenario/columns.h"
#include "io/scenario/sections.h"
#include "io/scenario/tracks.h"
#include "io/settings/reader.h"
#include "sonar/noise/noise_spectrum.h"

namespace asdic::scenario {
namespace {

NoiseTable read_table(TomlTable& table, const std::filesystem::path& folder) {
  const Columns columns = read_columns(
      table, folder, {{"frequency", quantity::frequency}, {"level_db", quantity::level}});
  require_increasing(columns);
  return {columns.values[0], columns.values[1]};
}

/// A warning when a wind has no sea state of its own.
void note_wind(double wind_speed, Scenario& scenario) {
  const std::array<Asked, 1> asked{{{"wind speed", wind_speed, wind_speed}}};
  if (const std::string text = outside(knudsen_validity(), asked); !text.empty())
    scenario.notes.push_back("noise.wind_speed: " + text);
}

/// The spectrum: `kind` and its keys.
void read_spectrum(TomlTable& table, const std::filesystem::path& folder, Scenario& scenario) {
  NoiseSettings& noise = scenario.noise;
  const bool level = table.has("spectral_level_db");
  const std::vector<std::string> kinds{"white", "wenz", "knudsen", "table"};
  const bool any = table.has("kind") || table.has("coherence") || table.has("thermal");
  const std::string kind = table.choice("kind", kinds, kinds[0]);
  if (kind != "white") exclude(table, "kind = \"" + kind + "\"", {"spectral_level_db"});
  if (kind == "white" && (any || level))
    noise.spectral_level_db = table.number("spectral_level_db", quantity::level);
  if (kind == "wenz")
    noise.law = WenzNoise{
        .shipping = table.number("shipping", {.noun = "shipping", .low = 0.0, .high = 1.0}, 0.5),
        .wind_speed = table.number("wind_speed", quantity::wind_speed, scenario.wind_speed)};
  if (kind == "knudsen") {
    if (table.has("wind_speed")) exclude(table, "wind_speed", {"sea_state"});
    const double wind_speed = table.number("wind_speed", quantity::wind_speed, scenario.wind_speed);
    const double by_wind = sea_state_of_wind(wind_speed);
    if (!table.has("sea_state")) note_wind(wind_speed, scenario);
    noise.law = KnudsenNoise{
        table.number("sea_state", {.noun = "sea state", .low = 0.0, .high = 6.0}, by_wind)};
  }
  if (kind == "table") noise.law = read_table(table, folder);
  noise.thermal = noise.any() && table.flag("thermal", kind == "wenz");
}

/// [noise.profile]: where the noise comes from.
void read_profile(TomlTable table, NoiseDirections& directions) {
  directions.elevation =
      read_angles(table, "elevation", {.noun = "elevation", .low_deg = -90.0, .high_deg = 90.0});
  directions.level_db = table.numbers("level_db", quantity::level);
  const std::string key = angle_key(table, "elevation");
  if (directions.elevation.size() < 2) throw table.fault(key, "at least two elevations", "one");
  if (directions.level_db.size() != directions.elevation.size())
    throw table.fault(
        "level_db", "as many values as elevations, " + std::to_string(directions.elevation.size()));
  for (std::size_t i = 1; i < directions.elevation.size(); ++i)
    if (directions.elevation[i] <= directions.elevation[i - 1])
      throw table.fault(key + "[" + std::to_string(i) + "]",
                        "an elevation above the one before it");
  table.finish();
}

void read_coherence(TomlTable& table, const Scenario& scenario, NoiseSettings& noise) {
  noise.coherence = read_word(table, "coherence", noise.coherence);
  constexpr std::size_t most_phones = 256;  // the factors of more are gigabytes
  for (const ReceiverArray& array : scenario.arrays)
    if (noise.coherence != NoiseCoherence::independent && array.phones.size() > most_phones)
      throw table.fault(
          "coherence",
          "\"independent\" for an array of more than " + std::to_string(most_phones) + " phones",
          in_quotes(word_of(noise.coherence)) + " for " + std::to_string(array.phones.size()));
  if (noise.coherence == NoiseCoherence::surface)
    noise.directions.dipole_exponent =
        table.number("dipole_exponent", {.noun = "exponent", .low = 0.5, .high = 10.0}, 1.0);
  if (noise.coherence == NoiseCoherence::profile)
    read_profile(table.table("profile"), noise.directions);
}

}  // namespace

void read_noise(TomlTable table, const std::filesystem::path& folder, Scenario& scenario) {
  NoiseSettings& noise = scenario.noise;
  read_spectrum(table, folder, scenario);
  if (noise.any()) read_coherence(table, scenario, noise);
  table.finish();
}

}  // namespace asdic::scenario
