#include <algorithm>
#include <memory>
#include <vector>

#include "app/command.h"
#include "app/console.h"
#include "app/settings_sections.h"
#include "core/error.h"
#include "core/text.h"

namespace asdic::detail::app {
namespace {

struct SettingsCommandOptions {
  std::string section;
  bool markdown = false, schema = false;
};

/// The sections that were asked for: one by its path, or all. \throws InputError
std::vector<SettingsSection> sections_of(const std::string& path) {
  const auto all = settings_sections();
  if (path.empty()) return {all.begin(), all.end()};
  std::string names;
  for (const SettingsSection& one : all) {
    if (one.path == path) return {one};
    names += (names.empty() ? "" : ", ") + std::string(one.path);
  }
  throw InputError(
      {.where = "SECTION", .got = in_quotes(path), .expected = "one that is described: " + names});
}

int tell_settings(const SettingsCommandOptions& options) {
  std::vector<SettingsSection> sections = sections_of(options.section);
  if (options.schema) {
    // A schema is of one file: of scenarios, where no section says otherwise.
    const std::string_view document = options.section.empty() ? "scenario" : sections[0].document;
    std::erase_if(sections, [&](const auto& one) { return one.document != document; });
    print(settings_schema(sections));
    return 0;
  }
  for (const SettingsSection& section : sections) {
    if (!options.markdown)
      print(settings_text(section));
    else
      print((options.section.empty() ? "## " + std::string(section.path) + "\n" : std::string()) +
            settings_markdown(section.records()));
    if (&section != &sections.back()) print("\n");
  }
  return 0;
}

}  // namespace

void add_settings_command(Program& program) {
  program.add_command(
      "settings", "What files may say: keys, units, ranges, defaults.", [](const Command& command) {
        auto options = std::make_shared<SettingsCommandOptions>();
        command.add_option("SECTION", options->section,
                           "reverberation.surface, say; default: all that are described");
        command.add_flag("--markdown", options->markdown, "as tables, as the manual has them");
        command.add_flag("--schema", options->schema,
                         "as JSON Schema for editors: of SECTION, or of all of a scenario's");
        command.footer("Example:  asdic settings reverberation.surface");
        command.runs([options] { return tell_settings(*options); });
      });
}

}  // namespace asdic::detail::app
