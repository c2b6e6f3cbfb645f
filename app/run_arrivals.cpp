#include "app/run_arrivals.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/arrivals_output.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/progress_bar.h"
#include "core/error.h"
#include "core/units.h"
#include "io/bellhop/results.h"
#include "io/result/result_file.h"
#include "io/scenario/propagation.h"
#include "io/text/csv_table.h"

namespace asdic::detail::app {
namespace {

/// Calls see(source depth, receiver depth, range, arrivals) for every receiver, range fastest.
template <class See>
void each_receiver(const RunArrivals& all, const See& see) {
  const ReceiverGrid& grid = all.run_case.receivers;
  std::size_t i = 0;
  for (const double source : all.run_case.source_depths)
    for (std::size_t row = 0; row < grid.rows(); ++row)
      for (std::size_t r = 0; r < grid.ranges.size(); ++r, ++i)
        see(source, grid.depths[grid.irregular ? r : row], grid.ranges[r], all.result.arrivals[i]);
}

}  // namespace

RunArrivals find_run_arrivals(const ScenarioChoice& choice,
                              const std::vector<std::string>& more_overrides) {
  std::vector<std::string> overrides = choice.overrides;
  overrides.insert(overrides.end(), more_overrides.begin(), more_overrides.end());
  RunArrivals all;
  std::vector<std::string> warnings;
  all.run_case = read_propagation_case(choice.path, overrides, warnings);
  all.run_case.task = Task::arrivals;
  all.origin = {.title = all.run_case.title,
                .path = choice.path,
                .text = read_text_file(choice.path, "a scenario file"),
                .overrides = overrides,
                .warnings = warnings,
                .origin = all.run_case.origin};
  ProgressBar bar("%", 100, true);
  try {
    until_interrupted([&] {
      all.result = run(
          all.run_case,
          [&](double share) {
            bar.done(100.0 * share);
            return true;
          },
          read_budget(choice.path, overrides));
    });
  } catch (const Interrupted&) {
    throw RunError("interrupted");
  } catch (const InputError& error) {
    throw told_of_scenario(error, choice.path, overrides);
  }
  for (const std::string& note : all.result.notes) tell("asdic: note: " + note);
  return all;
}

std::string run_arrivals_table(const RunArrivals& all) {
  std::string text;
  each_receiver(all, [&](double source, double depth, double range, const Arrivals& arrivals) {
    if (!text.empty()) text += '\n';
    text += emphasised(fmt::format("from {} m to a receiver at {} km, {} m: {}", number(source, 1),
                                   number(range / 1000.0, 3), number(depth, 1),
                                   count_of(arrivals.size(), "path"))) +
            '\n' + paths_table(arrivals);
  });
  return text + arrivals_legend(all.run_case.frequency);
}

std::string run_arrivals_json(const RunArrivals& all) {
  using nlohmann::ordered_json;
  ordered_json legs = ordered_json::array();
  const EarthLine earth(all.run_case);
  each_receiver(all, [&](double source, double depth, double range, const Arrivals& arrivals) {
    ordered_json one = {
        {"leg", "receiver"}, {"source_depth", source}, {"receiver_depth", depth}, {"range", range}};
    if (earth.known()) {
      const GeographicPlace there = earth.at(range);
      one["latitude"] = there.latitude;
      one["longitude"] = there.longitude;
    }
    one["arrivals"] = ordered_json::parse(paths_json(arrivals));
    legs.push_back(one);
  });
  const ordered_json json = {{"filetype", "asdic arrivals"},
                             {"version", "1.0"},
                             {"title", all.origin.title},
                             {"scenario", all.origin.path},
                             {"frequency_hz", all.run_case.frequency},
                             {"warnings", all.origin.warnings},
                             {"notes", all.result.notes},
                             {"legs", legs}};
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

void write_run_arrivals(OutputFile&& to, const RunArrivals& all) {
  const bellhop::ArrivalsFile arrivals = bellhop::arrivals_file(all.run_case, all.result, false);
  if (to.target().extension() == ".arr") {
    bellhop::write_arrivals_file(std::move(to), arrivals);
    return;
  }
  Hdf5Output output(std::move(to));
  write_hdf5_result(output.file(), arrivals, EarthLine(all.run_case));
  write_root(output.file(), "asdic arrivals", all.origin);
  if (!all.result.notes.empty()) output.file().set_attribute("", "notes", all.result.notes);
  output.finish();
}

}  // namespace asdic::detail::app
