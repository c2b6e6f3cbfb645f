#include "asdic/study.h"

#include <algorithm>
#include <thread>

#include "io/hdf5/own_files.h"
#include "io/ping/provenance.h"
#include "library/ping_access.h"
#include "library/watched.h"
#include "study/placement/placement_file.h"
#include "study/placement/placement_reader.h"
#include "study/plan/study.h"
#include "study/reader/study_reader.h"
#include "study/runs/run_study.h"
#include "study/runs/study_file.h"

namespace asdic {
namespace {

StudyResult shown(const detail::study::StudyFile& file) {
  detail::study::Table table = file.table();
  StudyResult result{.complete = file.complete(), .warnings = file.fingerprint().warnings};
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const detail::study::Column& column = table.columns[i];
    if (column.role == detail::study::Column::Role::reuse) continue;  // the file's bookkeeping
    result.columns.push_back(column.name);
    result.units.push_back(column.unit == "1" ? "" : column.unit);
    result.values.emplace_back(table.values[i].begin(), table.values[i].end());
    table.values[i].clear();
  }
  const detail::study::Table own = file.own();
  for (std::size_t i = 0; i < own.columns.size(); ++i) {
    result.columns.push_back(own.columns[i].name);
    result.units.push_back(own.columns[i].unit == "1" ? "" : own.columns[i].unit);
    result.values.emplace_back(own.values[i].begin(), own.values[i].end());
  }
  return result;
}

/// The answer to the study's first question, out of its rows.
void answer(const detail::study::Study& study, const detail::study::Table& table,
            StudyResult& result) {
  detail::study::RunningEstimate estimate(study);
  for (std::size_t i = 0; i < table.index.size(); ++i) {
    detail::study::Row row{.index = table.index[i], .valid = table.valid[i] != 0};
    for (const detail::study::ColumnValues& column : table.values) row.values.push_back(column[i]);
    estimate.add(row);
  }
  const std::optional<detail::study::Estimate> found = estimate.estimate();
  if (!found) return;
  result.question = found->name;
  result.value = found->value;
  result.low = found->low;
  result.high = found->high;
}

/// \throws InputError for a name that is no column's, or that another has
detail::study::OwnMeasure own_measure(const detail::study::Study& study,
                                      const StudyMeasure& asked) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (asked.name.empty() || !std::all_of(asked.name.begin(), asked.name.end(), fits))
    throw InputError("measures", '"' + asked.name + '"', "a name of small letters, digits and _");
  for (const detail::study::Column& column : detail::study::columns(study))
    if (column.name == asked.name)
      throw InputError("measures", '"' + asked.name + "\", which the study has",
                       "a name of its own");
  if (!asked.of) throw InputError("measures", "no function for " + asked.name, "one");
  return {.name = asked.name,
          .unit = asked.unit.empty() ? "1" : asked.unit,
          .meaning = asked.meaning,
          .version = asked.version,
          .samples = asked.samples,
          .of = [of = asked.of, path = study.scenario_path](const detail::TomlValue& drawn,
                                                            const detail::PingSimulator& simulator,
                                                            const detail::PingRecord& record) {
            return of(PingAccess::made(Access::document(drawn, path), simulator, record));
          }};
}

/// options.enough, of the rows that count.
detail::study::EnoughRows enough_of(const StudyOptions& options) {
  if (!options.enough) return {};
  return [&options](const detail::study::Table& rows) {
    StudyResult told;
    for (std::size_t i = 0; i < rows.columns.size(); ++i) {
      told.columns.push_back(rows.columns[i].name);
      told.units.push_back(rows.columns[i].unit == "1" ? "" : rows.columns[i].unit);
      told.values.emplace_back(rows.values[i].begin(), rows.values[i].end());
    }
    return options.enough(told);
  };
}

}  // namespace

std::size_t StudyResult::rows() const noexcept { return values.empty() ? 0 : values[0].size(); }

const std::vector<double>& StudyResult::column(const std::string& name) const {
  const auto at = std::find(columns.begin(), columns.end(), name);
  if (at != columns.end()) return values[static_cast<std::size_t>(at - columns.begin())];
  std::string known;
  for (const std::string& one : columns) known += (known.empty() ? "" : ", ") + one;
  throw InputError("column", '"' + name + '"', "one of " + known);
}

StudyResult study(const std::filesystem::path& file, const std::filesystem::path& output,
                  const StudyOptions& options) {
  return translated(
      [&] {
        const detail::study::Study plan =
            detail::study::read_study(file, options.changes, [&](detail::study::Study& made) {
              for (const StudyMeasure& measure : options.measures)
                made.measure.own.push_back(own_measure(made, measure));
            });
        const detail::study::Realiser realiser(plan);
        const detail::study::Work work = detail::study::work_of(plan, realiser);
        detail::study::StudyRun run{.output = output, .range = {0, plan.realisations}};
        run.fresh = options.fresh;
        run.stop = options.stop;
        run.session.made =
            detail::provenance(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
        run.session.study_path = std::filesystem::absolute(file).string();
        const std::vector<std::string>& until = options.until.empty() ? plan.until : options.until;
        if (!until.empty() || options.enough) {
          const std::string where =
              !options.until.empty() || until.empty() ? "until" : plan.until_where;
          detail::study::check_until(plan, where);
          run.until = detail::study::Until(plan, until, where, enough_of(options));
        }
        if (options.progress)
          run.progress = [&](const detail::study::Progress& p) {
            options.progress(p.done, p.total);
          };
        const detail::study::StudyOutcome outcome = detail::study::run_study(work, run);
        if (options.stop.stop_requested() && !outcome.complete) throw Stopped();
        if (options.progress) options.progress(outcome.before + outcome.made, outcome.total);
        const detail::study::StudyFile written(output);
        StudyResult result = shown(written);
        answer(plan, written.table(), result);
        return result;
      },
      {file, output});
}

std::vector<std::string> write_placement(const std::filesystem::path& output,
                                         const std::filesystem::path& plan,
                                         const std::vector<std::string>& changes,
                                         const Watch& watch) {
  return watched(
      watch,
      [&] {
        const detail::study::PlacementPlan read = detail::study::read_placement(plan, changes);
        detail::OutputRules rules{.own = detail::own::hdf5, .inputs = {plan}, .option = "output"};
        rules.worth = detail::own::pings;
        for (const auto& option : read.options) rules.inputs.push_back(option.path);
        detail::OutputFile file(output, rules);
        const detail::study::Placement found =
            detail::study::place_sensors(read, [&](double share) {
              if (watch.progress) watch.progress(static_cast<int>(1000.0 * share), 1000);
              return true;
            });
        detail::study::write_placement(std::move(file), read, found);
        return found.warnings;
      },
      {plan, output});
}

StudyResult read_study(const std::filesystem::path& output) {
  return translated([&] { return shown(detail::study::StudyFile(output)); }, {output});
}

}  // namespace asdic
