#include "study/measures.h"

namespace asdic::study {

std::vector<Column> measure_columns(const Study& study, const Scenario& scenario) {
  std::vector<Column> columns;
  const std::size_t targets = scenario.targets.size();
  for (std::size_t t = 0; t < targets; ++t) {
    const std::string suffix = targets == 1 ? "" : "_" + std::to_string(t);
    if (study.measure.echo_level)
      columns.push_back({.name = "echo_level_db" + suffix,
                         .unit = "dB re 1 µPa",
                         .meaning = "all paths together: peak of their envelope/√2"});
  }
  return columns;
}

std::vector<double> measure(const Study& study, Scenario scenario) {
  const PingSimulator simulator(std::move(scenario));
  const PingRecord record = simulator.simulate(study.measure.ping);
  std::vector<double> values;
  for (const TargetSummary& target : record.summary)
    if (study.measure.echo_level) values.push_back(target.echo_peak_db);
  return values;
}

}  // namespace asdic::study
