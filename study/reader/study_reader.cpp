#include "study/reader/study_reader.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/text.h"
#include "io/scenario/document.h"
#include "io/scenario/scenario_reader.h"
#include "io/text/csv_table.h"
#include "io/text/toml_table.h"
#include "study/measures/sampler.h"
#include "study/plan/target_keys.h"
#include "study/reader/correlation_reader.h"
#include "study/reader/measure_reader.h"
#include "study/reader/rare_reader.h"
#include "study/reader/summary_reader.h"
#include "study/reader/vary_reader.h"
#include "study/summary/summary_parts.h"
#include "study/summary/until.h"

namespace asdic::detail::study {
namespace {

constexpr std::array<std::string_view, 7> study_tables{"study",   "set",  "vary",   "correlation",
                                                       "measure", "rare", "summary"};

bool is_study_table(std::string_view key) {
  return std::find(study_tables.begin(), study_tables.end(), key) != study_tables.end();
}

/// Whether an override "study.seed=3" is of the study's own tables.
bool is_of_study(const std::string& assignment) {
  return is_study_table(std::string_view(assignment).substr(0, assignment.find_first_of(".=")));
}

/// Keeps the study's own tables, or all but them.
TomlValue keep(TomlValue document, bool own) {
  if (TomlValue::Table* table = document.table())
    std::erase_if(*table, [&](const TomlEntry& entry) { return is_study_table(entry.key) != own; });
  return document;
}

/// until = 0.05, "pd_by_range=0.1", or an array of these.
void read_until(TomlTable& table, Study& study) {
  if (!table.has("until")) return;
  study.until_where = table.where("until");
  const TomlValue& value = *study.document.find("study")->find("until");
  const auto read = [&](const TomlValue& one, const std::string& key) {
    if (const auto* text = std::get_if<std::string>(&one.data))
      study.until.push_back(*text);
    else if (const std::optional<double> number = number_of(one))
      study.until.push_back(to_text(*number));
    else
      throw table.fault(key, "a number, a text as --until takes it, or an array of these",
                        one.describe());
  };
  const auto* items = std::get_if<TomlValue::Array>(&value.data);
  if (items == nullptr) return read(value, "until");
  for (std::size_t i = 0; i < items->size(); ++i)
    read((*items)[i], "until[" + std::to_string(i) + "]");
}

void read_head(TomlTable table, Study& study) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  study.title = table.text("title", "");
  study.seed = static_cast<std::uint64_t>(table.integer("seed", 0, most, 1));
  const std::string design =
      table.choice("design", {"random", "latin_hypercube", "sobol", "grid", "saltelli"}, "random");
  for (const Design d : {Design::latin_hypercube, Design::sobol, Design::grid, Design::saltelli})
    if (design == name(d)) study.design = d;
  const auto of = [&](const char* key, Design owner) {
    const bool there = table.has(key);
    if (there && study.design != owner)
      throw table.fault(key, "no \"" + std::string(key) + "\" but beside design = \"" +
                                 std::string(name(owner)) + "\"");
    return there;
  };
  DesignOptions& options = study.design_options;
  if (of("replicates", Design::sobol))
    options.replicates = static_cast<std::uint64_t>(table.integer("replicates", 1, 1024));
  if (of("second_order", Design::saltelli))
    options.second_order = table.flag("second_order", false);
  if (of("chance", Design::saltelli)) options.chance = table.flag("chance", false);
  constexpr std::int64_t plenty = 1'000'000'000'000'000;
  const std::int64_t last = study.design == Design::sobol ? std::int64_t{1} << 32 : plenty;
  static_cast<void>(of("groups", Design::saltelli));  // once [vary] is known
  if (of("blocks", Design::saltelli)) {               // times their rows, once [vary] is known
    if (table.has("realisations"))
      throw table.fault("realisations", "no \"realisations\" beside blocks");
    study.realisations = static_cast<std::uint64_t>(table.integer("blocks", 2, plenty / 1000));
  } else if (study.design != Design::grid || table.has("realisations")) {  // else: of the grid once
    study.realisations = static_cast<std::uint64_t>(table.integer("realisations", 1, last));
  }
  if (table.choice("on_error", {"stop", "skip"}, "stop") == "skip") study.on_error = OnError::skip;
  static_cast<void>(table.has("scenario"));
  read_until(table, study);
  table.finish();
}

/// [set]: keys of the scenario, by their paths, that the study changes for good.
void apply_set(const TomlValue& document, TomlValue& scenario) {
  const TomlValue* set = document.find("set");
  if (set == nullptr) return;
  static_cast<void>(TomlTable(*set, "set"));  // must be a table
  for (const TomlEntry& entry : std::get<TomlValue::Table>(set->data))
    value_at(scenario, entry.key, entry.value.origin) = entry.value;
}

/// The tree that the variables edit: of the file that [study] names, or of what the study file
/// holds beside its own tables.
void read_scenario_tree(TomlTable head, const TomlValue& document, Study& study) {
  std::vector<std::string> overrides, includes;  // which file to include comes first
  for (const std::string& assignment : study.overrides) {
    if (is_of_study(assignment)) continue;
    overrides.push_back(assignment);
    if (assignment.starts_with("include=")) includes.push_back(assignment);
  }
  if (head.has("scenario")) {
    study.scenario_path = study.path.parent_path() / head.text("scenario");
    if (!std::filesystem::exists(study.scenario_path))
      throw head.fault("scenario", "a scenario file",
                       "no such file \"" + study.scenario_path.string() + '"');
    for (const TomlEntry& entry : std::get<TomlValue::Table>(document.data))
      if (!is_study_table(entry.key))
        throw InputError({.where = entry.value.origin + ": " + entry.key,
                          .got = "a key of the scenario beside study.scenario",
                          .expected = "[study], [set], [vary], [correlation], [measure], "
                                      "[rare] and [summary] alone"});
    study.scenario_text = read_text_file(study.scenario_path);
  } else {
    study.scenario_path = study.path;
    study.scenario_text = study.text;
  }
  study.scenario =
      keep(scenario::read_document(study.scenario_text, study.scenario_path, includes), false);
  apply_set(document, study.scenario);
  for (const std::string& assignment : overrides) apply_override(study.scenario, assignment);
}

/// groups = [["wind_speed", "depth"], …]: names of entries of [vary].
void read_groups(TomlTable& head, Study& study) {
  if (!head.has("groups")) return;
  std::vector<std::string> names, taken;
  std::string list;
  for (const Variable& variable : study.variables) {
    names.push_back(variable.name);
    list += (list.empty() ? "" : ", ") + in_quotes(variable.name);
  }
  const TomlValue& value = *study.document.find("study")->find("groups");
  const auto* groups = std::get_if<TomlValue::Array>(&value.data);
  if (groups == nullptr) throw head.fault("groups", "an array of arrays of inputs, " + list);
  for (std::size_t g = 0; g < groups->size(); ++g) {
    const std::string key = "groups[" + std::to_string(g) + "]";
    const auto* group = std::get_if<TomlValue::Array>(&(*groups)[g].data);
    if (group == nullptr || group->empty()) throw head.fault(key, "an array of inputs, " + list);
    study.design_options.groups.emplace_back();
    for (std::size_t i = 0; i < group->size(); ++i) {
      const std::string at = key + "[" + std::to_string(i) + "]";
      const auto* name = std::get_if<std::string>(&(*group)[i].data);
      if (name == nullptr || std::find(names.begin(), names.end(), *name) == names.end())
        throw head.fault(at, "an input, one of " + list, (*group)[i].describe());
      if (std::find(taken.begin(), taken.end(), *name) != taken.end())
        throw head.fault(at, "every input once", in_quotes(*name) + " twice");
      taken.push_back(*name);
      study.design_options.groups.back().push_back(*name);
    }
  }
}

/// Rows of designs that are made of blocks or replicates: whole ones. \param head  [study]
/// Correlated inputs are one group: which of them an index is due to nobody can tell.
void group_correlated(const TomlTable& head, Study& study) {
  if (study.design != Design::saltelli || study.correlation.inputs.empty()) return;
  std::vector<std::string> names;
  for (const std::size_t v : study.correlation.inputs) names.push_back(study.variables[v].name);
  auto& groups = study.design_options.groups;
  const auto in = [](const std::vector<std::string>& group) {
    return [&group](const std::string& name) {
      return std::find(group.begin(), group.end(), name) != group.end();
    };
  };
  for (const std::vector<std::string>& group : groups) {
    if (std::all_of(names.begin(), names.end(), in(group))) return;
    if (std::any_of(names.begin(), names.end(), in(group)))
      throw head.fault("groups", "the inputs of [correlation] in one group");
  }
  groups.push_back(std::move(names));
}

void settle_rows(TomlTable head, Study& study) {
  if (study.design == Design::saltelli && saltelli_groups(study).empty())
    throw head.fault("design", "inputs in [vary], whose indices it is for");
  if (study.design_options.chance)
    for (const Variable& variable : study.variables)
      if (variable.name == "chance")
        throw head.fault("chance",
                         "no input of that name (name = \"…\" of " + variable.origin + ")");
  read_groups(head, study);
  group_correlated(head, study);
  const Clusters clusters = clusters_of(study);
  if (head.has("blocks")) study.realisations *= clusters.size;
  const std::uint64_t over = study.realisations % clusters.size;
  if (clusters.kind == Clusters::Kind::rows) return;
  const std::uint64_t least =
      clusters.kind == Clusters::Kind::blocks ? 2 * clusters.size : clusters.size;
  if (over == 0 && study.realisations >= least) return;
  const std::uint64_t next = std::max(least, study.realisations - over + clusters.size);
  const std::string what =
      clusters.kind == Clusters::Kind::blocks
          ? "the rows of a block (A, B and " +
                std::string(study.design_options.second_order ? "two" : "one") +
                " for each of the " + std::to_string(saltelli_groups(study).size()) +
                " groups), such as "
          : "the replicates, such as ";
  throw head.fault("realisations", "a multiple of " + std::to_string(clusters.size) + ", " + what +
                                       std::to_string(next));
}

}  // namespace

