#include "study/journal/fingerprint.h"

#include <algorithm>

#include <nlohmann/json.hpp>
#include <set>

#include "io/scenario/ocean.h"
#include "study/measures/warnings.h"
#include "study/sampling/design.h"

namespace asdic::detail::study {

using Json = nlohmann::json;

namespace {

std::string_view name(Column::Role role) noexcept {
  switch (role) {
    case Column::Role::input:
      return "input";
    case Column::Role::reuse:
      return "reuse";
    case Column::Role::weight:
      return "weight";
    case Column::Role::ping:
      return "ping";
    case Column::Role::measure:
      break;
  }
  return "measure";
}

Column::Role role(const std::string& text) {
  return text == "input"    ? Column::Role::input
         : text == "reuse"  ? Column::Role::reuse
         : text == "weight" ? Column::Role::weight
         : text == "ping"   ? Column::Role::ping
                            : Column::Role::measure;
}

/// "A, B and 2 more" of different texts.
std::string listed(const std::set<std::string>& texts) {
  std::string result;
  std::size_t n = 0;
  for (const std::string& text : texts) {
    if (n++ == 3) return result + " and " + std::to_string(texts.size() - 3) + " more";
    result += (result.empty() ? "" : "; ") + text;
  }
  return result;
}

/// [environment.origin] of the scenario.
std::optional<OriginAttributes> origin_of(const Study& study) {
  const TomlValue* const environment = study.scenario.find("environment");
  if (environment == nullptr || environment->find("origin") == nullptr) return std::nullopt;
  TomlTable table(*environment, "environment");
  return attributes_of(scenario::read_origin(table));
}

}  // namespace

Fingerprint fingerprint_of(const Study& study) {
  std::vector<Column> all = columns(study);
  all.insert(all.end(), reuse_columns().begin(), reuse_columns().end());
  Judgement judgement = judge(study);
  return {.identity = identity(study),
          .title = study.title,
          .seed = study.seed,
          .realisations = study.realisations,
          .design = std::string(name(study.design)),
          .text = study.text,
          .scenario_text = study.scenario_text,
          .origin = origin_of(study),
          .overrides = study.overrides,
          .warnings = std::move(judgement.warnings),
          .left_out_db = judgement.left_out_db,
          .columns = std::move(all),
          .cells = cell_shape(study)};
}

std::string to_json(const std::vector<Column>& columns) {
  Json all = Json::array();
  for (const Column& c : columns)
    all.push_back({{"name", c.name},
                   {"unit", c.unit},
                   {"meaning", c.meaning},
                   {"role", name(c.role)},
                   {"labels", c.labels}});
  return all.dump();
}

std::vector<Column> columns_from_json(const std::string& text) {
  std::vector<Column> columns;
  for (const Json& c : Json::parse(text))
    columns.push_back({.name = c.at("name"),
                       .unit = c.at("unit"),
                       .meaning = c.at("meaning"),
                       .role = role(c.at("role")),
                       .labels = c.at("labels")});
  return columns;
}

std::string to_json(const Session& session) {
  const Provenance& made = session.made;
  return Json{{"program_version", made.program_version},
              {"build", made.build},
              {"host", made.host},
              {"started", made.started},
              {"cpu", made.cpu},
              {"library_versions", made.library_versions},
              {"threads", made.threads},
              {"study_path", session.study_path},
              {"rows", session.rows},
              {"seconds", session.seconds}}
      .dump();
}

Session session_from_json(const std::string& text) {
  const Json json = Json::parse(text);
  return {.made = {.program_version = json.at("program_version"),
                   .build = json.at("build"),
                   .host = json.at("host"),
                   .started = json.at("started"),
                   .cpu = json.at("cpu"),
                   .library_versions = json.at("library_versions"),
                   .threads = json.at("threads")},
          .study_path = json.at("study_path"),
          .rows = json.at("rows"),
          .seconds = json.at("seconds")};
}

Table take_reuse(Table& table) {
  Table reuse{.columns = {}, .index = {}, .valid = {}, .values = {}};
  for (std::size_t i = 0; i < table.columns.size();) {
    if (table.columns[i].role != Column::Role::reuse) {
      ++i;
      continue;
    }
    const auto at = static_cast<std::ptrdiff_t>(i);
    reuse.columns.push_back(std::move(table.columns[i]));
    reuse.values.push_back(std::move(table.values[i]));
    table.columns.erase(table.columns.begin() + at);
    table.values.erase(table.values.begin() + at);
  }
  return reuse;
}

std::string how_changed(const std::string& before, const std::string& now) {
  if (before == now)
    return ", or of this one before something else than the study file changed (its scenario, "
           "a --set, a file that they name)";
  const auto [was, is] = std::mismatch(before.begin(), before.end(), now.begin(), now.end());
  const auto line = 1 + std::count(now.begin(), is, '\n');
  return ", or of this one before it changed (line " + std::to_string(line) + " of the study file)";
}

std::string mixed_builds(const std::vector<Session>& sessions) {
  std::set<std::string> builds, processors;
  for (const Session& session : sessions) {
    if (session.rows == 0) continue;
    builds.insert(session.made.program_version + " (" + session.made.build + ")");
    processors.insert(session.made.cpu);
  }
  std::string what;
  if (builds.size() > 1) what = "builds of the program: " + listed(builds);
  if (processors.size() > 1)
    what += (what.empty() ? "" : "; of different ") + ("processors: " + listed(processors));
  return what.empty() ? "" : "rows were made by different " + what + "; their last bits may differ";
}

}  // namespace asdic::detail::study
