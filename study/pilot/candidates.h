#pragma once
#include <string>
#include <vector>

#include "study/plan/study.h"

namespace asdic::detail::study {

/// Something to turn that may make rows cheaper.
struct Candidate {
  std::vector<std::string> overrides;  ///< as of --set
  std::string loses;                   ///< what the answer loses by it, in words
};

/// Those that change this study.
[[nodiscard]] std::vector<Candidate> candidates(const Study& study);

}  // namespace asdic::detail::study
