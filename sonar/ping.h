#pragma once
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>

#include "raytrace/eigenrays.h"
#include "raytrace/ground_paths.h"
#include "sonar/ping_record.h"
#include "sonar/pulse.h"
#include "sonar/scenario.h"

namespace asdic {

/// Simulates the pings of one scenario. Built once (the ocean, the pulse); simulate() is const in
/// effect and may be called from many threads at once, for any ping in any order: the same bits
/// come out.
class PingSimulator {
 public:
  /// \throws InputError naming the key at fault ("pings.sample_rate", "pulse.duration", …)
  explicit PingSimulator(Scenario scenario);

  /// \param ping  counted from 1
  [[nodiscard]] PingRecord simulate(int ping) const;

  [[nodiscard]] const Scenario& scenario() const noexcept { return scenario_; }
  [[nodiscard]] const EigenraySolver& ocean() const noexcept { return ocean_; }
  [[nodiscard]] const Pulse& pulse() const noexcept { return pulse_; }
  [[nodiscard]] Transmitter transmitter(int ping) const;  ///< with the elevation of that ping
  [[nodiscard]] double ground_spacing() const;  ///< of the reverberation's ground grid [m]

 private:
  [[nodiscard]] std::shared_ptr<const GroundPaths> ground(double platform_depth) const;

  Scenario scenario_;
  Pulse pulse_;
  EigenraySolver ocean_;
  double max_doppler_ = 0.0;
  // Paths to the surface depend on the platform's depth alone; a platform that keeps its depth has
  // them traced once.
  mutable std::mutex ground_lock_;
  mutable std::map<double, std::shared_ptr<const GroundPaths>> ground_;
};

struct PingOptions {
  std::stop_token stop;  ///< when requested, pings in hand are finished, no new one is begun
  std::function<void(int done)> progress = {};  ///< called in the sink's thread after each ping
};

/// Runs the scenario's pings through a tbb::parallel_pipeline: simulated in parallel, handed to
/// `sink` in order, one at a time; memory is bounded by the pings in flight. \return the number of
/// pings handed over
int run_pings(const PingSimulator& simulator, const std::function<void(PingRecord&&)>& sink,
              const PingOptions& options = {});

}  // namespace asdic
