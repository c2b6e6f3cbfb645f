#include "sonar/ping/run_pings.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "raytrace/parallel/stop.h"
#include "raytrace/propagation.h"
#include "sonar/ping/live_stream.h"
#include "sonar/ping/stopwatch.h"

namespace asdic::detail {
namespace {

/// Two pings in flight a thread keep the writer fed; more would only cost memory, and no more than
/// there is memory for.
std::size_t pings_in_flight(const PingSimulator& simulator) {
  const int wanted = std::min(std::max(2, tbb::this_task_arena::max_concurrency()),
                              std::max(1, simulator.pings()));
  if (wanted == 1) return 1;
  const MemoryBudget one = simulator.memory();
  const double fit = one.taken() > 0.0 ? one.bytes() / one.taken() : 1.0 * wanted;
  return static_cast<std::size_t>(std::clamp(fit, 1.0, 1.0 * wanted));
}

/// Null if it is called off meanwhile.
std::shared_ptr<PingRecord> make_ping(const PingSimulator& simulator, int ping,
                                      const std::stop_token& stop) {
  std::shared_ptr<PingRecord> record;
  try {
    until_stopped(stop, [&] {
      record = std::make_shared<PingRecord>(
          simulator.scenario().pings.continuous ? simulator.sound(ping) : simulator.simulate(ping));
    });
  } catch (const Interrupted&) {
    record.reset();
  }
  return record;
}

/// Puts the stream from this ping to the next one in place of the ping's own sound; of the last one
/// it is as long as that is received.
void next_part(const PingSimulator& simulator, PingRecord& record,
               std::optional<LiveStream>& stream) {
  Stopwatch watch;
  const Transmission& sent = simulator.transmission(record.ping);
  if (!stream) {
    const std::shared_ptr<const PingSimulator> lent(std::shared_ptr<void>(), &simulator);
    stream.emplace(lent, std::llround(sent.time * record.recording.sample_rate));
  }
  stream->add(record, sent, simulator.pulse(sent.transmitter).duration());
  const std::size_t samples =
      record.ping < simulator.pings()
          ? static_cast<std::size_t>(
                stream->nearest_sample(simulator.transmission(record.ping + 1).time) -
                stream->position())
          : record.recording.samples;
  record.interference =
      simulator.ships({.ping = record.ping, .first = stream->position(), .samples = samples});
  record.pressure = stream->take(samples);
  record.recording.samples = samples;
  record.timings.noise += watch.lap();
}

}  // namespace

int run_pings(const PingSimulator& simulator, const std::function<void(PingRecord&&)>& sink,
              const PingOptions& options) {
  const int count = simulator.pings();
  const bool continuous = simulator.scenario().pings.continuous;
  std::optional<LiveStream> stream;
  int next = 1, done = 0;
  bool over = false;
  const std::size_t in_flight = pings_in_flight(simulator);
  tbb::parallel_pipeline(
      in_flight,
      tbb::make_filter<void, int>(tbb::filter_mode::serial_in_order,
                                  [&](tbb::flow_control& flow) {
                                    if (next > count || options.stop.stop_requested()) {
                                      flow.stop();
                                      return 0;
                                    }
                                    return next++;
                                  }) &
          tbb::make_filter<int, std::shared_ptr<PingRecord>>(
              tbb::filter_mode::parallel,
              [&](int ping) { return make_ping(simulator, ping, options.stop); }) &
          tbb::make_filter<std::shared_ptr<PingRecord>, void>(
              tbb::filter_mode::serial_in_order, [&](const std::shared_ptr<PingRecord>& record) {
                over = over || !record;  // what follows one that is missing is none of ours
                if (over) return;
                if (continuous) next_part(simulator, *record, stream);
                sink(std::move(*record));
                ++done;
                if (options.progress) options.progress(done);
              }));
  return done;
}

}  // namespace asdic::detail
