#include "study/measures/row_cost.h"

#include <ctime>

namespace asdic::detail::study {

std::string_view name(Stage stage) noexcept {
  switch (stage) {
    case Stage::scenario:
      return "reading the scenario";
    case Stage::ocean:
      return "setting up ocean, pulse and grids";
    case Stage::target_paths:
      return "paths to targets";
    case Stage::sea_paths:
      return "paths to what scatters, and its level";
    case Stage::sound:
      return "synthesis of echoes and reverberation";
    case Stage::noise:
      return "noise";
    case Stage::draws:
      return "draws of the expected background";
    case Stage::cells:
      return "cells without an echo";
    case Stage::measures:
      return "matched filter, receiver, measures";
    case Stage::count:
      break;
  }
  return "";
}

double processor_seconds() noexcept {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace asdic::detail::study
