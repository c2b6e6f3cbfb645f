#include "io/ping_file.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "core/error.h"
#include "io/arrival_table.h"
#include "io/hdf5/scale.h"
#include "io/ping/growing_table.h"
#include "io/ping/sections.h"
#include "io/ping/tables.h"
#include "sonar/stream.h"

namespace asdic {
namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_patches = 2000;  // rows a ping

std::vector<double> flat(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

struct PingFileWriter::Impl {
  std::filesystem::path path, part;
  Hdf5File file;
  Scenario scenario;
  std::size_t pings = 0;
  bool finished = false;
  ArrivalTable arrivals;
  GrowingTable echoes, patches;
  std::optional<GrowingTable> interference;  // where there are interferers
  std::size_t every = 1;
  std::size_t samples = 0, level_bins = 0;  // of the first record

  Impl(const std::filesystem::path& final_path, const Scenario& s)
      : path(final_path),
        part(final_path.string() + ".part"),
        file(Hdf5File::create(part)),
        scenario(s),
        arrivals(file),
        echoes(file, "echoes", "echo", ping_file::echo_columns()),
        patches(file, "patches", "patch", ping_file::patch_columns()) {
    if (scenario.interferers.empty()) return;
    interference.emplace(file, "interference", "heard_path", ping_file::interference_columns());
    std::string names;
    for (const Interferer& ship : scenario.interferers)
      names += (names.empty() ? "" : ",") + ship.name;
    file.set_attribute("interference", "names", names);
  }

  template <class T>
  void growing(const std::string& dataset, const std::string& long_name, const std::string& units,
               const std::vector<std::string>& scales = {}, const Shape& row = {}) {
    file.create_growing<T>(dataset, row, std::size_t{64});
    describe(file, dataset, long_name, units);
    std::vector<std::string> all{"ping"};
    all.insert(all.end(), scales.begin(), scales.end());
    file.attach_scales(dataset, all);
  }

  void create_ping_datasets();
  void create_sampled_datasets(const PingRecord& record);
  void append_pressure(const PingRecord& record);
  void append_geometry(const PingRecord& record);
  void append_tables(const PingRecord& record);
  void append_summary(const PingRecord& record);
};

void PingFileWriter::Impl::create_ping_datasets() {
  file.create_growing<std::int32_t>("ping", {}, std::size_t{64});
  describe(file, "ping", "number of the ping, from 1");
  file.make_scale("ping", "ping");
  growing<std::int64_t>("valid_samples", "samples of this ping that were simulated", "");
  growing<std::int32_t>("transmitter", "number of the transmitter that sent it, from 0", "");
  growing<double>("ping_time", "start of the ping since the start of the scenario", "s");
  growing<double>("elevation_deg", "elevation of the transmitter's beam, positive up", "degree");
  growing<double>("platform_position", "of the transmitter at the start of the ping", "m", {"xyz"},
                  {3});
  growing<double>("platform_velocity", "velocity of the transmitter", "m/s", {"xyz"}, {3});
  const std::size_t channels = channels_of(scenario), targets = scenario.targets.size();
  growing<double>("phone_position", "phones at the start of the ping", "m", {"channel", "xyz"},
                  {channels, 3});
  for (const char* name : {"rays", "eigenrays", "patches", "synthesis", "noise", "write"})
    growing<double>(std::string("run/time_") + name, std::string("wall time of ") + name, "s");
  growing<std::int8_t>("run/reuse_ocean", "1 if another simulator had used an equal ocean", "");
  growing<std::int32_t>("run/legs_searched", "sets of eigenrays that were searched for", "");
  growing<std::int32_t>("run/legs_reused", "sets of eigenrays that were known", "");
  growing<std::int8_t>("run/reuse_reverberation",
                       "1 if all paths to scattering boundaries were known", "");
  growing<std::int32_t>("run/band_points", "frequencies at which reverberation is known", "");
  growing<double>("run/band_error", "largest error of its amplitudes between them", "");
  growing<std::int8_t>("run/reuse_expected_level",
                       "1 if the reverberation's expected level was known", "");
  if (targets == 0) return;
  const std::vector<std::string> scale{"target_index"}, vector{"target_index", "xyz"};
  growing<double>("target_position", "target at the start of the ping", "m", vector, {targets, 3});
  growing<double>("target_velocity", "velocity of the target", "m/s", vector, {targets, 3});
  growing<double>("target_strength_db",
                  "target strength at its aspect from the transmitter, without fluctuation", "dB",
                  scale, {targets});
  growing<std::int8_t>("target_present", "1 if the target is there", "", scale, {targets});
  growing<std::int8_t>("summary/present", "1 if the target is there", "", scale, {targets});
  growing<std::int32_t>("summary/array",
                        "number of the array that hears the strongest pair, -1: none", "", scale,
                        {targets});
  growing<std::int32_t>("summary/paths", "pairs of paths there and back", "", scale, {targets});
  growing<double>("summary/echo_time", "delay of the strongest pair", "s", scale, {targets});
  growing<double>("summary/echo_level_db", "of the strongest pair, re 1 uPa", "dB", scale,
                  {targets});
  growing<double>("summary/reverberation_db", "expected at that time, re 1 uPa", "dB", scale,
                  {targets});
  growing<double>("summary/noise_db", "in the pulse's band, re 1 uPa", "dB", scale, {targets});
  growing<double>("summary/echo_peak_db", "peak of all paths together, re 1 uPa", "dB", scale,
                  {targets});
  growing<double>("summary/signal_excess_db", "peak over reverberation plus noise", "dB", scale,
                  {targets});
}

void PingFileWriter::Impl::create_sampled_datasets(const PingRecord& record) {
  const Recording& recording = record.recording;
  samples = recording.samples;
  if (scenario.pings.continuous) samples = Stream::longest_part(scenario);
  std::vector<double> time(samples);
  for (std::size_t i = 0; i < samples; ++i)
    time[i] = recording.start + static_cast<double>(i) / recording.sample_rate;
  file.write<double>("time", time, {samples});
  describe(file, "time", "after the start of the ping", "s");
  file.make_scale("time", "sample");
  const std::size_t channels = channels_of(scenario);
  if (recording.is_complex()) {
    write_scale<std::int32_t>(file, "iq", "iq", {0, 1}, "0 real part, 1 imaginary part");
    file.create_growing<float>("pressure", {channels, samples, 2}, Shape{1, 1, samples, 2});
    describe(file, "pressure", "acoustic pressure, complex baseband", "Pa");
    file.attach_scales("pressure", {"ping", "channel", "time", "iq"});
    file.set_attribute("pressure", "carrier_hz", recording.carrier);
    file.set_attribute("pressure", "carrier_clock",
                       scenario.pings.continuous ? "start of the scenario" : "start of the ping");
  } else {
    file.create_growing<float>("pressure", {channels, samples}, Shape{1, 1, samples});
    describe(file, "pressure", "acoustic pressure", "Pa");
    file.attach_scales("pressure", {"ping", "channel", "time"});
  }
  file.set_attribute("pressure", "sample_rate_hz", recording.sample_rate);
  file.set_attribute("pressure", "reference",
                     recording.is_complex()
                         ? "b = Σ A s₊(η(t − τ)) exp(−i2π f_c t), time dependence exp(+iωt)"
                         : "p = Re{Σ A s₊(η(t − τ))}, time dependence exp(+iωt)");
  file.set_attribute("pressure", "continuous", std::int64_t{scenario.pings.continuous});

  level_bins = record.levels.echo.size();
  if (level_bins == 0) return;
  std::vector<double> middle(level_bins);
  for (std::size_t i = 0; i < level_bins; ++i)
    middle[i] = recording.start + (static_cast<double>(i) + 0.5) * record.levels.time_step;
  file.write<double>("levels/level_time", middle, {level_bins});
  describe(file, "levels/level_time", "middle of the interval, after the start of the ping", "s");
  file.make_scale("levels/level_time", "level_time");
  for (const std::string name : {"echo", "reverberation", "noise"}) {
    const std::string dataset = "levels/" + name;
    file.create_growing<float>(dataset, {level_bins}, std::size_t{1});
    describe(file, dataset, "mean-square pressure over the phones, " + name, "Pa2");
    file.attach_scales(dataset, {"ping", "levels/level_time"});
  }
}

/// Rows that are shorter than the longest end in zeros.
void PingFileWriter::Impl::append_pressure(const PingRecord& record) {
  const std::size_t width = record.recording.components(), own = record.recording.samples * width,
                    row = samples * width;
  if (own > row) throw std::logic_error("a ping longer than its file's rows");
  if (own == row) return file.append<float>("pressure", record.pressure);
  std::vector<float> padded(record.phones.size() * row, 0.0F);
  for (std::size_t n = 0; n < record.phones.size(); ++n)
    std::copy_n(record.pressure.begin() + static_cast<std::ptrdiff_t>(n * own), own,
                padded.begin() + static_cast<std::ptrdiff_t>(n * row));
  file.append<float>("pressure", padded);
}

void PingFileWriter::Impl::append_geometry(const PingRecord& record) {
  file.append<std::int32_t>("transmitter", std::array{std::int32_t{record.transmitter}});
  file.append<double>("ping_time", std::array{record.start_time});
  file.append<double>("elevation_deg", std::array{degrees(record.elevation)});
  file.append<double>("platform_position", flat(record.platform.position));
  file.append<double>("platform_velocity", flat(record.platform.velocity));
  std::vector<double> phones;
  for (const Vec3& phone : record.phones)
    for (const double x : phone) phones.push_back(x);
  file.append<double>("phone_position", phones);
  if (scenario.targets.empty()) return;
  std::vector<double> position, velocity, strength;
  std::vector<std::int8_t> present;
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const Target& target = scenario.targets[i];
    for (const double x : record.targets[i].position) position.push_back(x);
    for (const double v : record.targets[i].velocity) velocity.push_back(v);
    strength.push_back(strength_towards(target, record.platform.position, record.start_time));
    present.push_back(record.ping >= target.first_ping && record.ping <= target.last_ping ? 1 : 0);
  }
  file.append<double>("target_position", position);
  file.append<double>("target_velocity", velocity);
  file.append<double>("target_strength_db", strength);
  file.append<std::int8_t>("target_present", present);
}

void PingFileWriter::Impl::append_tables(const PingRecord& record) {
  for (const Leg& leg : record.legs) arrivals.add(record.ping, leg);
  for (const EchoPath& echo : record.echoes) {
    const Vec3& s = echo.heard.slowness;  // along the direction of travel, z down
    const double elevation = std::atan2(-s.z(), std::hypot(s.x(), s.y()));
    const double bearing = compass_degrees(std::atan2(s.x(), s.y()));
    echoes.row({double(record.ping), double(echo.target), double(echo.array),
                double(echo.heard.channel), double(echo.highlight), double(echo.outgoing),
                double(echo.returning), echo.heard.delay, echo.heard.doppler, echo.level_db,
                degrees(elevation), bearing});
  }
  const std::size_t step = (record.patches.size() + most_patches - 1) / most_patches;
  every = std::max(every, step);
  for (std::size_t i = 0; i < record.patches.size(); i += std::max<std::size_t>(1, step)) {
    const PatchRow& p = record.patches[i];
    patches.row({double(record.ping), static_cast<double>(p.ground), compass_degrees(p.bearing),
                 p.range, p.area, p.delay, degrees(p.grazing_in), degrees(p.grazing_out),
                 degrees(p.launch_elevation), degrees(p.arrival_elevation),
                 p.scattering_strength_db, p.level_db});
  }
  for (const HeardPath& p : record.interference)
    interference->row({double(record.ping), double(p.interferer), double(p.array), p.delay,
                       p.doppler, p.range, compass_degrees(p.bearing),
                       degrees(p.path.launch_elevation), degrees(p.path.arrival_elevation),
                       p.path.amplitude.real(), p.path.amplitude.imag(),
                       double(p.path.surface_bounces), double(p.path.bottom_bounces)});
  if (interference) interference->write();
  arrivals.write();
  echoes.write();
  patches.write();
  file.set_attribute("patches", "every", static_cast<std::int64_t>(every));
}

void PingFileWriter::Impl::append_summary(const PingRecord& record) {
  if (scenario.targets.empty()) return;
  std::vector<std::int8_t> present;
  std::vector<std::int32_t> array, paths;
  std::vector<double> time, level, reverberation, noise, peak, excess;
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const TargetSummary row = i < record.summary.size() ? record.summary[i] : TargetSummary{};
    const bool heard = row.present && row.paths > 0;
    present.push_back(row.present ? 1 : 0);
    array.push_back(heard ? row.array : -1);
    paths.push_back(row.paths);
    time.push_back(heard ? row.echo_time : missing);
    level.push_back(heard ? row.echo_level_db : missing);
    reverberation.push_back(heard ? row.reverberation_db : missing);
    noise.push_back(heard ? row.noise_db : missing);
    peak.push_back(heard ? row.echo_peak_db : missing);
    excess.push_back(heard ? row.signal_excess_db : missing);
  }
  file.append<std::int8_t>("summary/present", present);
  file.append<std::int32_t>("summary/array", array);
  file.append<std::int32_t>("summary/paths", paths);
  file.append<double>("summary/echo_time", time);
  file.append<double>("summary/echo_level_db", level);
  file.append<double>("summary/reverberation_db", reverberation);
  file.append<double>("summary/noise_db", noise);
  file.append<double>("summary/echo_peak_db", peak);
  file.append<double>("summary/signal_excess_db", excess);
}

