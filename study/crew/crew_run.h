#pragma once
#include "study/runs/run_study.h"

namespace asdic::detail::study {

/// As run_study(), together with all processes that do the same with the same output, on whatever
/// machines see its folder. They come and go: one that is lost costs the rows that it had in hand.
/// Returns when the file is made, by this or another, or when this one is told to stop.
/// \param run  its `silence`: of a worker that is then taken for gone
/// \throws as run_study(); InputError for an output that holds a part of the rows
StudyOutcome run_crew(const Work& work, const StudyRun& run);

}  // namespace asdic::detail::study
