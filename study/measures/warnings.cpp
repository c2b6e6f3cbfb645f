#include "study/measures/warnings.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/error.h"
#include "io/scenario/scenario_reader.h"
#include "raytrace/warnings/warnings.h"
#include "sonar/ping/ping.h"
#include "study/measures/sampler.h"

namespace asdic::detail::study {

Judgement judge(const Study& study) {
  constexpr std::uint64_t most = 32;
  Judgement judgement{.warnings = study.warnings};
  bool judged = false;
  const Sampler sampler(study);
  std::set<std::string> keys;
  for (std::uint64_t index = 0; index < std::min(most, study.realisations); ++index) {
    try {
      TomlValue tree = study.scenario;
      sampler.apply(sampler.draw(index), tree);
      Scenario scenario = scenario_of(tree, study.scenario_path);
      std::vector<std::string> notes = scenario.notes;
      if (!std::exchange(judged, true)) {  // of one: it takes a search
        const auto left_out = PingSimulator(std::move(scenario)).judge_paths();
        judgement.left_out_db = left_out.followed.left_out_db;
        add_warnings(left_out.warnings, notes);
      }
      for (const std::string& one : notes)
        if (keys.insert(one.substr(0, one.find(": "))).second)
          judgement.warnings.push_back(
              one + (index == 0 ? "" : " (realisation " + std::to_string(index) + ")"));
    } catch (const InputError&) {
      continue;  // told, or skipped, when it is made
    }
  }
  return judgement;
}

}  // namespace asdic::detail::study
