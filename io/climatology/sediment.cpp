#include "io/climatology/sediment.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "io/climatology/words.h"

namespace asdic::detail {
namespace {

using climatology::lower;

Sediment of_grain(int number, const char* name, double phi) {
  return {.number = number, .name = name, .grain_size = phi};
}

/// A fluid by its ratios to water of 1500 m/s and 1000 kg/m³, and its loss parameter δ:
/// α·λ = 40π/ln 10·δ [dB].
Sediment of_ratios(int number, const char* name, double density, double speed, double loss) {
  return {.number = number,
          .name = name,
          .grain_size = {},
          .speed = std::round(1500.0 * speed),
          .density = std::round(1000.0 * density),
          .attenuation = std::round(100.0 * 54.575 * loss) / 100.0};
}

/// Other words for them: Folk's classes, as EMODnet's maps have them, and Wentworth's.
const Sediment* by_name(std::string word) {
  std::replace_if(
      word.begin(), word.end(), [](char c) { return c == ' ' || c == '-' || c == '/'; }, '_');
  word = lower(word);
  static constexpr std::pair<std::string_view, std::string_view> others[] = {
      {"rock_and_boulders", "rock"},
      {"bedrock", "rock"},
      {"cobble", "gravel"},
      {"pebble", "gravel"},
      {"coarse_substrate", "gravelly_sand"},
      {"coarse_sediment", "gravelly_sand"},
      {"coarse_sand", "gravelly_sand"},
      {"mixed_sediment", "gravelly_muddy_sand"},
      {"sand", "medium_sand"},
      {"silty_sand", "fine_sand"},
      {"silt", "sandy_mud"},
      {"clayey_silt", "fine_silt"},
      {"mud", "fine_silt"},
      {"fine_mud", "silty_clay"}};
  for (const auto& [other, name] : others)
    if (word == other) word = name;
  std::replace(word.begin(), word.end(), '_', ' ');
  for (const Sediment& sediment : sediments())
    if (sediment.name == word) return &sediment;
  return nullptr;
}

std::string all_names() {
  std::string names;
  for (const Sediment& sediment : sediments())
    names += (names.empty() ? "" : ", ") + std::to_string(sediment.number) + " " + sediment.name;
  return names;
}

}  // namespace

std::string Sediment::toml() const {
  if (grain_size)
    return "kind = \"grain-size\"\ngrain_size = " + to_text(*grain_size) + "  # [phi]: " + name +
           "\n";
  const auto number_text = [](double value) {
    const std::string text = to_text(value);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
  };
  return "kind = \"fluid\"  # " + name + "\nspeed = " + number_text(speed) +
         "\ndensity = " + number_text(density) +
         "\nattenuation_db_per_wavelength = " + number_text(attenuation) + "\n";
}

const std::vector<Sediment>& sediments() {
  static const std::vector<Sediment> all{of_ratios(1, "rock", 2.5, 2.5, 0.01374),
                                         of_ratios(2, "gravel", 2.5, 1.8, 0.01374),
                                         of_grain(3, "sandy gravel", -1.0),
                                         of_grain(4, "very coarse sand", -0.5),
                                         of_grain(5, "muddy sandy gravel", 0.0),
                                         of_grain(6, "gravelly sand", 0.5),
                                         of_grain(7, "gravelly muddy sand", 1.0),
                                         of_grain(8, "medium sand", 1.5),
                                         of_grain(9, "muddy gravel", 2.0),
                                         of_grain(10, "fine sand", 2.5),
                                         of_grain(11, "muddy sand", 3.0),
                                         of_grain(12, "very fine sand", 3.5),
                                         of_grain(13, "clayey sand", 4.0),
                                         of_grain(14, "coarse silt", 4.5),
                                         of_grain(15, "sandy silt", 5.0),
                                         of_grain(16, "medium silt", 5.5),
                                         of_grain(17, "sandy mud", 6.0),
                                         of_grain(18, "fine silt", 6.5),
                                         of_grain(19, "sandy clay", 7.0),
                                         of_grain(20, "very fine silt", 7.5),
                                         of_grain(21, "silty clay", 8.0),
                                         of_grain(22, "clay", 9.0),
                                         {.number = 23,
                                          .name = "abyssal clay",
                                          .grain_size = {},
                                          .speed = 1520.0,
                                          .density = 1400.0,
                                          .attenuation = 0.1}};
  return all;
}

std::string_view province_at_depth(double depth) {
  return depth <= 200.0 ? "shelf" : depth <= 2500.0 ? "slope" : "abyss";
}

const Sediment& sediment_at_depth(double depth) {
  return *by_name(depth <= 200.0 ? "fine sand" : depth <= 2500.0 ? "sandy mud" : "abyssal clay");
}

SedimentMap::SedimentMap(const std::vector<DataFile>& files, const OceanTime& when)
    : tiles_(files, climatology::sediment_quantity(), when) {
  const DataGrid& grid = tiles_.first();
  const std::string name = lower(grid.variable() + " " + grid.standard_name() + " " +
                                 grid.long_name() + " " + grid.units());
  is_grain_size_ = grid.flag_meanings().empty() &&
                   (name.find("grain") != std::string::npos || lower(grid.units()) == "phi" ||
                    lower(grid.variable()) == "mz" || lower(grid.variable()) == "phi");
  if (is_grain_size_) return;
  if (grid.flag_meanings().empty()) {
    for (const Sediment& sediment : sediments()) classes_.emplace_back(sediment.number, sediment);
    return;
  }
  const std::string where = grid.path().string() + ": " + grid.variable() + ": flag_meanings";
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < grid.flag_meanings().size();) {
    const std::size_t end =
        std::min(grid.flag_meanings().find(' ', begin), grid.flag_meanings().size());
    if (end > begin) words.push_back(grid.flag_meanings().substr(begin, end - begin));
    begin = end + 1;
  }
  if (words.size() != grid.flag_values().size())
    throw InputError({.where = where,
                      .got = count_of(words.size(), "word") + " for " +
                             count_of(grid.flag_values().size(), "flag value"),
                      .expected = "a word for each"});
  for (std::size_t i = 0; i < words.size(); ++i) {
    const Sediment* const known = by_name(words[i]);
    if (known == nullptr)
      throw InputError({.where = where,
                        .got = in_quotes(words[i]),
                        .expected = "words for sediments that are known: " + all_names()});
    classes_.emplace_back(grid.flag_values()[i], *known);
  }
}

