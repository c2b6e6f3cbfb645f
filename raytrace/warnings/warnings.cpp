#include "raytrace/warnings/warnings.h"

#include <algorithm>
#include <string>

namespace asdic::detail {

void add_warnings(const std::vector<std::string>& more, std::vector<std::string>& all) {
  for (const std::string& one : more)
    if (!one.empty() && std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
}

std::vector<std::string> warnings(const Environment& ocean, double lowest, double highest) {
  std::vector<std::string> all;
  add_warnings({checks::profile_reach(ocean), checks::absorption_range(ocean, lowest, highest),
                checks::bubble_range(ocean, lowest, highest), checks::gaining_boundary(ocean)},
               all);
  return all;
}

std::vector<std::string> warnings(const PropagationCase& run_case) {
  std::vector<std::string> all =
      warnings(run_case.environment, run_case.frequency, run_case.frequency);
  add_warnings({checks::silent_beams(run_case)}, all);
  return all;
}

}  // namespace asdic::detail
