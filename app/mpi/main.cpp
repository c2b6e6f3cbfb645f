#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/program.h"
#include "app/study_options.h"
#include "app/study_progress.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/ping/provenance.h"
#include "study/mpi/driver.h"

// `asdic-mpi study`: the same study by all ranks of an MPI job. docs/guide/cluster.md
namespace asdic::detail::app {
namespace {

constexpr const char* program_name = "asdic-mpi";

void complain(const std::string& message) { app::complain(program_name, message); }

/// The same for all ranks at a time: where one fails, the first that does tells, and all end alike.
int together(const study::mpi::Session& session, const std::function<void()>& act) {
  std::string said;
  const int status = guarded(act, said);
  const int first = session.first_with(status != success);
  if (first == session.rank()) complain(said);
  // mpirun ends with the status of the first rank that has one
  return first < 0 ? success : first == session.rank() ? status : failure;
}

/// A stop is told at once: mpirun gives its ranks a second.
class StopTeller {
 public:
  StopTeller(const study::mpi::Session& session, const study::StudyRun& run)
      : callback_(run.stop, Tell{session.rank(), run.output.string()}) {}

 private:
  struct Tell {
    int rank;
    std::string output;
    void operator()() const {
      if (rank == 0)
        complain("stopped: the job was told to end, or another rank has died; " + output +
                 ".rank*.journal hold what was made, and the same command goes on");
    }
  };
  std::stop_callback<Tell> callback_;
};

int study_run(const StudyOptions& options, double silence, const study::mpi::Session& session) {
  const auto begin = std::chrono::steady_clock::now();
  std::unique_ptr<StudyOrder> order;
  std::unique_ptr<study::Realiser> realiser;
  study::Work work;
  const int ranks_here = session.ranks_here();
  int status = together(session, [&] {
    order = std::make_unique<StudyOrder>(order_of(options));
    realiser = std::make_unique<study::Realiser>(order->study, ranks_here);
    work = study::work_of(order->study, *realiser);
  });
  if (status != success) return status;
  order->ranks = session.size();
  const std::string identity = session.shared(work.fingerprint.identity);
  status = together(session, [&] {
    if (identity != work.fingerprint.identity)
      throw InputError({.where = options.paths.front(),
                        .got = "another study at rank " + std::to_string(session.rank()) +
                               " (identity " + work.fingerprint.identity + ")",
                        .expected = "the same files at all ranks (identity " + identity + ")"});
  });
  if (status != success) return status;

  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(order->threads));
  const StopOnInterrupt interrupt;
  order->run.stop = interrupt.token();
  order->run.silence = std::chrono::duration<double>(silence);
  const StopTeller teller(session, order->run);
  if (!options.quiet && session.rank() == 0) warn(work.fingerprint.warnings);
  if (const std::string design = study::design_text(order->study);
      !options.quiet && session.rank() == 0 && !design.empty())
    print(design + '\n');
  if (session.rank() == 0) work.realise = study::watched(work, order->run.note);
  study::StudyOutcome outcome;
  std::string said;
  {
    StudyProgress progress(!options.quiet && session.rank() == 0);
    order->run.progress = [&](const study::Progress& p) { progress.update(p); };
    status = guarded([&] { outcome = study::mpi::run_study(work, order->run, session); }, said);
  }
  if (session.rank() != 0) return status;
  if (status != success) {
    complain(said);
    session.abort(status);  // others may wait for an answer
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  status = guarded([&] { report(*order, outcome, options.quiet, wall.count()); }, said);
  if (status != success) complain(said);
  return status;
}

int run(int argc, char** argv) {
  Program program(program_name,
                  "asdic-mpi makes the realisations of a study with all ranks of an MPI job.",
                  version_text());
  StudyOptions options;
  double silence = study::StudyRun{}.silence.count();
  program.add_command(
      "study", "Simulate the realisations of a Monte Carlo study, into one HDF5 file.",
      [&](const Command& command) {
        command.add_option("STUDY", options.paths, "study file (TOML)").required();
        add_study_options(command, options);
        command
            .add_option(
                "--silence", silence,
                "after so long without a word of a rank it is taken for dead, and the job ends [s]")
            .show_default()
            .type_name("SECONDS")
            .check(above_zero());
        command.footer("Example:  mpirun -n 4 asdic-mpi study study.toml -o study.h5");
        command.runs([&] {
          const study::mpi::Session session(argc, argv);
          const int status = study_run(options, silence, session);
          flush_output();  // MPI's end may be the process's
          return status;
        });
      });
  add_help_command(program);
  return program.parse(argc, argv)();  // before MPI: --help needs no ranks
}

}  // namespace
}  // namespace asdic::detail::app

int main(int argc, char** argv) {
  using namespace asdic::detail::app;
  return run_program(program_name, [&] { return run(argc, argv); });
}
