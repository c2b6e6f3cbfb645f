#include <algorithm>
#include <filesystem>
#include <map>

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

std::vector<SaltelliGroup> saltelli_groups(const Study& study) {
  std::vector<SaltelliGroup> all;
  std::map<std::size_t, std::size_t> group_at;  // of those of the options: where it stands in `all`
  for (std::size_t v = 0; v < study.variables.size(); ++v) {
    const Variable& variable = study.variables[v];
    if (dimensions_of(variable, false) == 0) continue;
    const auto& given = study.design_options.groups;
    const auto it = std::find_if(given.begin(), given.end(), [&](const auto& names) {
      return std::find(names.begin(), names.end(), variable.name) != names.end();
    });
    if (it != given.end()) {
      const auto [at, is_new] =
          group_at.emplace(static_cast<std::size_t>(it - given.begin()), all.size());
      if (!is_new) {
        all[at->second].name += " + " + variable.name;
        all[at->second].variables.push_back(v);
        continue;
      }
    }
    all.push_back({.name = variable.name, .variables = {v}});
  }
  if (study.design_options.chance) all.push_back({.name = "chance", .variables = {}});
  return all;
}

SaltelliBlocks saltelli_blocks(const Study& study) {
  return {saltelli_groups(study).size(), study.design_options.second_order};
}

Clusters clusters_of(const Study& study) {
  if (study.design == Design::saltelli)
    return {.kind = Clusters::Kind::blocks, .size = saltelli_blocks(study).rows()};
  if (study.design_options.replicates > 1)
    return {.kind = Clusters::Kind::replicates, .size = study.design_options.replicates};
  return {};
}

std::string design_text(const Study& study) {
  const Clusters clusters = clusters_of(study);
  if (clusters.kind == Clusters::Kind::rows) return "";
  const std::string whole = std::to_string(study.realisations / clusters.size),
                    size = std::to_string(clusters.size);
  if (clusters.kind == Clusters::Kind::replicates)
    return size + " independent scrambles of " + whole +
           " points: " + std::to_string(study.realisations) + " realisations";
  std::string names;
  for (const SaltelliGroup& group : saltelli_groups(study))
    names += (names.empty() ? "" : ", ") + group.name;
  return whole + (whole == "1" ? " block of " : " blocks of ") + size + " realisations (A, B and " +
         (study.design_options.second_order ? "two" : "one") + " for each of " + names +
         "): " + std::to_string(study.realisations) + " realisations";
}

std::string identity(const Study& study) {
  // What becomes of a realisation that fails changes none of those that do not.
  std::string text = "asdic study 1;seed=" + std::to_string(study.seed) +
                     ";design=" + std::string(name(study.design)) + ";on_error=stop;";
  if (study.design == Design::latin_hypercube)
    text += "realisations=" + std::to_string(study.realisations) + ";";
  const DesignOptions& options = study.design_options;
  if (options.replicates > 1) text += "replicates=" + std::to_string(options.replicates) + ";";
  if (options.second_order) text += "second_order;";
  if (options.chance) text += "chance;";
  for (const auto& group : options.groups) {
    text += "group=";
    for (const std::string& name : group) text += name + ",";
    text += ";";
  }
  TomlValue scenario = study.scenario;  // without what changes no row
  if (TomlValue* run = scenario.find("run")) {
    erase_key(*run, "memory");
    if (run->table() != nullptr && run->table()->empty()) erase_key(scenario, "run");
  }
  write(scenario, "", study.scenario_path.parent_path(), text);
  for (const char* table : {"vary", "correlation", "measure"})
    if (const TomlValue* value = study.document.find(table))
      write(*value, "", study.path.parent_path(), text);
  // What finds a proposal decides no row of the study that is drawn from it.
  if (const TomlValue* value = study.document.find("rare")) {
    TomlValue rare = *value;
    for (const char* key : {"levels", "rows_per_level"}) erase_key(rare, key);
    write(rare, "", study.path.parent_path(), text);
  }
  // Rows made when it was "around" that was left out are others.
  const TomlValue* measure = study.document.find("measure");
  const TomlValue* filter = measure == nullptr ? nullptr : measure->find("matched_filter");
  if (study.measure.uses_matched_filter() &&
      study.measure.matched_filter.background == MatchedFilterPlan::Background::expected &&
      (filter == nullptr || filter->find("background") == nullptr))
    text += "background=expected;";
  // The order of the variables is that of their lines, which the tree does not tell.
  for (const Variable& variable : study.variables) text += variable.name + ";" + variable.digest;
  for (const OwnMeasure& own : study.measure.own)
    text += "own=" + own.name + ' ' + own.version + ';';
  return sha256(text);
}

}  // namespace asdic::detail::study
