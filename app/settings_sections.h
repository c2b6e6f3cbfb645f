#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "core/settings_catalogue.h"

namespace asdic::detail::app {

/// A table of a file whose settings are described: docs, schema and `asdic settings` have it from
/// there.
struct SettingsSection {
  std::string_view document;  ///< whose tables these are: "scenario", "study", "serve"
  std::string_view path;      ///< of the table there: "reverberation.surface"
  std::string_view title;     ///< what it is of
  std::vector<SettingRecord> (*made)(std::string_view path);
  bool several = false;  ///< it may stand several times, [[path]]

  [[nodiscard]] std::vector<SettingRecord> records() const { return made(path); }
};

/// Every section that is described; a new one is one line.
[[nodiscard]] std::span<const SettingsSection> settings_sections();

/// Rows of a Markdown table: key, what it may be, default, meaning.
[[nodiscard]] std::string settings_markdown(std::span<const SettingRecord> records);
/// The same to be read in a terminal.
[[nodiscard]] std::string settings_text(const SettingsSection& section);
/// JSON Schema (draft 2020-12) of tables of one document, for editors.
[[nodiscard]] std::string settings_schema(std::span<const SettingsSection> sections);

}  // namespace asdic::detail::app
