#include <filesystem>

#include "io/files/digest.h"
#include "io/text/csv_table.h"
#include "io/text/toml_writer.h"
#include "study/plan/study.h"

namespace asdic::detail::study {
namespace {

/// Values without where they were written; what files hold, not what they are called.
void write(const TomlValue& value, const std::string& key, const std::filesystem::path& folder,
           std::string& text) {
  if (const auto* table = value.table()) {
    text += '{';
    for (const TomlEntry& entry : *table) {
      text += entry.key + '=';
      write(entry.value, entry.key, folder, text);
    }
    text += '}';
  } else if (const auto* array = std::get_if<TomlValue::Array>(&value.data)) {
    text += '[';
    for (const TomlValue& item : *array) write(item, key, folder, text);
    text += ']';
  } else if (const auto* real = std::get_if<double>(&value.data)) {
    text += toml_number(*real);
  } else if (const auto* name = std::get_if<std::string>(&value.data);
             name != nullptr && (key == "file" || key == "casts") &&
             std::filesystem::is_regular_file(folder / *name)) {
    text += "file " + sha256(read_text_file(folder / *name));
  } else {
    text += value.describe();
  }
  text += ',';
}

}  // namespace

std::string identity(const Study& study) {
  // What becomes of a realisation that fails changes none of those that do not.
  std::string text = "asdic study 1;seed=" + std::to_string(study.seed) +
                     ";design=" + std::string(name(study.design)) + ";on_error=stop;";
  if (study.design == Design::latin_hypercube)
    text += "realisations=" + std::to_string(study.realisations) + ";";
  TomlValue scenario = study.scenario;  // without what changes no row
  if (TomlValue* run = scenario.find("run")) {
    erase_key(*run, "memory");
    if (run->table() != nullptr && run->table()->empty()) erase_key(scenario, "run");
  }
  write(scenario, "", study.scenario_path.parent_path(), text);
  for (const char* table : {"vary", "measure"})
    if (const TomlValue* value = study.document.find(table))
      write(*value, "", study.path.parent_path(), text);
  // Rows made when it was "around" that was left out are others.
  const TomlValue* measure = study.document.find("measure");
  const TomlValue* filter = measure == nullptr ? nullptr : measure->find("matched_filter");
  if (study.measure.uses_matched_filter() &&
      study.measure.matched_filter.background == MatchedFilterPlan::Background::expected &&
      (filter == nullptr || filter->find("background") == nullptr))
    text += "background=expected;";
  // The order of the variables is that of their lines, which the tree does not tell.
  for (const Variable& variable : study.variables) text += variable.name + ";";
  for (const OwnMeasure& own : study.measure.own)
    text += "own=" + own.name + ' ' + own.version + ';';
  return sha256(text);
}

}  // namespace asdic::detail::study
