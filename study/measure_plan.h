#pragma once
#include <string>
#include <vector>

namespace asdic::study {

/// What is measured in every realisation.
struct MeasurePlan {
  int ping = 1;   ///< of the scenario, counted from 1
  int array = 0;  ///< an index
  bool echo_level = false;
};

}  // namespace asdic::study
