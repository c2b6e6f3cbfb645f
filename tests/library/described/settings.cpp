#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "asdic/asdic.h"
#include "io/scenario/catalogue.h"

// The structs of the public headers, which cannot see the descriptions of settings, say what these
// say: keys, types, units, defaults. A setting that a description gains is offered by the struct,
// or is named here among those that are set by their paths.

namespace asdic {
namespace {

using detail::SettingRecord;
using detail::SettingsList;
using detail::TableRecord;
using Type = SettingRecord::Type;

/// A struct, and the table of a scenario that it becomes.
struct Shown {
  std::string name, table;
  Value usual;                         ///< of a struct of defaults
  std::vector<Value> full;             ///< which together have every key
  std::set<std::string> by_path = {};  ///< keys of the table that it leaves to Scenario::set()
  std::map<std::string, std::string> renamed = {};  ///< members that are not called as their keys
};

const std::string window = "tukey";
const std::vector<double> two{1.0, 2.0};
const Vector place{1.0, 2.0, 3.0};
const std::vector<Waypoint> way{{.time = 0.0, .position = place}};
const Aspect aspect{.bow_db = 1.0, .beam_db = 2.0, .stern_db = 3.0};

/// What scatterers of any law have.
const std::set<std::string> of_scatterers{
    "enabled",        "motion", "receding_share", "speed_rms", "current",
    "coherence_time", "frozen", "sheets",         "k_shape",   "correlation_length"};

template <class Law>
Shown law(const char* name, const char* boundary, const Law& full) {
  return {.name = name,
          .table = std::string("reverberation.") + boundary,
          .usual = Law{},
          .full = {full},
          .by_path = of_scatterers};
}

Bottom bottom(const char* kind) {
  Bottom made{.depth = 100.0, .kind = kind};
  const std::string k = kind;
  if (k == "grain-size") made.grain_size = 3.0;
  if (k != "fluid" && k != "elastic") return made;
  made.speed = made.density = made.attenuation_db_per_wavelength = 1.0;
  if (k == "elastic") made.shear_speed = made.shear_attenuation_db_per_wavelength = 1.0;
  return made;
}

Shown bottom_of(const char* kind) {
  Bottom shaped = bottom(kind);
  shaped.depth = {};
  shaped.bathymetry = Bathymetry{.range = two, .depth = two};
  Shown made{.name = "Bottom",
             .table = "environment.bottom",
             .usual = Bottom{.kind = kind},
             .full = {bottom(kind), shaped},
             .by_path = {"roughness", "roughness_wind", "roughness_floor_db", "water_speed",
                         "water_density"},
             .renamed = {{"bathymetry", "shape"}}};
  for (const char* wave : {"", "shear_"})  // other units of one number
    for (const char* other : {"attenuation_db_per_metre", "attenuation_db_per_metre_khz",
                              "attenuation_nepers_per_metre", "quality_factor", "loss_parameter"})
      made.by_path.insert(std::string(wave) + other);
  return made;
}

std::vector<Shown> all_structs() {
  const Value lfm = Lfm{.start_frequency = 1.0,
                        .end_frequency = 2.0,
                        .duration = 1.0,
                        .window = window,
                        .tukey_fraction = 0.1};
  const Value hfm = Hfm{.start_frequency = 1.0,
                        .end_frequency = 2.0,
                        .duration = 1.0,
                        .window = window,
                        .tukey_fraction = 0.1};
  const Target still{.name = "t",
                     .position = place,
                     .velocity = place,
                     .strength_db = 1.0,
                     .heading_deg = 1.0,
                     .fluctuation = "swerling-1",
                     .scan_pings = 2};
  const Target seen{.range = 1.0, .bearing_deg = 1.0, .depth = 1.0, .aspect = aspect};
  const Target moving{.waypoints = way, .highlights = {{.offset = place, .strength_db = 1.0}}};
  std::vector<Shown> all{
      {"Cw", "pulse", Cw{}, {Cw{1.0, 1.0, window, 0.1}}},
      {"Lfm", "pulse", Lfm{}, {lfm}},
      {"Hfm", "pulse", Hfm{}, {hfm}},
      {"Sfm", "pulse", Sfm{}, {Sfm{1.0, 1.0, 1.0, 1.0, 1.0, window, 0.1}}},
      {"Costas",
       "pulse",
       Costas{},
       {Costas{.order = two, .step = 1.0, .window = window, .tukey_fraction = 0.1},
        Costas{.prime = 11, .root = 2}}},
      {"Ptfm", "pulse", Ptfm{}, {Ptfm{1.0, 2.0, 2, 1.0, window, 0.1}}},
      {"GeometricComb",
       "pulse",
       GeometricComb{},
       {GeometricComb{1.0, 2.0, 3, 1.2, 1.0, window, 0.1}}},
      {"PulseTrain",
       "pulse",
       PulseTrain{},
       {PulseTrain{.frequency = 1.0, .window = window, .tukey_fraction = 0.1},
        PulseTrain{.start_frequency = 1.0, .end_frequency = 2.0}}},
      {"PulseFile", "pulse", PulseFile{}, {PulseFile{"a.wav"}}, {"samples", "sample_rate"}},
      {"Platform",
       "platform",
       Platform{},
       {Platform{.name = "p", .position = place, .velocity = place}, Platform{.waypoints = way}}},
      {"Waypoint",
       "platform.waypoints",
       Value(Platform{.waypoints = way}).at("waypoints").at(0),
       {Value(Platform{.waypoints = way}).at("waypoints").at(0)}},
      {"Transmitter",
       "transmitter",
       Transmitter{},
       {Transmitter{"t", "p", place, 1.0, 1.0, "hann", 1.0}},
       {"first_ping_time", "interval", "elevations_deg", "kind", "pulse"}},
      {"LineArray",
       "array",
       LineArray{},
       {LineArray{"a", "p", place, 2, 1.0, 1.0, 1.0}},
       {"electronics"}},
      {"PhonePositions",
       "array",
       PhonePositions{},
       {PhonePositions{"a", "p", place, {place}}},
       {"electronics", "shapes"}},
      {"TowedArray",
       "array",
       TowedArray{},
       {TowedArray{"a", "p", place, two, 1.0}},
       {"electronics"}},
      {"Aspect", "target.aspect", Aspect{}, {aspect}, {"angle_deg", "level_db"}},
      {"Highlight",
       "target.highlight",
       Highlight{},
       {Highlight{.offset = place, .strength_db = 1.0}, Highlight{.aspect = aspect}}},
      {"Target",
       "target",
       Target{},
       {still, seen, moving},
       {"hull", "first_ping", "last_ping"},
       {{"highlights", "highlight"}}},
      {"SoundSpeed", "environment.sound_speed", SoundSpeed{}, {SoundSpeed{two, two}}, {"file"}},
      {"Munk", "environment.sound_speed", Munk{}, {Munk{}}},
      {"TemperatureSalinity",
       "environment.sound_speed",
       TemperatureSalinity{},
       {TemperatureSalinity{two, two, two}},
       {"file"}},
      {"SoundSpeedSection",
       "environment.sound_speed",
       SoundSpeedSection{},
       {SoundSpeedSection{two, two, {two, two}}},
       {"file"}},
      {"Bathymetry",
       "environment.bottom.shape",
       Bathymetry{},
       {Bathymetry{two, two}},
       {"file", "material"}},
      law("NrlSurface", "surface", NrlSurface{}),
      law("ChapmanHarris", "surface", ChapmanHarris{}),
      law("OgdenErskine", "surface", OgdenErskine{}),
      law("ScatteringTable", "surface", ScatteringTable{two, two}),
      law("ScatteringTable", "bottom", ScatteringTable{two, two}),
      law("Lambert", "bottom", Lambert{}),
      law("EllisCrowe", "bottom", EllisCrowe{}),
      law("VolumeLayer", "volume", VolumeLayer{}),
  };
  all.back().renamed = {{"top", "depth"}, {"bottom", "depth"}};
  for (const char* kind : {"vacuum", "rigid", "fluid", "elastic", "grain-size"})
    all.push_back(bottom_of(kind));
  return all;
}

/// \param path  "target.highlight"
SettingsList table_of(const std::string& path) {
  SettingsList list = detail::scenario::catalogue();
  for (std::size_t start = 0; start < path.size();) {
    const std::size_t dot = std::min(path.find('.', start), path.size());
    list = below(list, path.substr(start, dot - start));
    start = dot + 1;
  }
  return list;
}

/// Whether there is one with a kind of the table.
bool has_kind(const std::vector<detail::SettingCondition>& conditions, const std::string& kind) {
  return std::all_of(conditions.begin(), conditions.end(), [&](const auto& one) {
    if (!one.place.empty() || one.key != "kind" || one.words.empty() || kind.empty()) return true;
    const bool named = std::find(one.words.begin(), one.words.end(), kind) != one.words.end();
    return named != one.other;
  });
}

std::string first_of(const std::string& path) { return path.substr(0, path.find_first_of(".[")); }

bool is_of(const Value& value, const SettingRecord& record) {
  const auto rows_of = [&] {
    for (std::size_t i = 0; i < value.size(); ++i)
      if (value.at(i).numbers().size() != (record.length == 0 ? 2 : record.length)) return false;
    return true;
  };
  switch (record.type) {
    case Type::number:
      return value.kind() == Value::Kind::number;
    case Type::whole_number:
      return value.kind() == Value::Kind::whole;
    case Type::flag:
      return value.kind() == Value::Kind::flag;
    case Type::text:
    case Type::reference:
      return value.kind() == Value::Kind::text;
    case Type::word:
      return std::find(record.words.begin(), record.words.end(), value.text()) !=
             record.words.end();
    case Type::numbers:
    case Type::axis:
      return value.kind() == Value::Kind::list && value.numbers().size() == value.size();
    case Type::vector:
      return value.numbers().size() == record.length;
    case Type::rows:
    case Type::vectors:
      return rows_of();
  }
  return false;
}

/// The kind that a table has, said or not; "": it is none of several.
std::string kind_of(const Value& value, const SettingsList& list) {
  if (value.has("kind")) return value.at("kind").text();
  for (const SettingRecord& one : list.settings)
    if (one.path == "kind" && one.standard.size() > 2)  // in quotes
      return one.standard.substr(1, one.standard.size() - 2);
  return "";
}

/// A struct beside its table.
struct Comparison {
  const Shown& shown;
  SettingsList list = table_of(shown.table);
  std::string kind = kind_of(shown.full[0], list);

