#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace asdic::detail {

struct TomlEntry;

/// A value of a TOML document that remembers where it was written.
///
/// Our own tree instead of toml++'s: documents can be merged (include, --set) while every value
/// keeps its file and line, and toml++ stays in one .cpp file.
struct TomlValue {
  using Array = std::vector<TomlValue>;
  using Table = std::vector<TomlEntry>;  // in the order of keys as toml++ gives it (sorted)

  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table> data;
  std::string origin;    ///< "deep_ocean.toml:12", or "--set pulse.duration"
  bool in_line = false;  ///< a table that is written on the line of its key

  [[nodiscard]] const Table* table() const { return std::get_if<Table>(&data); }
  [[nodiscard]] Table* table() { return std::get_if<Table>(&data); }
  [[nodiscard]] const TomlValue* find(std::string_view key) const;  ///< null: no table, or no key
  [[nodiscard]] TomlValue* find(std::string_view key);

  /// What an error message calls it: `"hann"`, `4000`, `an array of 3`, `a table`.
  [[nodiscard]] std::string describe() const;
};

struct TomlEntry {
  std::string key;
  TomlValue value;
};

/// \param file  named in every origin and message
/// \throws InputError with line and column if the text is not TOML, or has dates (we use none)
[[nodiscard]] TomlValue parse_toml(std::string_view text, const std::string& file);

/// Adds to `base` what it does not say itself. Tables merge key by key, except that a table of
/// `base` with a `kind` of its own stands as it is: another kind's keys would not fit it.
void merge_defaults(TomlValue& base, const TomlValue& fragment);

/// One `key=value` of the command line: replaces (or adds) the value at a dotted path with array
/// indices, `target.0.strength_db=20`. The value is TOML; a bare word is a string.
/// \throws InputError if the path leads through something that is no table or past an array's end
void apply_override(TomlValue& root, const std::string& assignment);

/// The place at a dotted path with array indices, made (as an empty table) where there is none.
/// \param origin  "--set pulse.duration": named in messages, and where new tables come from
/// \throws InputError as apply_override
[[nodiscard]] TomlValue& value_at(TomlValue& root, std::string_view path,
                                  const std::string& origin);

/// What stands at a dotted path with array indices; null: nothing.
[[nodiscard]] const TomlValue* find_at(const TomlValue& root, std::string_view path);
/// Takes out what stands at a dotted path, if there is something.
void erase_at(TomlValue& root, std::string_view path);

/// Sets a key of a table, or adds it.
void set_key(TomlValue& table, const std::string& key, TomlValue value);
/// Takes a key out of a table, if it is there.
void erase_key(TomlValue& table, const std::string& key);

}  // namespace asdic::detail
