// The datasets of a ping file, before their first row.
#include "io/ping/writer.h"
#include "sonar/ping/stream.h"

namespace asdic::detail {

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
  if (long_arrays) {
    growing<std::int32_t>("run/phone_groups", "groups of phones that receive reverberation", "");
    growing<double>("run/plane_wave_error",
                    "periods by which its nearest fronts are off at the worst phone", "");
  }
  growing<std::int32_t>("run/surface_bounces", "reflections at the surface that were followed", "");
  growing<std::int32_t>("run/bottom_bounces", "reflections at the bottom that were followed", "");
  growing<double>("run/left_out_db", "of the level, by paths of more bounces, estimated", "dB");
  growing<std::int8_t>("run/reuse_expected_level",
                       "1 if the reverberation's expected level was known", "");
  if (targets == 0) return;
  const std::vector<std::string> scale{"target_index"}, vector{"target_index", "xyz"};
  growing<double>("target_position", "target at the start of the ping", "m", vector, {targets, 3});
  growing<double>("target_velocity", "velocity of the target", "m/s", vector, {targets, 3});
  growing<double>("target_strength_db",
                  "target strength at its aspect from the transmitter, without fluctuation", "dB",
                  scale, {targets}, {.reference = "1 m2"});
  growing<std::int8_t>("target_present", "1 if the target is there", "", scale, {targets});
  growing<std::int8_t>("summary/present", "1 if the target is there", "", scale, {targets});
  growing<std::int32_t>("summary/array",
                        "number of the array that receives the strongest pair, -1: none", "", scale,
                        {targets});
  growing<std::int32_t>("summary/paths", "pairs of paths there and back", "", scale, {targets});
  growing<double>("summary/echo_time", "delay of the strongest pair", "s", scale, {targets});
  growing<double>("summary/echo_level_db", "of the strongest pair", "dB", scale, {targets},
                  cf::level);
  growing<double>("summary/reverberation_db", "expected at that time", "dB", scale, {targets},
                  cf::pressure_level);
  growing<double>("summary/noise_db", "in the pulse's band", "dB", scale, {targets},
                  cf::pressure_level);
  growing<double>("summary/echo_peak_db", "peak of all paths together", "dB", scale, {targets},
                  cf::level);
  growing<double>("summary/echo_to_background_db",
                  "peak over reverberation plus noise, before any processing", "dB", scale,
                  {targets});
  growing<double>("summary/signal_excess_db", "old name of echo_to_background_db; will go", "dB",
                  scale, {targets});
}

void PingFileWriter::Impl::create_sampled_datasets(const PingRecord& record) {
  const Recording& recording = record.recording;
  samples = recording.samples;
  if (scenario.pings.continuous) samples = Stream::longest_part(scenario);
  const TimeAxis time{.dimension = "sample",
                      .coordinate = "time",
                      .long_name = "after the start of the ping",
                      .start = recording.start,
                      .step = 1.0 / recording.sample_rate,
                      .size = samples};
  std::vector<std::string> scales{"ping", "channel",
                                  write_time_axis(file, time, times_written_out)};
  const std::size_t channels = channels_of(scenario);
  if (recording.is_complex()) {
    scales.emplace_back("iq");
    file.create_growing<float>("pressure", {channels, samples, 2}, Shape{1, 1, samples, 2});
    describe(file, "pressure", "acoustic pressure, complex baseband", "Pa");
    file.set_attribute("pressure", "carrier_hz", recording.carrier);
    file.set_attribute("pressure", "carrier_clock",
                       scenario.pings.continuous ? "start of the scenario" : "start of the ping");
  } else {
    file.create_growing<float>("pressure", {channels, samples}, Shape{1, 1, samples});
    describe(file, "pressure", "acoustic pressure", "Pa", cf::pressure);
  }
  file.attach_scales("pressure", scales);
  write_times(file, "pressure", time);
  file.set_attribute("pressure", "sample_rate_hz", recording.sample_rate);
  file.set_attribute("pressure", "reference",
                     recording.is_complex()
                         ? "b = Σ A s₊(η(t − τ)) exp(−i2π f_c t), time dependence exp(+iωt)"
                         : "p = Re{Σ A s₊(η(t − τ))}, time dependence exp(+iωt)");
  file.set_attribute("pressure", "continuous", std::int64_t{scenario.pings.continuous});

  level_bins = record.levels.echo.size();
  if (level_bins == 0) return;
  const TimeAxis middle{.dimension = "levels/interval",
                        .coordinate = "levels/level_time",
                        .long_name = "middle of the interval, after the start of the ping",
                        .start = recording.start + 0.5 * record.levels.time_step,
                        .step = record.levels.time_step,
                        .size = level_bins};
  const std::string interval = write_time_axis(file, middle, times_written_out);
  for (const std::string name : {"echo", "reverberation", "noise"}) {
    const std::string dataset = "levels/" + name;
    file.create_growing<float>(dataset, {level_bins}, std::size_t{1});
    describe(file, dataset, "mean-square pressure over the phones, " + name, "Pa2");
    file.attach_scales(dataset, {"ping", interval});
    write_times(file, dataset, middle);
  }
}

}  // namespace asdic::detail
