#include <fmt/format.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/progress_bar.h"
#include "core/error.h"
#include "io/bellhop/case_reader.h"
#include "io/bellhop/map_run.h"
#include "io/bellhop/results.h"
#include "io/hdf5/own_files.h"
#include "io/ping/provenance.h"
#include "raytrace/cases/beam_error_text.h"

namespace asdic::detail::app {
namespace {

using Clock = std::chrono::steady_clock;

struct BellhopOptions {
  std::string root, output, dialect = "fortran";
  bool bellhop_emulation = false, beams_as_written = false, quiet = false, force = false;
  std::optional<int> threads;
};

/// Seconds from one call to the next.
class StopWatch {
 public:
  double lap() {
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double> passed = now - std::exchange(last_, now);
    return passed.count();
  }

 private:
  Clock::time_point last_ = Clock::now();
};

/// ROOT of "ROOT" or "ROOT.env".
std::filesystem::path root_of(const std::string& name) {
  std::filesystem::path root = name;
  if (root.extension() == ".env") root.replace_extension();
  return root;
}

std::filesystem::path with(const std::filesystem::path& root, const char* extension) {
  return root.string() + extension;
}

/// What is printed, and into ROOT.prt.
class Report {
 public:
  void line(const std::string& text) { text_ += text + '\n'; }
  void notes(const std::vector<std::string>& all) {
    for (const std::string& note : all) line("note       " + note);
  }
  void file(const std::filesystem::path& path) {
    line(fmt::format("written    {}, {}", path.string(),
                     byte_count(static_cast<double>(std::filesystem::file_size(path)))));
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }

 private:
  std::string text_;
};

/// As many beams as the file says, no more: asdic's rays, BELLHOP's fan.
void fix_fan(PropagationCase& run_case) {
  BeamSettings& beams = run_case.beams;
  const int n = run_case.literal.beams;
  if (!beams.elevations.empty() || n < 2) return;
  for (int i = 0; i < n; ++i)
    beams.elevations.push_back(std::lerp(beams.lowest, beams.highest, double(i) / (n - 1)));
}

PropagationResult search(const bellhop::Input& input, const BellhopOptions& options) {
  constexpr int steps = 100;
  ProgressBar bar("%", steps, !options.quiet);
  const Progress progress = [&](double share) {
    bar.done(std::clamp(share, 0.0, 1.0) * steps);
    return true;
  };
  try {
    const MemoryBudget budget = MemoryBudget::without_key();
    PropagationResult result;
    until_interrupted([&] {
      result = bellhop::run_all_planes(input, options.bellhop_emulation, progress, budget);
    });
    return result;
  } catch (const Interrupted&) {
    throw RunError("interrupted; no result was written");
  } catch (const InputError& error) {
    throw bellhop::told_of_file(error, input);
  }
}

/// The results that a task has, ready to be written.
struct ResultFiles {
  std::optional<OutputFile> field{}, arrivals{}, rays{};

