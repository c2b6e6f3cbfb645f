#include <signal.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>

#include "app/console.h"
#include "app/interrupt.h"
#include "app/provenance.h"
#include "app/study_options.h"
#include "app/study_progress.h"
#include "core/error.h"
#include "study/mpi/driver.h"

// `asdic-mpi study`: the same study by all ranks of an MPI job. docs/guide/cluster.md
namespace asdic::app {
namespace {

enum ExitStatus : int { success = 0, failure = 1, bad_input = 2 };

void complain(const std::string& message) {
  std::fflush(stdout);
  std::fputs(("asdic-mpi: " + message + '\n').c_str(), stderr);
  std::fflush(stderr);
}

/// Does something that may go wrong. \return the exit status; what went wrong is in `said`
int guarded(const std::function<void()>& act, std::string& said) {
  try {
    act();
    return success;
  } catch (const InputError& error) {
    said = error.what();
    return bad_input;
  } catch (const std::bad_alloc&) {
    said = "not enough memory for this run";
  } catch (const std::exception& error) {
    said = error.what();
  }
  return failure;
}

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
  int status = together(session, [&] {
    order = std::make_unique<StudyOrder>(order_of(options));
    realiser = std::make_unique<study::Realiser>(order->study);
    work =
        study::work_of(order->study, [&](std::uint64_t index) { return realiser->realise(index); });
  });
  if (status != success) return status;
  order->ranks = session.size();
  const std::string identity = session.shared(work.imprint.identity);
  status = together(session, [&] {
    if (identity != work.imprint.identity)
      throw InputError({.where = options.path,
                        .got = "another study at rank " + std::to_string(session.rank()) +
                               " (identity " + work.imprint.identity + ")",
                        .expected = "the same files at all ranks (identity " + identity + ")"});
  });
  if (status != success) return status;

  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(order->threads));
  const StopOnInterrupt interrupt;
  order->run.stop = interrupt.token();
  order->run.silence = std::chrono::duration<double>(silence);
  const StopTeller teller(session, order->run);
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
  CLI::App program("asdic-mpi makes the realisations of a study with all ranks of an MPI job.",
                   "asdic-mpi");
  program.set_version_flag("--version", version_text());
  program.require_subcommand(1);
  StudyOptions options;
  CLI::App* command = program.add_subcommand(
      "study", "Simulate the realisations of a Monte Carlo study, into one HDF5 file.");
  add_study_options(*command, options);
  double silence = study::StudyRun{}.silence.count();
  command
      ->add_option(
          "--silence", silence,
          "after so long without a word of a rank it is taken for dead, and the job ends [s]")
      ->capture_default_str()
      ->type_name("SECONDS")
      ->check(above_zero());
  command->footer("Example:  mpirun -n 4 asdic-mpi study study.toml -o study.h5");
  try {
    program.parse(argc, argv);  // before MPI: --help needs no ranks
  } catch (const CLI::Success& help) {
    return program.exit(help);
  } catch (const CLI::ParseError& error) {
    complain(std::string(error.what()) + "; see asdic-mpi study --help");
    return bad_input;
  }
  const study::mpi::Session session(argc, argv);
  const int status = study_run(options, silence, session);
  flush_output();
  return status;
}

}  // namespace
}  // namespace asdic::app

int main(int argc, char** argv) {
  signal(SIGXFSZ, SIG_IGN);  // a file over its limit is a failed write, told as any other
  std::string said;
  int status = 0;
  const int fault = asdic::app::guarded([&] { status = asdic::app::run(argc, argv); }, said);
  if (fault != 0) asdic::app::complain(said);
  return fault != 0 ? fault : status;
}
