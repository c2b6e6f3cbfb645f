#include "io/ping/writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "sonar/ping/stream_parts.h"

namespace asdic::detail {

// The datasets of a ping file, before their first row.

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
  create_places({"platform_latitude", "platform_longitude"}, "transmitter", {}, {});
  growing<double>("platform_velocity", "velocity of the transmitter", "m/s", {"xyz"}, {3});
  const std::size_t channels = channels_of(scenario), targets = scenario.targets.size();
  growing<double>("phone_position", "phones at the start of the ping", "m", {"channel", "xyz"},
                  {channels, 3});
  for (const char* name : {"rays", "eigenrays", "patches", "synthesis", "noise", "write"})
    growing<double>(std::string("run/time_") + name, std::string("wall time of ") + name, "s");
  growing<std::int8_t>("run/reuse_ocean", "1 if another simulator had used an equal ocean", "");
  growing<std::int32_t>("run/legs_searched", "sets of eigenrays that were searched for", "");
  growing<std::int32_t>("run/legs_reused", "sets of eigenrays that were known", "");
  growing<std::int32_t>("run/planes_searched",
                        "vertical planes in which paths to scatterers were searched for", "");
  growing<std::int32_t>("run/planes_reused", "vertical planes of which they were known", "");
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
  growing<std::int32_t>("run/ended_searches",
                        "for paths in three dimensions, for their cost, so far", "");
  growing<std::int8_t>("run/sea_drawn_anew",
                       "1 if weights that last are drawn anew: too many scatterers, under way", "");
  growing<std::int8_t>("run/reuse_expected_level",
                       "1 if the reverberation's expected level was known", "");
  if (targets == 0) return;
  const std::vector<std::string> scale{"target_index"}, vector{"target_index", "xyz"};
  growing<double>("target_position", "target at the start of the ping", "m", vector, {targets, 3});
  create_places({"target_latitude", "target_longitude"}, "target", scale, {targets});
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
  if (scenario.pings.continuous) samples = longest_stream_part(scenario);
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

// What a ping adds to the datasets of its file.

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_patches = 2000;  // rows a ping

/// Pairs of paths that have no row in /echoes.
std::size_t not_listed(const PingRecord& record) {
  std::size_t all = 0, listed = 0;
  for (const ManyEchoes& many : record.many_echoes) {
    all += many.pairs;
    std::set<std::pair<int, int>> pairs;
    for (const EchoPath& echo : record.echoes)
      if (echo.target == many.target && echo.array == many.array)
        pairs.emplace(echo.outgoing, echo.returning);
    listed += pairs.size();
  }
  return all - std::min(all, listed);
}

std::vector<double> flat(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

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

void PingFileWriter::Impl::create_places(const PlaceNames& names, const std::string& whose,
                                         const std::vector<std::string>& scales, const Shape& row) {
  if (!earth.known()) return;
  growing<double>(names.latitude, "latitude of the " + whose + " at the start of the ping",
                  "degrees_north", scales, row, cf::latitude);
  growing<double>(names.longitude, "longitude of the " + whose + " at the start of the ping",
                  "degrees_east", scales, row, cf::longitude);
}

void PingFileWriter::Impl::append_places(const PlaceNames& names,
                                         const std::vector<Vec2>& positions) {
  if (!earth.known()) return;
  const LatitudesLongitudes all = on_earth(earth, positions);
  file.append<double>(names.latitude, all.latitude);
  file.append<double>(names.longitude, all.longitude);
}

void PingFileWriter::Impl::append_geometry(const PingRecord& record) {
  file.append<std::int32_t>("transmitter", std::array{std::int32_t{record.transmitter}});
  file.append<double>("ping_time", std::array{record.start_time});
  file.append<double>("elevation_deg", std::array{degrees(record.elevation)});
  file.append<double>("platform_position", flat(record.platform.position));
  append_places({"platform_latitude", "platform_longitude"}, {record.platform.position.head<2>()});
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
  std::vector<Vec2> places;
  for (const auto& target : record.targets) places.emplace_back(target.position.head<2>());
  append_places({"target_latitude", "target_longitude"}, places);
  file.append<double>("target_velocity", velocity);
  file.append<double>("target_strength_db", strength);
  file.append<std::int8_t>("target_present", present);
}

void PingFileWriter::Impl::append_tables(const PingRecord& record) {
  for (const Leg& leg : record.legs) arrivals.add(record.ping, leg);
  for (const EchoPath& echo : record.echoes) {
    const Vec3& s = echo.received.slowness;  // along the direction of travel, z down
    const double elevation = std::atan2(-s.z(), std::hypot(s.x(), s.y()));
    const double bearing = compass_degrees(std::atan2(s.x(), s.y()));
    echoes.row({double(record.ping), double(echo.target), double(echo.array),
                double(echo.received.channel), double(echo.highlight), double(echo.outgoing),
                double(echo.returning), echo.received.delay, echo.struck, echo.received.doppler,
                echo.level_db, degrees(elevation), bearing});
  }
  const std::size_t step = (record.patches.size() + most_patches - 1) / most_patches;
  every = std::max(every, step);
  for (std::size_t i = 0; i < record.patches.size(); i += std::max<std::size_t>(1, step)) {
    const PatchRow& p = record.patches[i];
    std::vector<double> row{double(record.ping),
                            static_cast<double>(p.ground),
                            compass_degrees(p.bearing),
                            p.range,
                            p.area,
                            p.delay,
                            degrees(p.grazing_in),
                            degrees(p.grazing_out),
                            degrees(p.launch_elevation),
                            degrees(p.arrival_elevation),
                            p.scattering_strength_db,
                            p.level_db};
    if (earth.known()) {
      const GeographicPlace there = earth.at(p.place.x(), p.place.y());
      row.insert(row.end(), {there.latitude, there.longitude});
    }
    patches.row(row);
  }
  for (const ReceivedPath& p : record.interference)
    interference->row({double(record.ping), double(p.interferer), double(p.array), p.delay,
                       p.doppler, p.range, compass_degrees(arrival_bearing(p.path, p.bearing)),
                       degrees(p.path.launch_elevation), degrees(p.path.arrival_elevation),
                       p.path.amplitude.real(), p.path.amplitude.imag(),
                       double(p.path.surface_bounces), double(p.path.bottom_bounces)});
  if (interference) interference->write();
  arrivals.write();
  echoes.write();
  patches.write();
  file.set_attribute("patches", "every", static_cast<std::int64_t>(every));
  echoes_not_listed = std::max(echoes_not_listed, not_listed(record));
  file.set_attribute("echoes", "not_listed", static_cast<std::int64_t>(echoes_not_listed));
}

void PingFileWriter::Impl::append_summary(const PingRecord& record) {
  if (scenario.targets.empty()) return;
  std::vector<std::int8_t> present;
  std::vector<std::int32_t> array, paths;
  std::vector<double> time, level, reverberation, noise, peak, excess;
  for (std::size_t i = 0; i < scenario.targets.size(); ++i) {
    const TargetSummary row = i < record.summary.size() ? record.summary[i] : TargetSummary{};
    const bool received = row.present && row.paths > 0;
    present.push_back(row.present ? 1 : 0);
    array.push_back(received ? row.array : -1);
    paths.push_back(row.paths);
    time.push_back(received ? row.echo_time : missing);
    level.push_back(received ? row.echo_level_db : missing);
    reverberation.push_back(received ? row.reverberation_db : missing);
    noise.push_back(received ? row.noise_db : missing);
    peak.push_back(received ? row.echo_peak_db : missing);
    excess.push_back(received ? row.signal_excess_db : missing);
  }
  file.append<std::int8_t>("summary/present", present);
  file.append<std::int32_t>("summary/array", array);
  file.append<std::int32_t>("summary/paths", paths);
  file.append<double>("summary/echo_time", time);
  file.append<double>("summary/echo_level_db", level);
  file.append<double>("summary/reverberation_db", reverberation);
  file.append<double>("summary/noise_db", noise);
  file.append<double>("summary/echo_peak_db", peak);
  for (const char* name : {"echo_to_background_db", "signal_excess_db"})  // and its old name
    file.append<double>(std::string("summary/") + name, excess);
}

}  // namespace asdic::detail