  ResultFiles(Task task, const std::filesystem::path& root, bool force) {
    const auto prepare = [&](std::optional<OutputFile>& file, const char* ending, Recognise own) {
      file.emplace(with(root, ending), OutputRules{.own = own, .force = force});
    };
    if (task == Task::field) prepare(field, ".shd", own::shade_file);
    if (task == Task::arrivals || task == Task::eigenrays_and_arrivals)
      prepare(arrivals, ".arr", own::arrivals_file);
    if (task != Task::arrivals && task != Task::field) prepare(rays, ".ray", own::ray_file);
  }
};

void write_results(const bellhop::Input& input, PropagationResult&& result,
                   const BellhopOptions& options, const std::filesystem::path& root,
                   ResultFiles&& files, Report& report) {
  const PropagationCase& run_case = input.run_case;
  const bellhop::Dialect dialect =
      options.dialect == "wide" ? bellhop::Dialect::wide : bellhop::Dialect::fortran;
  if (files.field) {  // the only file of its task
    bellhop::write_shade_file(std::move(*files.field),
                              bellhop::shade_file(input, std::move(result), dialect));
    report.file(with(root, ".shd"));
    return;
  }
  if (files.arrivals) {
    bellhop::write_arrivals_file(std::move(*files.arrivals),
                                 bellhop::arrivals_file(input, result, dialect));
    report.file(with(root, ".arr"));
  }
  if (files.rays) {
    bellhop::write_ray_file(std::move(*files.rays), bellhop::ray_file(run_case, result));
    report.file(with(root, ".ray"));
  }
}

void run_case(const BellhopOptions& options, const std::filesystem::path& root, Report& report) {
  StopWatch watch;
  bellhop::Input input = bellhop::read_case(std::filesystem::path(options.root));
  if (options.beams_as_written) fix_fan(input.run_case);
  const double parse = watch.lap();
  for (const std::string& leak : input.leaks) tell("asdic: note: " + leak);
  report.line(input.echo);
  report.notes(input.notes);
  report.line(std::string(options.bellhop_emulation ? "traced     as BELLHOP does it, step by step"
                                                    : "traced     by asdic's own tracer") +
              (input.run_case.dimension == 3 ? ", in three dimensions" : "") +
              (input.map && input.map->planes() > 1
                   ? fmt::format(", in {} planes", input.map->planes())
                   : ""));

  ResultFiles files(input.run_case.task, root, options.force);
  PropagationResult result = search(input, options);
  const double search_time = watch.lap();
  report.notes(result.notes);
  if (result.beams > 0) report.line(fmt::format("beams      {} a source", result.beams));
  if (!options.bellhop_emulation && input.run_case.task == Task::field && result.beams > 0)
    report.line("error      " + beam_error_text(result.beam_error_db, result.beam_error_bounded));
  if (const double share = share_sure(result.beam_errors); !std::isnan(share))
    report.line("certain    " + certainty_text(share));
  report.line("");
  write_results(input, std::move(result), options, root, std::move(files), report);
  const double write = watch.lap();
  report.line(fmt::format("time       parse {:.6f} s, search {:.6f} s, write {:.6f} s", parse,
                          search_time, write));
}

int bellhop_command(const BellhopOptions& options) {
  const std::filesystem::path root =
      root_of(options.output.empty() ? options.root : options.output);
  OutputFile print_file(with(root, ".prt"),
                        OutputRules{.own = own::print_file, .force = options.force});
  std::optional<tbb::global_control> limit;  // tasks are not even asked how many cores there are
  if (options.threads)
    limit.emplace(tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(*options.threads));
  Report report;
  report.line(
      fmt::format("asdic {}, {}", program_and_build(), root_of(options.root).string() + ".env"));
  report.line("");
  try {
    run_case(options, root, report);
  } catch (const std::exception& error) {
    // scripts around BELLHOP look for these words
    report.line(fmt::format("FATAL ERROR: {}", error.what()));
    print_file.write(report.text());
    throw;
  }
  print_file.write(report.text());
  if (!options.quiet) print(report.text());
  return 0;
}

}  // namespace

void add_bellhop_command(Program& program) {
  program.add_command(
      "bellhop",
      "Run a case of BELLHOP or BELLHOP3D: reads ROOT.env and its companions, writes ROOT.shd,\n"
      "ROOT.arr or ROOT.ray, and ROOT.prt.",
      [](const Command& command) {
        auto options = std::make_shared<BellhopOptions>();
        command.add_option("root", options->root, "name of the case, with or without .env")
            .type_name("ROOT")
            .required();
        command.add_flag("--like-bellhop", options->bellhop_emulation,
                         "with BELLHOP's own steps, beams and merging, to compare with its files");
        command.add_flag("--beams-as-written", options->beams_as_written,
                         "exactly the beams of the file, where fields take as many as they need");
        command
            .add_option(
                "--dialect", options->dialect,
                "of .shd and .arr: fortran (numbers of 4 bytes in the head; default) or wide")
            .type_name("NAME")
            .one_of({"fortran", "wide"});
        command
            .add_option("-o,--output", options->output, "ROOT of the files to write; default: ROOT")
            .type_name("ROOT");
        add_threads_option(command, options->threads);
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        add_force_option(command, options->force);
        command.footer(
            "A case of BELLHOP3D (sources at x and y, azimuths of receivers) runs in every plane, "
            "or\n"
            "in three dimensions where the sixth letter of its run type is 3.\n"
            "Ctrl-C stops; nothing half-written is left.\n"
            "Example:  asdic bellhop munk -o /tmp/munk\n");
        command.runs([options] { return bellhop_command(*options); });
      });
}

}  // namespace asdic::detail::app
