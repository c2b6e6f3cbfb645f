#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <charconv>
#include <chrono>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "app/interrupt.h"
#include "app/output.h"
#include "app/process_report.h"
#include "app/process_run.h"
#include "app/progress_bar.h"
#include "app/provenance.h"
#include "app/warn.h"
#include "core/error.h"
#include "io/output/own_files.h"
#include "raytrace/propagation.h"

namespace asdic::app {
namespace {

struct ProcessOptions {
  std::string file, output, scenario, csv;
  std::optional<int> ping, threads;
  std::string beamformer = "conventional", shading = "none", normaliser = "split-window";
  std::string elevations, track_start = "3/4";
  double mvdr_loading_db = -10.0;
  std::optional<double> from, until;
  ProcessingSettings settings;
  bool json = false, quiet = false, no_maps = false, no_file = false, force = false;
};

/// Two numbers with a sign between: "3/4", "-20:20".
std::pair<double, double> two_numbers(const std::string& option, const std::string& text, char sign,
                                      const std::string& expected) {
  const auto wrong = [&] {
    return InputError({.where = option, .got = '"' + text + '"', .expected = expected});
  };
  const auto at = text.find(sign, 1);
  if (at == std::string::npos) throw wrong();
  const auto number_of = [&](const char* begin, const char* end) {
    double value = 0.0;
    const auto [rest, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || rest != end || !std::isfinite(value)) throw wrong();
    return value;
  };
  const char* const text_begin = text.data();
  return {number_of(text_begin, text_begin + at),
          number_of(text_begin + at + 1, text_begin + text.size())};
}

ProcessingSettings settings_of(const ProcessOptions& options, const std::vector<Replica>& replicas,
                               double record_start) {
  ProcessingSettings s = options.settings;
  s.detector.beamformer =
      options.beamformer == "mvdr" ? Beamformer::mvdr : Beamformer::conventional;
  s.detector.hann_shading = options.shading == "hann";
  s.detector.normaliser.method =
      options.normaliser == "split-window" ? Normaliser::split_window : Normaliser::cell_averaging;
  s.detector.mvdr.loading = power_from_db(options.mvdr_loading_db);
  if (!options.elevations.empty()) {
    const auto [low, high] = two_numbers("--elevations", options.elevations, ':',
                                         "two angles such as -20:20, the lower first");
    if (!(low <= high && low >= -90.0 && high <= 90.0))
      throw InputError({.where = "--elevations",
                        .got = '"' + options.elevations + '"',
                        .expected = "two angles from -90 to 90 degrees, the lower first"});
    s.detector.lowest_elevation = radians(low);
    s.detector.highest_elevation = radians(high);
  }
  const auto [hits, pings] =
      two_numbers("--track-start", options.track_start, '/', "hits/pings such as 3/4");
  if (!(hits >= 1.0 && hits <= pings && pings <= 1000.0 && hits == std::floor(hits) &&
        pings == std::floor(pings)))
    throw InputError({.where = "--track-start",
                      .got = '"' + options.track_start + '"',
                      .expected = "hits/pings such as 3/4, no more hits than pings"});
  s.tracker.start_hits = static_cast<int>(hits);
  s.tracker.start_pings = static_cast<int>(pings);
  double longest = 0.0;
  for (const Replica& replica : replicas) longest = std::max(longest, replica.duration());
  s.detector.first_time = options.from.value_or(record_start + longest);
  s.detector.last_time = options.until.value_or(infinity);
  return s;
}

/// What was asked for, as the file tells it.
std::vector<std::string> told(const ProcessOptions& o, const ProcessingSettings& s) {
  std::vector<std::string> list{
      "beamformer=" + o.beamformer,
      "shading=" + o.shading,
      "normaliser=" + o.normaliser,
      fmt::format("across_beams={}", s.detector.normaliser.across_beams),
      fmt::format("false_alarm_probability={}", s.detector.normaliser.false_alarm_probability),
      fmt::format("guard_cells={}", s.detector.normaliser.guard_cells),
      fmt::format("reference_cells={}", s.detector.normaliser.reference_cells),
      fmt::format("max_speed={}", s.max_speed),
      fmt::format("from={}", s.detector.first_time),
      "track_start=" + o.track_start,
      fmt::format("track_stop={}", s.tracker.stop_misses),
      fmt::format("track_acceleration={}", s.tracker.acceleration)};
  if (s.target_depth) list.push_back(fmt::format("target_depth={}", *s.target_depth));
  if (s.range_speed) list.push_back(fmt::format("range_speed={}", *s.range_speed));
  if (o.beamformer == "mvdr") list.push_back(fmt::format("mvdr_loading_db={}", o.mvdr_loading_db));
  if (o.until) list.push_back(fmt::format("until={}", *o.until));
  if (!o.elevations.empty()) list.push_back("elevations=" + o.elevations);
  return list;
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
  return OutputFile(std::filesystem::canonical(options.file), {.own = read_next});
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
    const ProcessingSettings settings = settings_of(options, replicas, 0.0);
    first = replicas.front();
    const PingProcessor processor(recordings.scenario(), std::move(replicas), settings);
    const int count = options.ping ? 1 : static_cast<int>(recordings.pings());
    try {
      ProgressBar bar("ping", count, !options.quiet);
      until_interrupted([&] {
        run = process_file(
            recordings, processor, options.ping, [&](int done) { bar.done(done); },
            [] { return !Interrupt::requested(); });
      });
    } catch (const Interrupted&) {
      throw RunError("interrupted; " + output +
                     (output == options.file ? " is as it was" : " was not written"));
    }
    if (!options.quiet) warn(run.warnings);
    run.options = told(options, settings);
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

void add_detection_options(const Command& command, ProcessOptions& o) {
  NormaliserSettings& normaliser = o.settings.detector.normaliser;
  command.add_option("--beamformer", o.beamformer, "of the arrays")
      .show_default()
      .one_of({"conventional", "mvdr"});
  command
      .add_option("--mvdr-loading-db", o.mvdr_loading_db,
                  "diagonal loading, re the mean power of a phone")
      .show_default()
      .type_name("DB")
      .check(between(-120.0, 60.0));
  command.add_option("--shading", o.shading, "of the phones, in conventional beams")
      .show_default()
      .one_of({"none", "hann"});
  command
      .add_option("--elevations", o.elevations,
                  "looked at by arrays that tell elevation and bearing, e.g. -20:20 [deg]")
      .type_name("LOW:HIGH");
  command
      .add_option("--max-speed", o.settings.max_speed,
                  "closing or opening, that the Doppler filters reach [m/s]")
      .show_default()
      .type_name("MPS")
      .check(between(0.0, 500.0));
  command.add_option("--normaliser", o.normaliser, "estimate of the background")
      .show_default()
      .one_of({"cell-averaging", "split-window"});
  command.add_flag("!--time-only", normaliser.across_beams,
                   "compare a peak with its own beam alone, not with the beams around");
  command.add_option("--guard-cells", normaliser.guard_cells, "left out on either side")
      .show_default()
      .type_name("N")
      .check(between(0.0, 1e5));
  command.add_option("--reference-cells", normaliser.reference_cells, "averaged on either side")
      .show_default()
      .type_name("N")
      .check(between(1.0, 1e5));
  command
      .add_option("--false-alarm-probability", normaliser.false_alarm_probability,
                  "of a cell of Rayleigh background")
      .show_default()
      .type_name("P")
      .check(between(1e-30, 0.5));
  command
      .add_option("--from", o.from,
                  "nothing is detected before, after the ping's start; default: the pulse's "
                  "duration [s]")
      .type_name("S")
      .check(not_negative());
  command.add_option("--until", o.until, "nor after [s]").type_name("S").check(not_negative());
}

void add_place_options(const Command& command, ProcessOptions& o) {
  command.add_length(
      "--target-depth", o.settings.target_depth,
      "depth of what answers; default: where the ray came from if the array tells elevation, else "
      "100 m");
  command
      .add_option("--range-speed", o.settings.range_speed,
                  "straight rays of this speed, instead of the scenario's sound paths [m/s]")
      .type_name("MPS")
      .check(between(1000.0, 2000.0));
  command.add_option("--track-start", o.track_start, "a track is believed after m hits in n pings")
      .show_default()
      .type_name("M/N");
  command
      .add_option("--track-stop", o.settings.tracker.stop_misses,
                  "and ends after so many pings without a hit")
      .show_default()
      .type_name("N")
      .check(between(1, 1000));
  command
      .add_option("--track-acceleration", o.settings.tracker.acceleration,
                  "of targets, root of its density [m/s2 sqrt(s)]")
      .show_default()
      .type_name("A")
      .check(above_zero());
  command.add_option("--track-max-speed", o.settings.tracker.max_speed, "of targets [m/s]")
      .show_default()
      .type_name("MPS")
      .check(above_zero());
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
        add_detection_options(command, *options);
        add_place_options(command, *options);
        add_threads_option(command, options->threads);
        add_force_option(command, options->force);
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        command.footer(
            "The file is copied, changed and renamed: a stop at any moment leaves it whole.\n"
            "Example:  asdic process two_targets.h5 --target-depth 125m --csv tables");
        command.runs([options] { return process(*options); });
      });
}

}  // namespace asdic::app
