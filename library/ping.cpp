#include "asdic/ping.h"

#include <cmath>

#include "core/geometry.h"
#include "library/physics.h"
#include "library/ping_access.h"
#include "processing/truth.h"
#include "raytrace/parallel/stop.h"
#include "sonar/ping/run_pings.h"

namespace asdic {
namespace {

Echo shown(const detail::TrueEcho& echo, int array) {
  const detail::Vec3& travel = echo.travel;  // z down
  return {.target = echo.target,
          .array = array,
          .delay = echo.time,
          .struck = echo.struck,
          .doppler = echo.doppler,
          .level_db = echo.level_db,
          .arrival_elevation = std::atan2(-travel.z(), std::hypot(travel.x(), travel.y())),
          .arrival_bearing = std::atan2(travel.x(), travel.y())};
}

/// What an array receives of a ping: echoes, and the transmitter's own sound on its way there.
std::vector<detail::TrueEcho> truth_of(const detail::PingRecord& record, int array) {
  std::vector<detail::TrueEcho> truth = detail::true_echoes(record, array);
  for (const detail::Leg& leg : record.legs) {
    if (leg.kind != detail::Leg::Kind::source_to_array || leg.array != array) continue;
    for (const detail::Arrival& path : leg.arrivals)
      truth.push_back({.target = detail::direct_sound,
                       .time = path.delay,
                       .doppler = std::numeric_limits<double>::quiet_NaN(),
                       .level_db = detail::infinity,
                       .travel = detail::direction(detail::arrival_bearing(path, leg.bearing),
                                                   path.arrival_elevation)});
  }
  return truth;
}

Ping handle_of(const Scenario& scenario, detail::PingRecord record) {
  return PingAccess::made(scenario, Access::physics(scenario).simulator(), std::move(record));
}

}  // namespace

Ping PingAccess::made(const Scenario& scenario, const detail::PingSimulator& simulator,
                      detail::PingRecord record) {
  std::vector<std::vector<detail::TrueEcho>> truth;
  const auto arrays = simulator.scenario().arrays.size();
  for (std::size_t array = 0; array < arrays; ++array)
    truth.push_back(truth_of(record, static_cast<int>(array)));
  return made(scenario, std::move(record), std::move(truth), false);
}

Ping PingAccess::made(const Scenario& scenario, detail::PingRecord record,
                      std::vector<std::vector<detail::TrueEcho>> truth, bool from_file) {
  auto data = std::make_shared<Ping::Data>();
  data->scenario = scenario;
  for (const detail::Vec3& phone : record.phones)
    data->phones.push_back({phone.x(), phone.y(), phone.z()});
  for (std::size_t array = 0; array < truth.size(); ++array)
    for (const detail::TrueEcho& echo : truth[array])
      if (echo.target >= 0) data->echoes.push_back(shown(echo, static_cast<int>(array)));
  data->record = std::move(record);
  data->truth = std::move(truth);
  data->from_file = from_file;
  return Ping(std::move(data));
}

Ping::Ping(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
Ping::Ping(const Ping&) noexcept = default;
Ping& Ping::operator=(const Ping&) noexcept = default;
Ping::~Ping() = default;

int Ping::number() const noexcept { return data_->record.ping; }
int Ping::transmitter() const noexcept { return data_->record.transmitter; }
double Ping::time() const noexcept { return data_->record.start_time; }
std::size_t Ping::channels() const noexcept { return data_->phones.size(); }
std::size_t Ping::samples() const noexcept { return data_->record.recording.samples; }
double Ping::sample_rate() const noexcept { return data_->record.recording.sample_rate; }
double Ping::start() const noexcept { return data_->record.recording.start; }
bool Ping::is_complex() const noexcept { return data_->record.recording.is_complex(); }
double Ping::carrier() const noexcept { return data_->record.recording.carrier; }
std::span<const float> Ping::pressure() const noexcept { return data_->record.pressure; }

std::span<const float> Ping::channel(std::size_t number) const {
  if (number >= channels())
    throw InputError("channel", std::to_string(number),
                     "a channel from 0 to " + std::to_string(channels() - 1));
  const std::size_t length = samples() * data_->record.recording.components();
  return pressure().subspan(number * length, length);
}

const std::vector<Vector>& Ping::phones() const noexcept { return data_->phones; }
const std::vector<Echo>& Ping::echoes() const noexcept { return data_->echoes; }
const Scenario& Ping::scenario() const noexcept { return data_->scenario; }

Ping ping(const Scenario& scenario, int number, const Watch& watch) {
  return Pinger(scenario, watch).ping(number, {.stop = watch.stop});
}

Pinger::Pinger(const Scenario& scenario, const Watch& watch) : scenario_(scenario) {
  translated([&] { static_cast<void>(Access::physics(scenario_).ready_to_ping(watch)); });
}

Pinger::Pinger(const Pinger&) noexcept = default;
Pinger& Pinger::operator=(const Pinger&) noexcept = default;
Pinger::~Pinger() = default;

int Pinger::pings() const noexcept { return Access::physics(scenario_).simulator().pings(); }

std::vector<std::string> Pinger::warnings() const {
  return Access::physics(scenario_).simulator().scenario().notes;
}

Ping Pinger::ping(int number, const Watch& watch) const {
  if (number < 1 || number > pings())
    throw InputError("number", std::to_string(number),
                     "a ping from 1 to " + std::to_string(pings()));
  return translated([&] {
    detail::PingRecord record;
    detail::until_stopped(
        watch.stop, [&] { record = Access::physics(scenario_).simulator().simulate(number); });
    if (watch.progress) watch.progress(1, 1);
    return handle_of(scenario_, std::move(record));
  });
}

void Pinger::run(const std::function<void(const Ping&)>& take, const Watch& watch) const {
  if (!take) throw InputError("take", "nothing", "a function that takes the pings");
  translated([&] {
    detail::PingOptions options{.stop = watch.stop};
    if (watch.progress) options.progress = [&](int done) { watch.progress(done, pings()); };
    const int done = detail::run_pings(
        Access::physics(scenario_).simulator(),
        [&](detail::PingRecord&& record) { take(handle_of(scenario_, std::move(record))); },
        options);
    if (done < pings()) throw Stopped();
  });
}

}  // namespace asdic
