// What a ping adds to the datasets of its file.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "io/ping/writer.h"

namespace asdic::detail {
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
    patches.row({double(record.ping), static_cast<double>(p.ground), compass_degrees(p.bearing),
                 p.range, p.area, p.delay, degrees(p.grazing_in), degrees(p.grazing_out),
                 degrees(p.launch_elevation), degrees(p.arrival_elevation),
                 p.scattering_strength_db, p.level_db});
  }
  for (const ReceivedPath& p : record.interference)
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
