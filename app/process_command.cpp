#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <chrono>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/process_report.h"
#include "app/progress_bar.h"
#include "app/settings_options.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/hdf5/own_files.h"
#include "io/ping/provenance.h"
#include "io/processing/process_pings.h"
#include "io/processing/recordings.h"
#include "raytrace/propagation.h"

namespace asdic::detail::app {
namespace {

struct ProcessOptions {
  std::string file, output, scenario, csv;
  std::optional<int> ping, threads;
  SettingsOptions receiver{
      {{"elevations", {.type = "LOW:HIGH"}},
       {"across_beams",
        {.name = "!--time-only",
         .help = "compare a peak with its own beam alone, not with the beams around"}},
       {"track_start", {.type = "M/N"}}}};
  bool json = false, quiet = false, no_maps = false, no_file = false, force = false;
};

/// By default nothing is detected while the longest of the pulses is sent; of a continuous record
/// the receiver decides, transmitter by transmitter and array by array.
ProcessingSettings settings_of(const ProcessOptions& options, const Scenario& scenario,
                               const std::vector<Replica>& replicas) {
  ProcessingSettings settings;
  options.receiver.read(settings);
  options.receiver.read(settings.tracker);
  double longest = 0.0;
  for (const Replica& replica : replicas) longest = std::max(longest, replica.duration());
  if (!settings.detector.first_time && !scenario.pings.continuous)
    settings.detector.first_time = longest;
  return settings;
}

/// What was asked for, as the file tells it.
std::vector<std::string> told(ProcessingSettings settings) {
  SettingsInUse used;
  used.add(settings);
  used.add(settings.tracker);
  return used.list();
}

/// A file of the folder of tables, which is made if need be.
OutputFile table_output(const ProcessOptions& options, const std::string& kind) {
  std::error_code error;
  std::filesystem::create_directories(options.csv, error);
  if (error) throw RunError(options.csv + ": " + error.message());
  const std::string stem = std::filesystem::path(options.file).stem().string();
  return OutputFile(std::filesystem::path(options.csv) / (stem + kind),
                    {.own = own::table, .force = options.force, .option = "--csv"});
}

/// The file to write: by default the one that is read, or what a link of that name leads to.
OutputFile file_output(const ProcessOptions& options) {
  if (!options.output.empty() && options.output != options.file)
    return OutputFile(options.output, rules_for(options.output, options.force, options.file));
  static_cast<void>(Hdf5File::peek(options.file));  // says what is wrong with it, if anything
  const auto read_next = [](const std::filesystem::path&) { return true; };
  return OutputFile(std::filesystem::canonical(options.file),
                    {.own = read_next, .worth = own::pings, .renews = true});
}

int process(const ProcessOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const int threads = options.threads.value_or(tbb::info::default_concurrency());
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  const std::string output = options.output.empty() ? options.file : options.output;
  std::optional<OutputFile> file, detections, tracks;
  if (!options.no_file) file.emplace(file_output(options));
  if (!options.csv.empty()) {
    detections.emplace(table_output(options, "_detections.csv"));
    tracks.emplace(table_output(options, "_tracks.csv"));
  }
  std::optional<std::filesystem::path> scenario;
  if (!options.scenario.empty()) scenario = options.scenario;
  ProcessedRun run;
  std::optional<Replica> first;
  {
    const PingRecordings recordings(options.file, scenario);
    std::vector<Replica> replicas = recordings.replicas();
    const ProcessingSettings settings = settings_of(options, recordings.scenario(), replicas);
    first = replicas.front();
    const int count = options.ping ? 1 : static_cast<int>(recordings.pings());
    try {
      const PingProcessor processor(recordings.scenario(), std::move(replicas), settings);
      ProgressBar bar("ping", count, !options.quiet);
      until_interrupted([&] {
        run = process_pings(
            recordings, processor, options.ping, [&](int done) { bar.done(done); },
            [] { return !Interrupt::requested(); });
      });
    } catch (const Interrupted&) {
      throw RunError("interrupted; " + output +
                     (output == options.file ? " is as it was" : " was not written"));
    } catch (const InputError& error) {
      throw told_of_option(error);
    }
    if (!options.quiet) warn(run.warnings);
    run.options = told(settings);
    run.program_version = provenance(threads).program_version;
    run.maps = !options.no_maps;
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    if (options.json)
      print(process_json(run, recordings.scenario(), options.file));
    else if (!options.quiet)
      print(process_report(run, recordings.scenario(), wall.count()));
  }  // the file is closed before it is written
  if (detections) detections->write(detections_csv(run));
  if (tracks) tracks->write(tracks_csv(run));
  if (file) write_processed(options.file, std::move(*file), run, *first);
  return 0;
}

}  // namespace

void add_process_command(Program& program) {
  program.add_command(
      "process",
      "What a sonar makes of a ping file: beams, matched filters, detections, places, tracks, and "
      "how they compare with the truth. Written into the file's group /processed.",
      [](const Command& command) {
        auto options = std::make_shared<ProcessOptions>();
        command.add_option("FILE", options->file, "ping file (HDF5), written by asdic ping")
            .required();
        command
            .add_option("-o,--output", options->output,
                        "write another file, with all that FILE holds; default: FILE itself")
            .type_name("FILE.h5");
        command.add_flag("--no-file", options->no_file, "write no HDF5 at all");
        command.add_flag("--no-maps", options->no_maps, "leave out the maps for pictures");
        command
            .add_option("--csv", options->csv,
                        "folder for FILE_detections.csv and FILE_tracks.csv; made if need be")
            .type_name("DIR");
        command.add_flag("--json", options->json, "print a summary in JSON");
        command.add_option("--ping", options->ping, "this ping alone; default: all")
            .type_name("N")
            .check(above_zero());
        command
            .add_option(
                "--scenario", options->scenario,
                "where FILE's scenario was, if it names other files: they are looked for beside "
                "it")
            .type_name("FILE.toml");
        ProcessingSettings defaults;
        options->receiver.add(command, defaults);
        options->receiver.add(command, defaults.tracker);
        add_threads_option(command, options->threads);
        add_force_option(command, options->force);
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        command.footer(
            "The file is copied, changed and renamed: a stop at any moment leaves it whole.\n"
            "Example:  asdic process two_targets.h5 --target-depth 125m --csv tables");
        command.runs([options] { return process(*options); });
      });
}

}  // namespace asdic::detail::app