Sediment SedimentMap::of_value(double value, const std::string& where) const {
  if (is_grain_size_) {
    if (!(value >= -9.0 && value <= 12.0))
      throw InputError({.where = where, .got = to_text(value), .expected = "a grain size in phi"});
    if (value < -1.0) return sediments()[value < -6.0 ? 0 : 1];  // rock, gravel
    const double phi = std::min(9.0, std::round(10.0 * value) / 10.0);
    Sediment nearest = sediments()[2];
    for (const Sediment& one : sediments())
      if (one.grain_size && std::abs(*one.grain_size - phi) < std::abs(*nearest.grain_size - phi))
        nearest = one;
    nearest.grain_size = phi;
    return nearest;
  }
  for (const auto& [number, sediment] : classes_)
    if (number == std::round(value)) return sediment;
  throw InputError(
      {.where = where,
       .got = "class " + to_text(value),
       .expected =
           "one of " + (tiles_.first().flag_meanings().empty() ? all_names() : "its flag_values")});
}

std::optional<Sediment> SedimentMap::at(double latitude, double longitude) const {
  const double value = tiles_.nearest(latitude, longitude);
  if (std::isnan(value)) return std::nullopt;
  return of_value(
      value, tiles_.name_at(latitude, longitude) + ": " + climatology::place(latitude, longitude));
}

}  // namespace asdic::detail
