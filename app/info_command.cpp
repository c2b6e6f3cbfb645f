#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <set>

#include "app/area_info.h"
#include "app/command.h"
#include "app/console.h"
#include "app/ping_report.h"
#include "app/place_info.h"
#include "app/result_info.h"
#include "app/study_comparison.h"
#include "app/study_info.h"
#include "core/error.h"
#include "io/hdf5/file_check.h"
#include "io/ping/ping_file.h"
#include "io/result/result_file.h"
#include "study/runs/study_file.h"

namespace asdic::detail::app {
namespace {

struct InfoOptions {
  std::string path;
  bool check = false;
};

/// An attribute as text, "unknown" if it is not there.
std::string attribute(const PingFile& file, const std::string& object, const std::string& key) {
  return file.file().attribute_or(object, key, "unknown");
}

/// A number to six digits: 184.44 and not 184.43999999999997; other words as they are.
std::string to_six_digits(const std::string& text) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  return fault == std::errc() && end == text.data() + text.size() ? fmt::format("{:.6g}", value)
                                                                  : text;
}

/// What `asdic process` added.
std::string processed(const Hdf5File& file) {
  if (!file.has("processed")) return {};
  const auto rows = [&](const std::string& table, const std::string& thing) {
    const std::string ping = "processed/" + table + "/ping";
    return count_of(file.has(ping) ? file.info(ping).shape.at(0) : 0, thing);
  };
  return fmt::format("processed    {}, {} of tracks, by asdic {}\n",
                     rows("detections", "detection"), rows("tracks", "point"),
                     file.attribute_or("processed", "program_version", "unknown"));
}

/// What is neither HDF5 nor anything else that can be told: better words than HDF5's.
void check_kind_of_file(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) || std::filesystem::is_empty(path, error) ||
      is_hdf5(path))
    return;
  throw InputError({.where = path,
                    .got = "a file that is not HDF5",
                    .expected =
                        "HDF5 of asdic ping, process, study, merge, area, place, field, arrivals "
                        "or rays, or .shd, .arr, .ray, .wav (of a scenario asdic validate "
                        "tells)"});
}

/// Who made it, when and with what.
std::string makers(const PingFile& file) {
  const auto run = [&](const std::string& key) { return attribute(file, "run", key); };
  const std::string version = attribute(file, "", "program_version");
  if (version.empty()) return "made         by a program that does not say when and with what\n";
  return fmt::format("made         {} on {}, {}, {} threads\n", run("started"), run("host"),
                     run("cpu"), run("threads")) +
         fmt::format("by           asdic {}, {}\n", version, attribute(file, "", "build")) +
         fmt::format("with         {}\n", run("library_versions"));
}

/// What was sent, by each transmitter that has a ping in the file.
std::string pulses(const PingFile& file) {
  std::set<int> senders;
  if (file.pings() > 0 && file.file().has("transmitter"))
    for (const std::int32_t sender :
         file.file().read<std::int32_t>("transmitter", {0}, {file.pings()}))
      senders.insert(sender);
  if (senders.empty()) senders = {0};
  std::string text;
  for (const int sender : senders) {
    const std::string replica = sender == 0 ? "replica" : "replica_" + std::to_string(sender);
    if (!file.file().has(replica)) continue;
    const auto pulse = [&](const std::string& key) {
      return to_six_digits(attribute(file, replica, key));
    };
    text +=
        fmt::format("pulse        {}, {} Hz, {} s, window {}, band {} Hz, {} dB re 1 µPa at 1 m\n",
                    pulse("kind"), pulse("centre_frequency_hz"), pulse("duration_s"),
                    pulse("window"), pulse("bandwidth_hz"), pulse("source_level_db"));
  }
  return text;
}

/// Which pings of the schedule the file has, where it does not begin with the first.
std::string which(const std::vector<int>& numbers) {
  if (numbers.empty() || numbers.front() == 1) return "";
  return numbers.size() == 1 ? fmt::format(" (number {})", numbers[0])
                             : fmt::format(" (numbers {} to {})", numbers.front(), numbers.back());
}

