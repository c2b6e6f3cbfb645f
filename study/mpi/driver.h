#pragma once
#include <memory>
#include "study/mpi/session.h"
#include "study/runs/run_study.h"

// Studies over MPI: the only place that knows it. docs/formats/study-results.md, "How a run goes"
namespace asdic::detail::study::mpi {

/// run_study() by all ranks together. Rank 0 deals blocks of indices to whoever has few left
/// (itself too), so that uneven work balances; each rank writes a journal of its own beside the
/// output; rank 0 makes the file of all of them. Interrupted or killed, the journals stay, and any
/// number of ranks, or `asdic study`, go on from there.
/// \return at rank 0 what came of it; at others what they made
/// \throws InputError, RunError; at rank 0 what another rank threw, too
StudyOutcome run_study(const Work& work, const StudyRun& run, const Session& session);

}  // namespace asdic::detail::study::mpi