PingFileWriter::PingFileWriter(const std::filesystem::path& path, const Scenario& scenario,
                               const Provenance& provenance)
    : impl_(std::make_unique<Impl>(path, scenario)) {
  try {
    ping_file::write_root(impl_->file, scenario, provenance);
    ping_file::write_replicas(impl_->file, scenario);
    ping_file::write_environment(impl_->file, scenario);
    impl_->create_ping_datasets();
    impl_->file.flush();  // readable from now on, whatever happens
  } catch (...) {
    remove_part();
    throw;
  }
}

PingFileWriter::PingFileWriter(PingFileWriter&&) noexcept = default;

PingFileWriter::~PingFileWriter() {
  if (impl_ != nullptr && !impl_->finished && impl_->pings == 0) remove_part();
}

void PingFileWriter::remove_part() noexcept {
  const std::filesystem::path part = impl_->part;
  impl_.reset();  // closes
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
}

void PingFileWriter::write_rays(const RayPaths& rays) {
  ping_file::write_rays(impl_->file, rays);
  impl_->file.flush();
}

void PingFileWriter::append(const PingRecord& record) {
  const auto begin = std::chrono::steady_clock::now();
  Impl& to = *impl_;
  const std::size_t channels = channels_of(to.scenario);
  if (record.phones.size() != channels || record.targets.size() != to.scenario.targets.size() ||
      record.pressure.size() != channels * record.recording.samples * record.recording.components())
    throw std::logic_error("a ping record of another shape than its scenario");
  if (to.pings == 0) to.create_sampled_datasets(record);

  to.append_pressure(record);
  if (to.level_bins > 0) {
    const std::size_t bins = record.levels.echo.size();
    to.file.append_padded<float>("levels/echo", record.levels.echo, bins);
    to.file.append_padded<float>("levels/reverberation", record.levels.reverberation, bins);
    to.file.append_padded<float>("levels/noise", record.levels.noise, bins);
  }
  to.append_geometry(record);
  to.append_tables(record);
  to.append_summary(record);
  to.file.append<std::int32_t>("run/band_points", std::array{std::int32_t{record.band.points}});
  to.file.append<double>("run/band_error", std::array{record.band.error});
  to.file.append<std::int64_t>("valid_samples",
                               std::array{static_cast<std::int64_t>(record.recording.samples)});
  to.file.append<std::int32_t>("ping", std::array{std::int32_t{record.ping}});
  const Timings& t = record.timings;
  to.file.append<double>("run/time_rays", std::array{t.rays});
  to.file.append<double>("run/time_eigenrays", std::array{t.eigenrays});
  to.file.append<double>("run/time_patches", std::array{t.patches});
  to.file.append<double>("run/time_synthesis", std::array{t.synthesis});
  to.file.append<double>("run/time_noise", std::array{t.noise});
  const Reuse& reuse = record.reuse;
  to.file.append<std::int8_t>("run/reuse_ocean", std::array{std::int8_t{reuse.ocean}});
  to.file.append<std::int32_t>("run/legs_searched", std::array{std::int32_t{reuse.legs_searched}});
  to.file.append<std::int32_t>("run/legs_reused", std::array{std::int32_t{reuse.legs_reused}});
  to.file.append<std::int8_t>("run/reuse_reverberation",
                              std::array{std::int8_t{reuse.reverberation}});
  to.file.append<std::int8_t>("run/reuse_expected_level",
                              std::array{std::int8_t{reuse.expected_level}});
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  to.file.append<double>("run/time_write", std::array{wall.count()});
  to.file.flush();
  ++to.pings;
}

void PingFileWriter::finish(bool complete) {
  Impl& to = *impl_;
  if (to.finished) throw std::logic_error("a ping file is finished once");
  if (complete) to.file.set_attribute("", "complete", std::int64_t{1});
  to.file.close();
  to.finished = true;
  std::error_code error;
  if (!complete && to.pings == 0) {
    std::filesystem::remove(to.part, error);
    return;
  }
  std::filesystem::rename(to.part, to.path, error);
  if (error)
    throw RunError(to.path.string() + ": cannot get its name from " + to.part.string() + ": " +
                   error.message());
}

}  // namespace asdic
