#include "study/reader/vary_climatology.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/text.h"
#include "io/climatology/sources.h"
#include "io/climatology/water.h"
#include "io/climatology/wind.h"

namespace asdic::detail::study {
namespace {

constexpr std::array<const char*, 12> names_of_months{
    "january", "february", "march",     "april",   "may",      "june",
    "july",    "august",   "september", "october", "november", "december"};

/// A file, or an array of them, relative to the study's folder; with ":VARIABLE" where need be.
std::vector<DataFile> read_files(TomlTable& table, const TomlValue& value, const std::string& key,
                                 const Study& study) {
  if (!table.has(key)) return {};
  std::vector<const TomlValue*> items{value.find(key)};
  if (const auto* array = std::get_if<TomlValue::Array>(&items[0]->data)) {
    items.clear();
    for (const TomlValue& item : *array) items.push_back(&item);
  }
  std::vector<DataFile> files;
  for (const TomlValue* item : items) {
    const auto* name = std::get_if<std::string>(&item->data);
    if (name == nullptr)
      throw table.fault(key, "a netCDF file, or an array of them", item->describe());
    files.push_back(data_file((study.path.parent_path() / *name).string()));
    if (!std::filesystem::exists(files.back().path))
      throw table.fault(key, "a netCDF file",
                        "no such file " + in_quotes(files.back().path.string()));
  }
  return files;
}

TomlValue::Array numbers(const std::vector<double>& values, const std::string& origin) {
  TomlValue::Array items;
  for (const double x : values) items.push_back({.data = x, .origin = origin});
  return items;
}

/// The [environment.sound_speed] that `asdic ocean` writes of the same water.
TomlValue profile_of(const climatology::WaterColumn& water, double latitude,
                     const std::string& origin) {
  TomlValue::Table table;
  const auto add = [&](const char* key, auto data) {
    TomlValue value{.origin = origin};
    value.data = std::move(data);
    table.push_back({key, std::move(value)});
  };
  add("interpolation", std::string("pchip"));
  if (!water.speed.empty()) {
    std::vector<double> depth = water.depth;
    if (depth.front() > 0.0) depth.insert(depth.begin(), 0.0);
    while (depth.back() < 12000.0 || depth.size() < 2) depth.push_back(depth.back() + 250.0);
    add("kind", std::string("table"));
    add("speed", numbers(climatology::speeds_of(water, depth, latitude), origin));
    add("depth", numbers(depth, origin));
  } else {
    add("kind", std::string("temperature-salinity"));
    add("equation", std::string("chen-millero"));
    add("latitude_deg", latitude);
    add("depth", numbers(water.depth, origin));
    add("temperature", numbers(water.temperature, origin));
    add("salinity", numbers(water.salinity, origin));
  }
  return {.data = std::move(table), .origin = origin};
}

/// Whether a note says no more than that the month is there.
bool is_plain(const std::string& note, int month) {
  return note.ends_with(" of month " + std::to_string(month)) &&
         note.find("not of month") == std::string::npos;
}

std::vector<int> read_months(TomlTable& table) {
  std::vector<int> months;
  if (!table.has("months")) {
    for (int month = 1; month <= 12; ++month) months.push_back(month);
    return months;
  }
  for (const double x : table.numbers("months", {.noun = "month", .low = 1.0, .high = 12.0})) {
    const int month = static_cast<int>(x);
    if (month != x || std::find(months.begin(), months.end(), month) != months.end())
      throw table.fault("months", "whole numbers from 1 to 12, each once");
    months.push_back(month);
  }
  return months;
}

constexpr const char* wind_key = "environment.wind_speed";

/// Whether an entry of [vary] writes the wind by itself.
bool wind_varies(const Study& study) {
  const TomlValue* vary = study.document.find("vary");
  const TomlValue::Table* entries = vary == nullptr ? nullptr : vary->table();
  if (entries == nullptr) return false;
  return std::any_of(entries->begin(), entries->end(), [](const TomlEntry& entry) {
    const TomlValue* keys = entry.value.find("keys");
    if (keys == nullptr) return entry.key == wind_key;
    const auto* items = std::get_if<TomlValue::Array>(&keys->data);
    return items != nullptr && std::any_of(items->begin(), items->end(), [](const TomlValue& item) {
             const auto* key = std::get_if<std::string>(&item.data);
             return key != nullptr && *key == wind_key;
           });
  });
}

/// The wind of each month beside its water: one draw.
void add_wind(const std::vector<DataFile>& files, const std::vector<int>& months, double latitude,
              double longitude, const TomlTable& table, const Study& study, Variable& variable,
              ChoiceLaw& law) {
  for (std::size_t i = 0; i < months.size(); ++i) {
    const climatology::Wind wind(files, {.month = months[i]});
    const double speed = wind.at(latitude, longitude);
    if (!std::isfinite(speed))
      throw table.fault("wind",
                        "a file with the wind at " + climatology::place(latitude, longitude),
                        "none there in " + law.labels[0][i]);
    law.values[i].push_back({.data = speed, .origin = variable.origin});
    const int fit = wind.first().time_at(latitude, longitude).fit;
    if (fit > 0 && variable.notes.size() < 20)
      variable.notes.push_back("wind of " + law.labels[0][i] + ": " +
                               wind.first().time_at(latitude, longitude).said);
  }
  law.labels.emplace_back();
  law.names = {variable.name, variable.name + "_wind_speed"};
  law.by_row = true;
  if (!wind_varies(study) &&
      std::find(variable.keys.begin(), variable.keys.end(), wind_key) == variable.keys.end())
    variable.keys.emplace_back(wind_key);
  if (variable.numbers.size() < 2)
    variable.numbers.push_back(
        {.unit = "m/s",
         .meaning = std::string(wind_key) + ": mean of the month, of the climatology"});
}

}  // namespace

ChoiceLaw read_climatology(TomlTable& table, const TomlValue& value, Variable& variable,
                           const Study& study) {
  OceanSources named;
  named.temperature = read_files(table, value, "temperature", study);
  named.salinity = read_files(table, value, "salinity", study);
  named.sound_speed = read_files(table, value, "sound_speed", study);
  if (named.temperature.empty() && named.sound_speed.empty())
    throw table.fault("temperature",
                      "files of temperature and salinity, or of sound_speed, by month");
  const OceanSources sources = or_default(named, {});
  const double latitude = table.number(
      "latitude_deg", {.noun = "latitude", .unit = "degrees", .low = -90.0, .high = 90.0});
  const double longitude = table.number(
      "longitude_deg", {.noun = "longitude", .unit = "degrees", .low = -180.0, .high = 360.0});
  const std::vector<int> months = read_months(table);
  ChoiceLaw law;
  std::vector<climatology::WaterColumn> waters;
  law.labels.emplace_back();
  for (const int month : months) {
    const climatology::Water water(sources, {.month = month}, latitude, longitude);
    waters.push_back(water.require(latitude, longitude));
    law.values.push_back({profile_of(waters.back(), latitude, variable.origin)});
    law.labels.back().emplace_back(names_of_months[static_cast<std::size_t>(month - 1)]);
    for (const std::string& note : water.notes(latitude, longitude))
      if (!is_plain(note, month) &&
          std::find(variable.notes.begin(), variable.notes.end(), note) == variable.notes.end())
        variable.notes.push_back(note);
  }
  const auto same = [&](const climatology::WaterColumn& one) { return one == waters.front(); };
  if (waters.size() > 1 && std::all_of(waters.begin(), waters.end(), same))
    throw table.fault(named.temperature.empty() ? "sound_speed" : "temperature",
                      "files that tell months apart", "the same water in every month");
  if (const std::vector<DataFile> wind = read_files(table, value, "wind", study); !wind.empty()) {
    add_wind(wind, months, latitude, longitude, table, study, variable, law);
    for (const DataFile& file : wind) variable.digest += digest_of(file.path) + ";";
  }
  for (const DataFile& file : sources.all()) variable.digest += digest_of(file.path) + ";";
  return law;
}

}  // namespace asdic::detail::study
