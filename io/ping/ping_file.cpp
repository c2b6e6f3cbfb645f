#include "io/ping/ping_file.h"

#include <array>
#include <chrono>
#include <stdexcept>

#include "core/error.h"
#include "io/hdf5/own_files.h"
#include "io/ping/writer.h"

namespace asdic::detail {

PingFileWriter::PingFileWriter(const std::filesystem::path& path, const Scenario& scenario,
                               const Provenance& provenance, SampleTimes times)
    : PingFileWriter(OutputFile(path, {.own = own::hdf5, .worth = own::pings}), scenario,
                     provenance, times) {}

PingFileWriter::PingFileWriter(OutputFile output, const Scenario& scenario,
                               const Provenance& provenance, SampleTimes times)
    : impl_(std::make_unique<Impl>(std::move(output), scenario, times)) {
  ping_file::write_root(impl_->file, scenario, provenance);
  ping_file::write_replicas(impl_->file, scenario, times);
  ping_file::write_environment(impl_->file, scenario);
  impl_->create_ping_datasets();
  impl_->file.flush();  // readable from now on, whatever happens
}

PingFileWriter::PingFileWriter(PingFileWriter&&) noexcept = default;

PingFileWriter::~PingFileWriter() = default;

const std::filesystem::path& PingFileWriter::part() { return impl_->output.part(); }

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
  if (to.long_arrays) {
    to.file.append<std::int32_t>("run/phone_groups",
                                 std::array{std::int32_t{record.plane_waves.groups}});
    to.file.append<double>("run/plane_wave_error", std::array{record.plane_waves.error});
  }
  to.file.append<std::int32_t>("run/surface_bounces", std::array{record.bounces.surface});
  to.file.append<std::int32_t>("run/bottom_bounces", std::array{record.bounces.bottom});
  to.file.append<double>("run/left_out_db", std::array{record.bounces.left_out_db});
  to.file.append<std::int32_t>("run/ended_searches",
                               std::array{static_cast<std::int32_t>(record.ended_searches)});
  to.file.append<std::int8_t>("run/sea_drawn_anew", std::array{std::int8_t{record.sea_drawn_anew}});
  to.file.append<std::int64_t>("valid_samples",
                               std::array{static_cast<std::int64_t>(record.recording.samples)});
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
  to.file.append<std::int32_t>("run/planes_searched",
                               std::array{std::int32_t{reuse.planes_searched}});
  to.file.append<std::int32_t>("run/planes_reused", std::array{std::int32_t{reuse.planes_reused}});
  to.file.append<std::int8_t>("run/reuse_reverberation",
                              std::array{std::int8_t{reuse.reverberation}});
  to.file.append<std::int8_t>("run/reuse_expected_level",
                              std::array{std::int8_t{reuse.expected_level}});
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  to.file.append<double>("run/time_write", std::array{wall.count()});
  // It counts once all of it is there: what one flush writes comes in no order, and the program may
  // be killed in the middle of it.
  to.file.flush();
  to.file.append<std::int32_t>("ping", std::array{std::int32_t{record.ping}});
  to.file.flush();
  ++to.pings;
  to.output.keep();  // hours of work are not thrown away by an exception
}

void PingFileWriter::finish_these() {
  impl_->file.set_attribute("", "pings_requested", static_cast<std::int64_t>(impl_->pings));
  finish(true);
}

void PingFileWriter::finish(bool complete) {
  Impl& to = *impl_;
  if (to.finished) throw std::logic_error("a ping file is finished once");
  if (complete) to.file.set_attribute("", "complete", std::int64_t{1});
  to.file.close();
  to.finished = true;
  if (complete || to.pings > 0) to.output.finish();
}

Hdf5File open_ping_file(const std::filesystem::path& path) {
  Hdf5File file = Hdf5File::open(path);
  const auto wrong = [&](const std::string& got, const std::string& expected) {
    return InputError({.where = path.string(), .got = got, .expected = expected});
  };
  if (!file.has_attribute("", "filetype"))
    throw wrong("an HDF5 file without filetype", "a ping file of asdic");
  if (const std::string type = file.attribute_text("", "filetype"); type != "asdic ping")
    throw wrong("filetype \"" + type + "\"", "\"asdic ping\"");
  const std::string version = file.attribute_text("", "version");
  if (!version.starts_with("1.") && !version.starts_with("2.") && !version.starts_with("3."))
    throw wrong("version " + version, "version 1.x, 2.x or 3.x");
  return file;
}

