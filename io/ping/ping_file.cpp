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
    : PingFileWriter(OutputFile(path, {.own = own::hdf5}), scenario, provenance, times) {}

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

void PingFileWriter::finish(bool complete) {
  Impl& to = *impl_;
  if (to.finished) throw std::logic_error("a ping file is finished once");
  if (complete) to.file.set_attribute("", "complete", std::int64_t{1});
  to.file.close();
  to.finished = true;
  if (complete || to.pings > 0) to.output.finish();
}

}  // namespace asdic::detail
