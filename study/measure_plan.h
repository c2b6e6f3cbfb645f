#pragma once

namespace asdic::study {

/// What is measured in every realisation.
struct MeasurePlan {};

}  // namespace asdic::study
