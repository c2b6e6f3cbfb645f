#include "asdic/file.h"

#include <thread>

#include "io/hdf5/own_files.h"
#include "io/ping/drawn_rays.h"
#include "io/ping/ping_file.h"
#include "io/ping/provenance.h"
#include "io/processing/recordings.h"
#include "io/result/coverage_file.h"
#include "io/result/scene_file.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "library/physics.h"
#include "library/ping_access.h"
#include "library/watched.h"
#include "processing/coverage/coverage_of_scenario.h"

namespace asdic {
namespace {

/// The scenario inside a ping file. \param recordings  has read and checked it
Scenario scenario_in(const detail::PingRecordings& recordings) {
  const detail::Scenario& read = recordings.scenario();
  return Access::parsed(read.text, read.path, read.overrides);
}

/// One row of a file, all arrays side by side.
detail::PingRecord record_of(const detail::PingRecordings& file, std::size_t row) {
  detail::PingRecord record;
  record.ping = file.number(row);
  record.transmitter = file.transmitter(row);
  record.start_time = file.ping_time(row);
  for (std::size_t array = 0; array < file.scenario().arrays.size(); ++array) {
    const detail::ArrayRecording received = file.recording(row, static_cast<int>(array));
    record.phones.insert(record.phones.end(), received.phones.begin(), received.phones.end());
    record.pressure.insert(record.pressure.end(), received.pressure.begin(),
                           received.pressure.end());
    for (const std::complex<float> sample : received.envelope)
      record.pressure.insert(record.pressure.end(), {sample.real(), sample.imag()});
    record.recording.sample_rate = received.sample_rate;
    record.recording.start = received.start;
    record.recording.carrier = received.carrier.value_or(0.0);
  }
  record.recording.samples =
      record.pressure.size() / record.phones.size() / record.recording.components();
  return record;
}

detail::Provenance here() {
  return detail::provenance(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
}

}  // namespace

struct PingWriter::Data {
  Scenario scenario;
  detail::PingFileWriter writer;
  int last = 0;  ///< number of the ping written last
};

PingWriter::PingWriter(const std::filesystem::path& path, const Scenario& scenario,
                       const Watch& watch)
    : data_(translated([&] {
        detail::OutputFile output(
            path, {.own = detail::own::hdf5, .worth = detail::own::pings, .option = "path"});
        const detail::PingSimulator& simulator = Access::physics(scenario).ready_to_ping(watch);
        detail::PingFileWriter writer(std::move(output), simulator.scenario(), here());
        writer.write_rays(detail::drawn_rays(simulator));
        return std::unique_ptr<Data>(new Data{scenario, std::move(writer)});
      })) {}
PingWriter::PingWriter(PingWriter&&) noexcept = default;
PingWriter& PingWriter::operator=(PingWriter&&) noexcept = default;
PingWriter::~PingWriter() = default;

PingWriter::Data& PingWriter::open() {
  if (!data_)
    throw InputError("writer", "one that is finished or was moved from", "one that is open");
  return *data_;
}

void PingWriter::append(const Ping& ping) {
  Data& to = open();
  const Ping::Data& made = PingAccess::data(ping);
  if (made.from_file)
    throw InputError("ping", "a ping that was read from a file", "one that was made here");
  if (made.scenario.to_toml() != to.scenario.to_toml())
    throw InputError("ping", "a ping of another scenario", "one of the file's scenario");
  if (ping.number() <= to.last)
    throw InputError("ping", std::to_string(ping.number()),
                     "one after ping " + std::to_string(to.last) + ", which is in the file");
  translated([&] { to.writer.append(made.record); });
  to.last = ping.number();
}

void PingWriter::finish() {
  translated([&] { open().writer.finish_these(); });
  data_.reset();
}

void write_ping(const std::filesystem::path& path, const Scenario& scenario, const Ping& ping) {
  PingWriter writer(path, scenario);
  writer.append(ping);
  writer.finish();
}

void write_pings(const std::filesystem::path& path, const Scenario& scenario, const Watch& watch) {
  PingWriter writer(path, scenario, {.stop = watch.stop});
  Pinger(scenario).run([&](const Ping& ping) { writer.append(ping); }, watch);
  writer.finish();
}

void write_scene(const std::filesystem::path& path, const Scenario& scenario) {
  const Scenario::Data& data = Access::data(scenario);
  translated([&] {
    if (detail::has_sonar(data.document))
      return detail::write_scene(path, detail::scenario_of(data.document, data.path));
    std::vector<std::string> notes;
    detail::write_scene(path, detail::propagation_case_of(data.document, data.path, notes));
  });
}

std::vector<std::string> write_area(const std::filesystem::path& path, const Scenario& scenario,
                                    const AreaOptions& options, const Watch& watch) {
  return watched(watch, [&] {
    detail::OutputFile output(
        path, {.own = detail::own::hdf5, .worth = detail::own::pings, .option = "path"});
    const detail::PingSimulator& simulator = Access::physics(scenario).simulator();
    const detail::AreaWishes wishes{.depths = options.depths,
                                    .reach = options.reach,
                                    .strength_db = options.strength_db,
                                    .fluctuation = options.fluctuation,
                                    .transmitter = options.transmitter,
                                    .array = options.array,
                                    .ping = options.ping,
                                    .bearings = options.bearings,
                                    .ranges = options.ranges,
                                    .false_alarm_probability = options.false_alarm_probability,
                                    .reference_cells = options.reference_cells};
    const detail::Coverage found = detail::coverage(
        simulator, detail::coverage_settings(simulator.scenario(), wishes), [&](double share) {
          if (watch.progress) watch.progress(static_cast<int>(1000.0 * share), 1000);
          return true;
        });
    detail::write_area(std::move(output), found, simulator.scenario());
    std::vector<std::string> all = simulator.scenario().notes;
    all.insert(all.end(), found.warnings.begin(), found.warnings.end());
    return all;
  });
}

Ping read_ping(const std::filesystem::path& path, std::optional<int> number) {
  return translated(
      [&] {
        const detail::PingRecordings file(path);
        const std::size_t row = number ? file.row_of(*number) : 0;
        std::vector<std::vector<detail::TrueEcho>> truth;
        for (std::size_t array = 0; array < file.scenario().arrays.size(); ++array)
          truth.push_back(file.echoes(row, static_cast<int>(array)));
        return PingAccess::made(scenario_in(file), record_of(file, row), std::move(truth), true);
      },
      {path});
}

int pings_in(const std::filesystem::path& path) {
  return translated([&] { return static_cast<int>(detail::PingFile(path).pings()); }, {path});
}

}  // namespace asdic
