#pragma once

namespace asdic::study {

/// What is made of the rows.
struct SummaryPlan {
  double confidence = 0.95;
};

}  // namespace asdic::study