std::string completeness(const PingFile& file) {
  const std::string requested = attribute(file, "", "pings_requested");
  return file.complete() ? "complete"
                         : fmt::format("not complete: {} of {}", file.pings(),
                                       requested == "1" ? "1 ping" : requested + " pings");
}

std::string summary(const PingFile& file) {
  constexpr std::size_t most = 40;  // pings: one screen
  if (!file.file().has("summary/present")) return "targets      none\n";
  const auto elevations = file.file().read<double>("elevation_deg");
  const std::vector<int> numbers = file.numbers();
  Table table(summary_columns());
  for (std::size_t i = 0; i < std::min(most, file.pings()); ++i)
    for (const TargetSummary& target : file.summary(i))
      table.row(summary_row(numbers[i], elevations[i], target));
  std::string text = table.text();
  if (file.pings() > most) text += fmt::format("... and {} more pings\n", file.pings() - most);
  return text;
}

int info(const std::string& path) {
  if (is_study_file(path)) return study_info(path);
  if (is_comparison_file(path)) return comparison_info(path);
  if (is_propagation_file(path)) return propagation_info(path);
  if (is_area_file(path)) return area_info(path);
  if (is_placement_file(path)) return placement_info(path);
  if (std::filesystem::path(path).extension() == ".wav") return wav_info(path);
  check_kind_of_file(path);
  const PingFile file(path);
  const auto root = [&](const std::string& key) { return attribute(file, "", key); };
  const std::string title = root("title");
  print(emphasised(title.empty() ? path : title) + '\n');
  print(fmt::format("file         {}, {}, {}\n", path,
                    byte_count(static_cast<double>(std::filesystem::file_size(path))),
                    completeness(file)));
  const double rate = file.channels() > 0 && file.file().has("pressure") ? file.sample_rate() : 0.0;
  print(fmt::format("holds        {}{}, {}, {} {}samples at {:g} Hz: {:g} s\n",
                    count_of(file.pings(), "ping"), which(file.numbers()),
                    count_of(file.channels(), "phone"), file.samples(),
                    file.is_complex() ? "complex " : "", rate,
                    rate > 0.0 ? static_cast<double>(file.samples()) / rate : 0.0));
  print(pulses(file) + makers(file));
  print(fmt::format("scenario     sha256 {}, seed {}\n", root("scenario_sha256"), root("seed")));
  print(place_text(file.file(), 13));
  if (file.file().has_attribute("", "overrides"))
    print(fmt::format("changed by   {}\n", root("overrides")));
  if (file.file().has_attribute("", "warnings"))
    for (const std::string& one : file.file().attribute_texts("", "warnings"))
      print(fmt::format("warning      {}\n", one));
  print(processed(file.file()) + summary(file));
  return 0;
}

/// Whether the data are what was written. \throws InputError where they are not
int check(const std::string& path) {
  if (is_study_file(path)) {
    const study::StudyFile file(path);
    file.check_parts();
    file.verify();
    print(path + ": every dataset matches the manifest\n");
    return 0;
  }
  if (is_comparison_file(path)) {
    check_comparison(path);
    print(path + ": every dataset matches the manifest\n");
    return 0;
  }
  const FileCheck found = check_file(Hdf5File::open(path));
  print(fmt::format("{}: {} match their checksums ({} numbers); {} without\n", path,
                    count_of(found.checked, "dataset"), found.values,
                    count_of(found.unchecked, "dataset")));
  return 0;
}

}  // namespace

void add_info_command(Program& program) {
  program.add_command(
      "info", "Say what a file that asdic wrote holds.", [](const Command& command) {
        auto options = std::make_shared<InfoOptions>();
        command
            .add_option(
                "FILE", options->path,
                "HDF5 of asdic ping (NAME.XXXX.part too), process, study, merge, area, place, "
                "field, arrivals or rays, or .shd, .arr, .ray, .wav")
            .required();
        command.add_flag(
            "--check", options->check,
            "read all data and hold them against their checksums; exit status 2 where they "
            "differ");
        command.footer("Example:  asdic info deep_ocean.h5 --check");
        command.runs(
            [options] { return options->check ? check(options->path) : info(options->path); });
      });
}

}  // namespace asdic::detail::app
