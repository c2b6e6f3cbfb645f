#pragma once
#include <functional>
#include <stop_token>

#include "sonar/ping/ping.h"

namespace asdic::detail {

struct PingOptions {
  std::stop_token stop;  ///< when requested, pings in hand are called off, no new one is begun
  std::function<void(int done)> progress = {};  ///< called in the sink's thread after each ping
};

/// Runs the scenario's pings through a tbb::parallel_pipeline: simulated in parallel, handed to
/// `sink` in order, one at a time; memory is bounded by the pings in flight. \return the number of
/// pings handed over
int run_pings(const PingSimulator& simulator, const std::function<void(PingRecord&&)>& sink,
              const PingOptions& options = {});

}  // namespace asdic::detail
