#include "study/measures/signal_excess.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "processing/detection_threshold.h"
#include "processing/signal_excess.h"
#include "sonar/noise/noise_in_guide.h"

namespace asdic::detail::study {
namespace {

/// The phones that are added, and where the beam looks.
struct Beam {
  std::vector<Vec3> phones;        // [n] [m]
  Vec3 slowness = Vec3::Zero();    // of the echo [s/m]
  double angular_frequency = 0.0;  // at the pulse's centre [rad/s]
};

/// 10 lg of 1/⟨|w·e^{−iω s_φ·x}|²⟩: what it keeps of sound that comes from all bearings φ alike, at
/// the echo's own elevation [dB].
double gain_over_reverberation(const Beam& beam) {
  const double horizontal = beam.slowness.head<2>().norm();
  double extent = 0.0;
  for (const Vec3& phone : beam.phones)
    extent = std::max(extent, (phone - beam.phones.front()).norm());
  const double waves = beam.angular_frequency * horizontal * extent / (2.0 * pi);
  const int steps = 360 + 16 * static_cast<int>(std::ceil(waves));
  double kept = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double bearing = 2.0 * pi * i / steps;
    const Vec3 from(horizontal * std::sin(bearing), horizontal * std::cos(bearing),
                    beam.slowness.z());
    std::complex<double> sum = 0.0;
    for (const Vec3& phone : beam.phones)
      sum += std::polar(1.0, beam.angular_frequency * (beam.slowness - from).dot(phone));
    kept += std::norm(sum);
  }
  const auto n = static_cast<double>(beam.phones.size());
  return -db_from_power(kept / (n * n * steps));
}

const EchoPath* loudest(const PingRecord& record, int array, int target) {
  const EchoPath* best = nullptr;
  for (const EchoPath& echo : record.echoes)
    if (echo.array == array && echo.target == target &&
        (best == nullptr || echo.level_db > best->level_db))
      best = &echo;
  return best;
}

}  // namespace

double detection_signal_excess_db(const PingSimulator& simulator, const PingRecord& record,
                                  const ListeningReceiver& receiver, int target) {
  const TargetSummary& received = record.summary[static_cast<std::size_t>(target)];
  if (!received.present || received.paths == 0) return -infinity;
  if (received.array != receiver.array) return std::nan("");
  const Scenario& scenario = simulator.scenario();
  const Pulse& pulse = simulator.pulse(record.transmitter);
  Beam beam{.phones = {},
            .slowness = loudest(record, receiver.array, target)->received.slowness,
            .angular_frequency = 2.0 * pi * pulse.centre_frequency()};
  const std::size_t first = first_channel(scenario, receiver.array);
  const std::size_t count = scenario.arrays[static_cast<std::size_t>(receiver.array)].phones.size();
  for (std::size_t n = 0; n < count; ++n)
    if (!receiver.phone || static_cast<std::size_t>(*receiver.phone) == n)
      beam.phones.push_back(record.phones[first + n] - record.phones[first]);

  const double over_noise = gain_over_noise_db(
      beam.phones, beam.slowness, beam.angular_frequency,
      noise_coherences(beam.phones, beam.angular_frequency * beam.slowness.norm(),
                       noise_field(scenario, receiver.array)));
  return signal_excess_db(
      {.echo_db = received.echo_peak_db,
       .reverberation_db = received.reverberation_db - gain_over_reverberation(beam),
       .noise_db = received.noise_db - over_noise},
      matched_filter_gain(pulse),
      detection_threshold_db(receiver.false_alarm_probability, receiver.cells));
}

}  // namespace asdic::detail::study
