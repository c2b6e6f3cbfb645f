#pragma once

/// \file
/// The settings that scenario files may have: names, units, ranges, defaults. Programs that ask
/// people for a scenario, or complete what they type, have them from here.
///
/// ```cpp
/// for (const asdic::Setting& setting : asdic::settings())
///   if (setting.path.starts_with("pulse."))
///     std::cout << setting.path << " [" << setting.unit << "]: " << setting.help << '\n';
/// ```

#include <limits>
#include <string>
#include <vector>

#include "asdic/export.h"

namespace asdic {

/// One key of a scenario file.
struct Setting {
  enum class Kind {
    number,
    whole,
    flag,
    text,
    word,     ///< one of `words`
    numbers,  ///< a list
    rows,     ///< a list of lists
    axis,     ///< a number, a list, or {first, last, count}
    vector,   ///< `length` numbers
    vectors,  ///< a list of these
    name      ///< of another table's: of a platform, say
  };
  std::string path;  ///< "pulse.duration", "target[].strength_db"
  Kind kind = Kind::number;
  std::string unit;                                          ///< "m"; "": none
  double lowest = -std::numeric_limits<double>::infinity();  ///< least value that is allowed
  double highest = std::numeric_limits<double>::infinity();
  bool or_zero = false;            ///< 0 is allowed, too, though below `lowest`
  std::vector<std::string> words;  ///< that there are; of a number, in its place: "auto"
  std::size_t length = 0;          ///< of a vector
  std::string standard;            ///< what holds without it, as TOML; "": none, or of others
  std::string otherwise;           ///< what holds without it, in words; "": `standard`
  std::string help;                ///< what it means
  std::string condition;           ///< under which there is one: window = "tukey"
  bool required = false;           ///< it has no default
};

/// One table of a scenario file.
struct SettingTable {
  std::string path;  ///< "environment.bottom", "target[]"
  std::string help;
  bool list = false;         ///< [[path]]
  bool one_or_more = false;  ///< [path], or [[path]] as often as it stands there
};

/// Every setting, in the order of docs/formats/scenario.md.
[[nodiscard]] ASDIC_API const std::vector<Setting>& settings();
[[nodiscard]] ASDIC_API const std::vector<SettingTable>& setting_tables();

}  // namespace asdic
