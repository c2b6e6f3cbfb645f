#pragma once

namespace asdic::study {

/// What is made of the rows.
struct SummaryPlan {};

}  // namespace asdic::study