  [[nodiscard]] const SettingRecord* setting(const std::string& key) const {
    for (const SettingRecord& one : list.settings)
      if (one.path == key && has_kind(one.conditions, kind)) return &one;
    return nullptr;
  }
  [[nodiscard]] const TableRecord* table(const std::string& key) const {
    for (const TableRecord& one : list.tables)
      if (first_of(one.path) == key && has_kind(one.conditions, kind)) return &one;
    return nullptr;
  }
  /// Every key of the table with this kind.
  [[nodiscard]] std::set<std::string> keys() const {
    std::set<std::string> all;
    for (const SettingRecord& one : list.settings)
      if (has_kind(one.conditions, kind)) all.insert(first_of(one.path));
    return all;
  }
};

TEST(PublicStructs, HaveKeysAndTypesOfTheDescriptions) {
  for (const Shown& shown : all_structs()) {
    const Comparison beside{shown};
    ASSERT_FALSE(beside.list.settings.empty()) << shown.table;
    for (const Value& full : shown.full)
      for (const std::string& key : full.keys()) {
        const Value value = full.at(key);
        if (beside.table(key) != nullptr) continue;  // a struct of its own
        const SettingRecord* setting = beside.setting(key);
        ASSERT_NE(setting, nullptr) << shown.name << ": " << key;
        EXPECT_TRUE(is_of(value, *setting))
            << shown.name << ": " << key << " = " << value.to_toml();
      }
  }
}

TEST(PublicStructs, HaveTheDefaultsOfTheDescriptions) {
  int compared = 0;
  for (const Shown& shown : all_structs()) {
    const Comparison beside{shown};
    for (const std::string& key : shown.usual.keys()) {
      const SettingRecord* setting = beside.setting(key);
      if (setting == nullptr || setting->standard.empty() || key == "kind") continue;
      EXPECT_EQ(shown.usual.at(key).to_toml(), setting->standard) << shown.name << ": " << key;
      ++compared;
    }
  }
  EXPECT_GT(compared, 20);
}

TEST(PublicStructs, OfferEveryKeyButThoseSetByTheirPaths) {
  for (const Shown& shown : all_structs()) {
    const Comparison beside{shown};
    std::set<std::string> offered;
    for (const Value& full : shown.full)
      for (const std::string& key : full.keys()) offered.insert(key);
    for (const std::string& key : beside.keys())
      EXPECT_TRUE(offered.contains(key) || shown.by_path.contains(key))
          << shown.name << " of kind \"" << beside.kind << "\" does not offer " << key;
    for (const std::string& key : shown.by_path) EXPECT_FALSE(offered.contains(key)) << key;
  }
}

/// "[m]" of a member's comment, by struct and member: the last of its brackets.
std::map<std::string, std::string> units_of_headers() {
  std::map<std::string, std::string> units;
  const std::regex begin(R"(^struct (?:ASDIC_API )?(\w+) \{)");
  const std::regex member(R"((\w+)(?: = [^;]*|\{\})?;\s+///<.*\[([^\]]+)\][^\[]*$)");
  for (const char* header :
       {"array", "environment", "platform", "pulse", "reverberation", "target"}) {
    std::ifstream file(std::string(ASDIC_PUBLIC_HEADERS) + "/" + header + ".h");
    std::string line, name;
    for (std::smatch found; std::getline(file, line);) {
      if (std::regex_search(line, found, begin)) name = found[1];
      if (std::regex_search(line, found, member) && found[2] != "n")
        units[name + "." + found[1].str()] = found[2];
    }
  }
  return units;
}

TEST(PublicStructs, HaveTheUnitsOfTheDescriptions) {
  const std::map<std::string, std::string> other_letters{
      {"°C", "degC"}, {"φ", "phi"}, {"kg/m³", "kg/m3"}};
  int compared = 0;
  const auto headers = units_of_headers();
  for (const Shown& shown : all_structs())
    for (const auto& [member, unit] : headers) {
      if (!member.starts_with(shown.name + ".")) continue;
      std::string key = member.substr(shown.name.size() + 1);
      if (const auto other = shown.renamed.find(key); other != shown.renamed.end())
        key = other->second;
      const SettingRecord* setting = Comparison{shown}.setting(key);
      if (setting == nullptr) continue;  // of another kind
      const auto letters = other_letters.find(unit);
      const std::string written = letters == other_letters.end() ? unit : letters->second;
      EXPECT_TRUE(written.starts_with(setting->quantity.unit) && !setting->quantity.unit.empty())
          << member << " [" << unit << "], not [" << setting->quantity.unit << "]";
      ++compared;
    }
  EXPECT_GT(compared, 40);
}

}  // namespace
}  // namespace asdic
