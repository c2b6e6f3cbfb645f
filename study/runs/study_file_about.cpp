// What a study's file says of itself: its root, summary, manifest, and how it came about.
#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "study/runs/study_file_writer.h"

namespace asdic::study {
namespace {

using Json = nlohmann::json;

/// Different texts, in order.
std::vector<std::string> different(const std::vector<Session>& sessions,
                                   const std::function<std::string(const Session&)>& text) {
  std::set<std::string> all;
  for (const Session& session : sessions)
    if (session.rows > 0) all.insert(text(session));
  return {all.begin(), all.end()};
}

std::string joined(const std::vector<std::string>& texts) {
  std::string result;
  for (const std::string& text : texts) result += (result.empty() ? "" : "; ") + text;
  return result;
}

}  // namespace

void StudyFileWriter::write_root() {
  const Imprint& imprint = results_.imprint;
  write_filetype(file_, "asdic study", "1.2");
  file_.set_attribute("", "title", imprint.title);
  file_.set_attribute("", "identity", imprint.identity);
  file_.set_attribute("", "seed", std::to_string(imprint.seed));
  file_.set_attribute("", "design", imprint.design);
  file_.set_attribute("", "realisations", static_cast<std::int64_t>(imprint.realisations));
  file_.set_attribute("", "complete", std::int64_t{results_.complete()});
  if (!results_.stopped_by.empty()) file_.set_attribute("", "stopped_by", results_.stopped_by);
  if (!imprint.overrides.empty()) file_.set_attribute("", "overrides", imprint.overrides);
  if (!imprint.warnings.empty()) file_.set_attribute("", "warnings", imprint.warnings);
  if (std::isfinite(imprint.left_out_db))
    file_.set_attribute("", "left_out_db", imprint.left_out_db);
  file_.set_attribute("", "lasting_scatterers",
                      "as those of one ping (but with a texture, several arrays or "
                      "reverberation.synthesis = \"scatterers\")");
  const auto& sessions = results_.sessions;
  const auto version = [](const Session& s) { return s.made.program_version; };
  const auto build = [](const Session& s) { return s.made.build; };
  file_.set_attribute("", "program_version", joined(different(sessions, version)));
  file_.set_attribute("", "build", joined(different(sessions, build)));
  text("study", imprint.text, "the study file, verbatim");
  text("scenario", imprint.scenario_text, "the scenario file, verbatim");
}

/// The dimension of a table's rows: its axis or, where it has several, one without values.
/// \return the dataset that stands for it
std::string StudyFileWriter::write_rows(const SummaryTable& table, const std::string& group) {
  const auto has_column = [&](const std::string& name) {
    return std::any_of(table.columns.begin(), table.columns.end(),
                       [&](const Column& column) { return column.name == name; });
  };
  std::string name = table.axes.size() == 1 ? table.axes.front() : "cell";
  const std::string path = group + "/";
  if (table.axes.size() == 1) {
    const auto axis = std::find_if(table.columns.begin(), table.columns.end(),
                                   [&](const Column& column) { return column.name == name; });
    const auto& values = table.values[static_cast<std::size_t>(axis - table.columns.begin())];
    file_.write<double>(path + name, values, {values.size()});
    file_.make_scale(path + name, name);
    return path + name;
  }
  while (has_column(name)) name += '_';
  file_.make_dimension(path + name, table.values.empty() ? 0 : table.values.front().size());
  describe(file_, path + name, "no values: a row for each of the axes' combinations");
  return path + name;
}

/// CF's list of what else tells where a value belongs.
void StudyFileWriter::write_coordinates(const SummaryTable& table, const std::string& group) {
  std::vector<std::string> others = table.edges;
  if (table.axes.size() > 1) others.insert(others.begin(), table.axes.begin(), table.axes.end());
  std::string names;
  for (const std::string& name : others) names += (names.empty() ? "" : " ") + name;
  if (names.empty()) return;
  for (const Column& column : table.columns)
    if (std::find(others.begin(), others.end(), column.name) == others.end() &&
        std::find(table.axes.begin(), table.axes.end(), column.name) == table.axes.end())
      file_.set_attribute(group + "/" + column.name, "coordinates", names);
}

void StudyFileWriter::write_summary() {
  const Summary& summary = results_.summary;
  file_.make_group("summary");
  file_.set_attribute("summary", "confidence", summary.confidence);
  file_.set_attribute("summary", "proportion_interval", summary.proportion_interval);
  file_.set_attribute("summary", "intervals", summary.intervals);
  for (const SummaryTable& table : summary.tables) {
    const std::string group = "summary/" + table.name;
    file_.make_group(group);
    file_.set_attribute(group, "title", table.title);
    std::vector<std::string> order;
    const std::string rows = write_rows(table, group);
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const std::string path = group + "/" + table.columns[i].name;
      if (path != rows) {
        file_.write<double>(path, table.values[i], {table.values[i].size()});
        file_.attach_scales(path, {rows});
      }
      describe_column(path, table.columns[i]);
      noted(path, table.values[i]);
      order.push_back(table.columns[i].name);
    }
    write_coordinates(table, group);
    if (!order.empty()) file_.set_attribute(group, "columns", order);
  }
}

void StudyFileWriter::write_manifest() {
  Json datasets = Json::object();
  for (const auto& [name, noted] : noted_)
    datasets[name] = {{"shape", noted.shape}, {"sha256", noted.sha256}};
  const Json manifest = {{"identity", results_.imprint.identity},
                         {"first", results_.range.first},
                         {"end", results_.range.end},
                         {"rows", results_.table.index.size()},
                         {"complete", results_.complete()},
                         {"columns", Json::parse(to_json(results_.imprint.columns))},
                         {"datasets", datasets}};
  file_.write_text("manifest", manifest.dump());
  describe(file_, "manifest", "JSON: what the file is to hold, with SHA-256 of each dataset");
}

void StudyFileWriter::write_run() {
  const auto& sessions = results_.sessions;
  std::string lines;
  double seconds = 0.0;
  for (const Session& session : sessions) {
    lines += to_json(session) + "\n";
    seconds += session.seconds;
  }
  file_.make_group("run");
  file_.write_text("run/sessions", lines);
  describe(file_, "run/sessions", "the runs that made the rows: a line of JSON each");
  file_.set_attribute("run", "seconds", seconds);
  const auto set = [&](const std::string& key,
                       const std::function<std::string(const Session&)>& text) {
    file_.set_attribute("run", key, joined(different(sessions, text)));
  };
  set("host", [](const Session& s) { return s.made.host; });
  set("cpu", [](const Session& s) { return s.made.cpu; });
  set("started", [](const Session& s) { return s.made.started; });
  set("threads", [](const Session& s) { return std::to_string(s.made.threads); });
  set("library_versions", [](const Session& s) { return s.made.library_versions; });
  const Table& table = results_.reuse;
  if (!table.columns.empty()) file_.make_group("run/reuse");
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string path = "run/reuse/" + table.columns[i].name;
    file_.write<double>(path, table.values[i], {table.values[i].size()});
    describe_column(path, table.columns[i]);
    file_.attach_scales(path, {"index"});
  }
}

}  // namespace asdic::study
