#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "app/settings_sections.h"

namespace asdic::detail::app {
namespace {

struct SettingsCommandOptions {
  std::string section;
  bool markdown = false, schema = false;
};

int tell_settings(const SettingsCommandOptions& options) {
  if (options.schema) {
    print(options.section.empty() ? scenario_schema()
                                  : settings_schema(settings_section(options.section)));
    return 0;
  }
  if (!options.section.empty()) {
    const SettingsSection section = settings_section(options.section);
    print(options.markdown ? settings_markdown(section.shown()) : settings_text(section));
    return 0;
  }
  const auto all = settings_sections();
  for (const SettingsSection& section : all) {
    print(options.markdown ? "## " + section.path + "\n" + settings_markdown(section.shown())
                           : settings_text(section));
    if (&section != &all.back()) print("\n");
  }
  return 0;
}

}  // namespace

void add_settings_command(Program& program) {
  program.add_command(
      "settings", "What files may say: keys, units, ranges, defaults.", [](const Command& command) {
        auto options = std::make_shared<SettingsCommandOptions>();
        command.add_option("SECTION", options->section,
                           "a table, reverberation.surface, say; default: all");
        command.add_flag("--markdown", options->markdown, "as tables, as the manual has them");
        command.add_flag("--schema", options->schema,
                         "as JSON Schema for editors: of SECTION, or of a scenario file");
        command.footer("Example:  asdic settings reverberation.surface");
        command.runs([options] { return tell_settings(*options); });
      });
}

}  // namespace asdic::detail::app
