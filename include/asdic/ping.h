#pragma once

/// \file
/// Pings: calibrated pressure at every phone, and the truth behind it.
///
/// ```cpp
/// asdic::Scenario scenario = asdic::Scenario::read("deep_ocean.toml");
/// scenario.set("pings.recording_duration", 36.0);
/// const asdic::Ping ping = asdic::ping(scenario);
/// std::span<const float> phone = ping.channel(0);
/// std::cout << ping.channels() << " phones, " << phone.size() << " samples, the first at "
///           << ping.start() << " s\n";
/// for (const asdic::Echo& echo : ping.echoes())
///   std::cout << echo.delay << " s: " << echo.level_db << " dB re 1 µPa\n";
/// ```

#include <complex>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "asdic/export.h"
#include "asdic/scenario.h"
#include "asdic/units.h"
#include "asdic/watch.h"

namespace asdic {

/// One echo: one path out, one path home, one place of the target.
struct Echo {
  int target = 0;                  ///< in the scenario, from 0
  int array = 0;                   ///< in the scenario, from 0
  double delay = 0.0;              ///< of its leading edge, after the ping's start [s]
  double struck = 0.0;             ///< when that met the target, after the ping's start [s]
  double doppler = 1.0;            ///< received over transmitted frequency
  double level_db = 0.0;           ///< peak envelope/√2, pulse not windowed [dB re 1 µPa]
  double arrival_elevation = 0.0;  ///< of travel at the array, positive up [rad]
  double arrival_bearing = 0.0;    ///< of travel at the array, true [rad]
};

/// A ping's record. A handle: copies share the samples, which never change. To move is to copy:
/// what was moved from stays as it was.
class ASDIC_API Ping {
 public:
  Ping(const Ping&) noexcept;
  Ping& operator=(const Ping&) noexcept;
  ~Ping();

  [[nodiscard]] int number() const noexcept;       ///< of all transmitters' pings, from 1
  [[nodiscard]] int transmitter() const noexcept;  ///< in the scenario, from 0
  [[nodiscard]] double time() const noexcept;  ///< when it was sent, of the scenario's clock [s]

  [[nodiscard]] std::size_t channels() const noexcept;  ///< phones of all arrays
  [[nodiscard]] std::size_t samples() const noexcept;   ///< of a channel
  [[nodiscard]] double sample_rate() const noexcept;    ///< [Hz]
  [[nodiscard]] double start() const noexcept;          ///< of the first sample, after time() [s]
  /// Complex baseband about carrier(), real and imaginary parts in turn; else real pressure.
  [[nodiscard]] bool is_complex() const noexcept;
  [[nodiscard]] double carrier() const noexcept;  ///< [Hz]; 0 of real pressure

  /// [channels × samples], of complex baseband [channels × samples × 2] [Pa]. Not a copy: it lives
  /// as long as one of the handles.
  [[nodiscard]] std::span<const float> pressure() const noexcept;
  /// Of one phone. \throws InputError if there is no such
  [[nodiscard]] std::span<const float> channel(std::size_t number) const;
  /// [channels] where the phones are when the ping is sent [m]
  [[nodiscard]] const std::vector<Vector>& phones() const noexcept;

  /// The truth. Where paths are too many to be listed, the loudest of them.
  [[nodiscard]] const std::vector<Echo>& echoes() const noexcept;
  /// The scenario that it is of.
  [[nodiscard]] const Scenario& scenario() const noexcept;

  struct Data;  ///< of the library alone

 private:
  friend struct PingAccess;
  explicit Ping(std::shared_ptr<const Data> data);
  std::shared_ptr<const Data> data_;
};

/// One ping of a scenario, by itself. The first one of a scenario prepares its ocean; others, of
/// this or a copy of it, find it again. \param number  from 1   \throws InputError, Stopped
[[nodiscard]] ASDIC_API Ping ping(const Scenario& scenario, int number = 1,
                                  const Watch& watch = {});

/// All pings of a scenario, one after the other, with what goes from ping to ping: the ocean, the
/// paths, and of a continuous record what is still received of the pings before.
///
/// ```
/// asdic::Pinger pinger(scenario);
/// pinger.run([](const asdic::Ping& ping) { … });
/// ```
class ASDIC_API Pinger {
 public:
  /// Checks the scenario and its memory, as Scenario::validate(). \throws InputError, Stopped
  explicit Pinger(const Scenario& scenario, const Watch& watch = {});
  Pinger(const Pinger&) noexcept;
  Pinger& operator=(const Pinger&) noexcept;
  ~Pinger();

  [[nodiscard]] int pings() const noexcept;  ///< of all transmitters
  /// What to know before trusting a number.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// One ping by itself. From any thread. \param number  from 1   \throws InputError, Stopped
  [[nodiscard]] Ping ping(int number, const Watch& watch = {}) const;
  /// Simulates all pings, in parallel, and hands them over in order, one at a time. \throws Stopped
  /// once those before it are handed over
  void run(const std::function<void(const Ping&)>& take, const Watch& watch = {}) const;

 private:
  Scenario scenario_;
};

}  // namespace asdic
