#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/settings_catalogue.h"

namespace asdic::detail::app {

/// A table of a file whose settings are described: docs, schema and `asdic settings` have it from
/// there.
struct SettingsSection {
  std::string document;  ///< whose tables these are: "scenario", "study", "serve"
  std::string path;      ///< of the table there: "reverberation.surface"
  std::string title;     ///< what it is of
  SettingsList (*made)(std::string_view path);

  [[nodiscard]] SettingsList list() const { return made(path); }
  /// But for those of tables that are sections of their own.
  [[nodiscard]] std::vector<SettingRecord> shown() const;
};

/// The path of the section of a file's own keys.
inline constexpr std::string_view top_level = "top-level";

/// Every section that is described; a new one is one line.
[[nodiscard]] std::span<const SettingsSection> settings_sections();

/// One of these, or a table within one of a scenario: "reverberation.surface".
/// \throws InputError naming those that there are
[[nodiscard]] SettingsSection settings_section(std::string_view path);

/// Rows of a Markdown table: key, what it may be, default, meaning.
[[nodiscard]] std::string settings_markdown(std::span<const SettingRecord> records);
/// The same to be read in a terminal.
[[nodiscard]] std::string settings_text(const SettingsSection& section);

/// JSON Schema (draft 2020-12) of a scenario file, for editors.
[[nodiscard]] std::string scenario_schema();
/// The same of one table.
[[nodiscard]] std::string settings_schema(const SettingsSection& section);

/// What holds without a key, in words: its default, or whence one comes. "": nothing does.
[[nodiscard]] std::string default_of(const SettingRecord& record);
/// What it means, and when there is one.
[[nodiscard]] std::string meaning_of(const SettingRecord& record, std::string_view quote);

}  // namespace asdic::detail::app
