#include "study/warnings.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "io/scenario_reader.h"
#include "study/sampler.h"

namespace asdic::study {

std::vector<std::string> warnings(const Study& study) {
  constexpr std::uint64_t most = 32;
  std::vector<std::string> all = study.warnings;
  const Sampler sampler(study);
  std::set<std::string> keys;
  for (std::uint64_t index = 0; index < std::min(most, study.realisations); ++index) {
    try {
      TomlValue tree = study.scenario;
      sampler.apply(sampler.draw(index), tree);
      for (const std::string& one : scenario_of(tree, study.scenario_path).notes)
        if (keys.insert(one.substr(0, one.find(": "))).second)
          all.push_back(one + (index == 0 ? "" : " (realisation " + std::to_string(index) + ")"));
    } catch (const InputError&) {
      continue;  // told, or skipped, when it is made
    }
  }
  return all;
}

}  // namespace asdic::study
