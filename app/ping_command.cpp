#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/ping_report.h"
#include "app/progress_bar.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/hdf5/own_files.h"
#include "io/ping/drawn_rays.h"
#include "io/ping/provenance.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "raytrace/parallel/stop.h"
#include "raytrace/propagation.h"
#include "sonar/ping/run_pings.h"

namespace asdic::detail::app {
namespace {

struct PingOptions {
  ScenarioChoice scenario;
  std::string output;
  std::optional<int> pings, threads;
  std::optional<std::int64_t> seed;
  bool time_axis = false, force = false, quiet = false;
};

/// --pings and --seed are overrides like any other: so the file tells of them.
std::vector<std::string> overrides(const PingOptions& options) {
  std::vector<std::string> all = options.scenario.overrides;
  if (options.pings) all.push_back(fmt::format("pings.count={}", *options.pings));
  if (options.seed) all.push_back(fmt::format("seed={}", *options.seed));
  return all;
}

constexpr const char* before_the_first =
    "interrupted before the first ping was done; no file was written";

/// What Ctrl-C left. \return the exit status
int interrupted(int done, int count, const std::filesystem::path& output) {
  if (done == 0) throw RunError(before_the_first);
  throw RunError(fmt::format("interrupted after {} of {}; {} holds them, marked as not complete",
                             done, count_of(std::size_t(count), "ping"), output.string()));
}

/// What runs that did not end have left of this output.
void tell_of_parts(const std::filesystem::path& output) {
  for (const std::filesystem::path& part : parts_of(output)) {
    if (!own::pings(part)) continue;
    fmt::print(stderr,
               "asdic: note: {} is of a run that did not end; asdic recover makes a file of its "
               "pings\n",
               part.string());
  }
}

/// How far a run is: pings that are done, and the steps of those in hand.
class PingProgress {
 public:
  explicit PingProgress(bool show) : bar_("preparing", show) {}

  void doing(std::string_view what) { bar_.doing(what); }
  /// From now on pings are counted.
  void begin(int count) {
    bar_.count("ping", count);
    alone_ = count == 1;
  }
  void step(int ping, double share, std::string_view what) {
    const std::lock_guard lock(mutex_);
    in_hand_[ping] = share;
    if (alone_ || done_ == 0) bar_.doing(what);
    show();
  }
  void done(int ping) {
    const std::lock_guard lock(mutex_);
    in_hand_.erase(ping);
    ++done_;
    if (!alone_) bar_.doing("");
    show();
  }

 private:
  void show() {
    double in_hand = 0.0;
    for (const auto& [ping, share] : in_hand_) in_hand += share;
    bar_.done(done_, in_hand);
  }

  std::mutex mutex_;
  std::map<int, double> in_hand_;  // ping: share of its steps
  int done_ = 0;
  bool alone_ = false;
  ProgressBar bar_;
};

int ping(const PingOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Scenario scenario = read_scenario(options.scenario.path, overrides(options));
  const std::filesystem::path path =
      options.output.empty() ? std::filesystem::path(options.scenario.path).stem().string() + ".h5"
                             : options.output;
  StopOnInterrupt interrupt;  // before there is a file that it would leave
  OutputFile output(path, rules_for(path, options.force, options.scenario.path));
  if (!options.quiet) {
    warn(scenario.notes);
    tell_of_parts(path);
  }
  const std::string part = output.part().string();
  interrupt.tell(
      fmt::format("asdic: stopping now, the pings in hand are left; Ctrl-C again ends at once, "
                  "then {} holds those before",
                  part));

  const int threads = options.threads.value_or(tbb::info::default_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  const auto call_off = [&](const auto& work) {
    try {
      until_stopped(interrupt.token(), work);
    } catch (const Interrupted&) {
      throw RunError(before_the_first);
    }
  };
  std::optional<PingProgress> progress(std::in_place, !options.quiet);
  std::optional<PingSimulator> made;
  call_off([&] {
    made.emplace(std::move(scenario), nullptr,
                 read_budget(options.scenario.path, options.scenario.overrides));
    try {
      progress->doing("preparing: paths to scatterers");
      static_cast<void>(made->memory());
      progress->doing("preparing: paths that are followed");
      const std::vector<std::string> missing = made->judge_paths().warnings;
      if (!options.quiet) warn(missing);
    } catch (const MemoryError& error) {
      throw told_of_scenario(error, options.scenario.path, overrides(options));
    }
  });
  made->tell_steps(
      [&](int ping, double share, std::string_view what) { progress->step(ping, share, what); });
  const PingSimulator& simulator = *made;
  const int count = simulator.pings();
  PingReport report(simulator.scenario());
  PingFileWriter writer(std::move(output), simulator.scenario(), provenance(threads),
                        options.time_axis ? SampleTimes::written_out : SampleTimes::start_and_step);
  int done = 0;
  try {
    progress->doing("preparing: rays to draw");
    RayPaths rays;
    call_off([&] { rays = drawn_rays(simulator); });
    writer.write_rays(rays);
    progress->begin(count);
    run_pings(simulator,
              [&](PingRecord&& record) {
                const auto start = std::chrono::steady_clock::now();
                writer.append(record);
                const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
                record.timings.write = wall.count();
                report.add(record);
                ++done;
                progress->done(record.ping);
              },
              {.stop = interrupt.token()});
  } catch (const RunError& error) {
    if (done == 0) throw;
    throw RunError(fmt::format("{}; {} holds the {} before", error.what(), part,
                               done == 1 ? "ping" : fmt::format("{} pings", done)));
  }
  progress.reset();
  writer.finish(done == count);
  if (!report.echo_beside_record().empty()) warn({report.echo_beside_record()});
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  if (!options.quiet && done > 0) {
    print(report.text(wall.count()));
    print(fmt::format("{}: {}\n", path.string(),
                      byte_count(static_cast<double>(std::filesystem::file_size(path)))));
    flush_output();
  }
  return done == count ? 0 : interrupted(done, count, path);
}

}  // namespace

void add_ping_command(Program& program) {
  program.add_command(
      "ping", "Simulate the pings of a scenario: what every phone receives, into an HDF5 file.",
      [](const Command& command) {
        auto options = std::make_shared<PingOptions>();
        add_scenario_options(command, options->scenario);
        command
            .add_option("-o,--output", options->output,
                        "file to write; default: the scenario's name with .h5, in this folder")
            .type_name("FILE.h5");
        command
            .add_option("--pings", options->pings,
                        "number of pings of each transmitter, instead of pings.count")
            .type_name("N")
            .check(above_zero());
        command
            .add_option("--seed", options->seed,
                        "of every random stream, instead of the scenario's")
            .type_name("S")
            .check(whole_number(0, std::numeric_limits<std::int64_t>::max(), "a seed"));
        add_threads_option(command, options->threads);
        command.add_flag("--time-axis", options->time_axis,
                         "write the time of every sample out as well, not start and step alone");
        add_force_option(command, options->force);
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        command.footer(
            "Ctrl-C leaves the pings in hand and closes the file; a second one ends at once.\n"
            "Example:  asdic ping scenarios/deep_ocean.toml --set target.0.strength_db=20");
        command.runs([options] { return ping(*options); });
      });
}

}  // namespace asdic::detail::app