PingFile::PingFile(const std::filesystem::path& path) : file_(open_ping_file(path)) {
  const auto wrong = [&](const std::string& got, const std::string& expected) {
    return InputError({.where = path.string(), .got = got, .expected = expected});
  };
  if (file_.has("pressure")) shape_ = file_.info("pressure").shape;
  const bool complex = shape_.size() == 4 && shape_[3] == 2;
  if (shape_.size() != 3 && !complex)
    throw wrong("pressure of another rank",
                "(ping, channel, sample) or (ping, channel, sample, 2)");
  components_ = complex ? 2 : 1;
  shape_[0] = file_.has("ping") ? file_.info("ping").shape[0] : 0;  // written last: whole pings
}

double PingFile::sample_rate() const {
  return file_.attribute_number("pressure", "sample_rate_hz");
}

double PingFile::carrier() const {
  return is_complex() ? file_.attribute_number("pressure", "carrier_hz") : 0.0;
}

bool PingFile::complete() const { return file_.attribute_number("", "complete") == 1.0; }

std::vector<int> PingFile::numbers() const {
  return pings() == 0 ? std::vector<int>{} : file_.read<std::int32_t>("ping", {0}, {pings()});
}

std::string PingFile::scenario_text() const { return file_.read_text("scenario"); }

void PingFile::check(std::size_t ping) const {
  if (ping >= pings())
    throw InputError({.where = file_.path().string() + ": ping",
                      .got = std::to_string(ping + 1),
                      .expected = "a ping from 1 to " + std::to_string(pings())});
}

std::size_t PingFile::valid_samples(std::size_t ping) const {
  check(ping);
  return static_cast<std::size_t>(file_.read<std::int64_t>("valid_samples", {ping}, {1}).front());
}

std::vector<float> PingFile::pressure(std::size_t ping, std::size_t channel) const {
  const std::size_t n = valid_samples(ping);
  if (channel >= channels())
    throw InputError({.where = file_.path().string() + ": channel",
                      .got = std::to_string(channel),
                      .expected = "a channel from 0 to " + std::to_string(channels() - 1)});
  if (is_complex()) return file_.read<float>("pressure", {ping, channel, 0, 0}, {1, 1, n, 2});
  return file_.read<float>("pressure", {ping, channel, 0}, {1, 1, n});
}

std::vector<TargetSummary> PingFile::summary(std::size_t ping) const {
  check(ping);
  std::vector<TargetSummary> rows;
  if (!file_.has("summary/present")) return rows;
  const Shape shape = file_.info("summary/present").shape;
  if (shape.size() != 2)
    throw InputError({.where = file_.path().string() + ": summary/present",
                      .got = std::to_string(shape.size()) + " dimensions",
                      .expected = "2, ping and target"});
  const std::size_t n = shape[1];
  const auto column = [&](const std::string& key) {
    return file_.read<double>("summary/" + key, {ping, 0}, {1, n});
  };
  const auto present = column("present"), paths = column("paths"), time = column("echo_time"),
             level = column("echo_level_db"), reverberation = column("reverberation_db"),
             noise = column("noise_db"), peak = column("echo_peak_db"),
             excess = column(file_.has("summary/echo_to_background_db") ? "echo_to_background_db"
                                                                        : "signal_excess_db");
  // Files of before have no such column: the first array's, in most of them the only one.
  const auto array = file_.has("summary/array") ? column("array") : std::vector<double>(n, 0.0);
  std::vector<std::string> names = file_.attribute_texts("target_index", "names");
  names.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    rows.push_back({.name = names[i],
                    .present = present[i] != 0.0,
                    .array = static_cast<int>(array[i]),
                    .paths = static_cast<int>(paths[i]),
                    .echo_time = time[i],
                    .echo_level_db = level[i],
                    .reverberation_db = reverberation[i],
                    .noise_db = noise[i],
                    .echo_peak_db = peak[i],
                    .signal_excess_db = excess[i]});
  }
  return rows;
}

}  // namespace asdic::detail
