#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/command.h"
#include "study/plan/study.h"
#include "study/runs/run_study.h"

// What `asdic study` and `asdic-mpi study` have in common.
namespace asdic::detail::app {

struct StudyOptions {
  std::vector<std::string> paths;  ///< one; of --compare several
  std::string output, range, shard, adapt;
  std::vector<std::string> overrides;
  std::optional<int> threads;
  std::vector<std::string> until;
  bool fresh = false, force = false, assemble = false, retry = false, quiet = false,
       compare = false, join = false, report = false;
  bool pays_no_heed = false;      ///< to study.until: a study of a comparison …
  bool brief = false;             ///< … which says nothing of one round
  std::optional<double> silence;  ///< of workers and ranks [s]
};

/// -o, --set, --until, --fresh, --force, --threads, --quiet.
void add_study_options(const Command& command, StudyOptions& options);

/// What is to be done: the study, and the run that the options describe, but for its stop token and
/// its progress.
struct StudyOrder {
  study::Study study;
  study::StudyRun run;
  int threads = 1;  ///< of each rank
  int ranks = 1;    ///< of MPI
};

/// \throws InputError for a study or options that are wrong
[[nodiscard]] StudyOrder order_of(const StudyOptions& options);

/// "pd: ± 0.03 at the worst (range 12500), asked for ± 0.02"
[[nodiscard]] std::string known_text(const study::Known& known);

/// Says what came of it. \return the exit status \throws RunError if it was interrupted
int report(const StudyOrder& order, const study::StudyOutcome& outcome, bool quiet, double seconds);

}  // namespace asdic::detail::app