Study read_study(const std::filesystem::path& path, std::span<const std::string> overrides,
                 const std::function<void(Study&)>& measures) {
  Study study;
  study.path = path;
  study.text = read_text_file(path, "a study file");
  study.overrides.assign(overrides.begin(), overrides.end());
  study.document = parse_toml(study.text, path.string());
  for (const std::string& assignment : overrides)
    if (is_of_study(assignment)) apply_override(study.document, assignment);
  TomlTable root(study.document);
  if (!root.has("study"))
    throw root.fault("study", "a [study] with its realisations: a study file", "no [study]");
  read_head(root.table("study"), study);
  read_scenario_tree(root.table("study"), study.document, study);
  study.document = keep(std::move(study.document), true);
  TomlTable own(study.document);
  study.variables = read_vary(study.document, study);
  for (const Variable& variable : study.variables)
    for (const std::string& note : variable.notes)
      study.warnings.push_back(variable.origin + ": vary." + variable.name + ": " + note);
  if (own.has("correlation"))
    study.correlation = read_correlation(own.table("correlation"),
                                         *study.document.find("correlation"), study.variables);
  settle_rows(root.table("study"), study);
  TomlTable head = root.table("study"), rare = own.table("rare");
  read_proposals(head, rare, study);
  if (study.realisations == 0) study.realisations = grid_points(study.variables);
  make_room(study.variables, study.scenario_path, study.scenario);
  study.measure = read_measure(own.table("measure"), example_of(study));
  if (own.table("measure").has("signal_excess"))
    study.warnings.push_back(own.table("measure").where("signal_excess") +
                             ": old name of echo_to_background, before any processing; it will "
                             "go. detection_signal_excess counts processing gain and threshold");
  if (measures) measures(study);
  read_event(rare, columns(study), study);
  rare.finish();
  if (study.rare.event && !is_weighted(study))
    study.warnings.push_back(rare.where("event") +
                             ": rows are drawn from the inputs' own laws; --adapt finds from where "
                             "the event is reached with fewer of them");
  study.summary =
      read_summary(own.table("summary"), study.document.find("summary"), columns(study));
  check_summary_names(study);
  if (!study.until.empty()) {
    check_until(study, study.until_where);
    static_cast<void>(Until(study, study.until, study.until_where));
  }
  return study;
}

}  // namespace asdic::detail::study
