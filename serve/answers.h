#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/result/field_file.h"
#include "serve/latency.h"
#include "serve/listening.h"
#include "serve/pace.h"
#include "serve/session_limits.h"
#include "serve/session_state.h"
#include "sonar/ping/ping_record.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail::serve {

/// How a ping was served, beside its record.
struct ServedPing {
  std::string id = "null";    ///< JSON
  std::string file;           ///< that it was written to; empty: none
  bool with_samples = false;  ///< follow the line
  std::size_t replica = 0;    ///< numbers of the pulse, which follow them
  double prepare = 0.0;       ///< scenario read, simulator built [s]
  double latency = 0.0;       ///< from when it was to be sent to when its data were complete [s]
  double behind = 0.0;        ///< it was sent so long after its time [s]
  std::vector<std::string> warnings = {};  ///< about this ping
  bool scheduled = false;                  ///< sent by the schedule, so that it answers no command
};

/// A block of what is heard, and its samples, which go to its sink if it has one.
/// \param behind  after its end, by the clock [s]
[[nodiscard]] Answer block_answer(Listening::Block&& block, double behind);

// One line of JSON each, without its end.
/// \param time  of the first sample [s]   \param block  samples of a block
[[nodiscard]] std::string listen_line(const std::string& id, const Scenario& scenario, double time,
                                      std::int64_t block);
/// \param time  of the first sample that is not heard any more [s]
[[nodiscard]] std::string listening_ended_line(double time);
[[nodiscard]] std::string greeting_line(const Scenario& scenario, const Pace& pace,
                                        const std::string& version);
[[nodiscard]] std::string ping_line(const ServedPing& served, const PingRecord& record,
                                    const Scenario& scenario);
/// \param behind  by the clock: the time that it says was over for so long [s]; none: it is not
/// told
[[nodiscard]] std::string update_line(const std::string& id, const Scenario& scenario, double now,
                                      double seconds, const std::optional<double>& behind,
                                      const std::vector<std::string>& warnings,
                                      bool sea_drawn_anew = false);
/// \param now  time of the scenario [s]   \param next  number of the next ping
[[nodiscard]] std::string state_line(const std::string& id, const Scenario& scenario, double now,
                                     int next, const LatencyLog& latency);
/// What a command of asdic's tells as JSON. \param time  of the scenario [s]
[[nodiscard]] std::string result_line(const std::string& id, double time, const std::string& json,
                                      const std::vector<std::string>& warnings);
/// The same of a field, whose pressure follows.
[[nodiscard]] std::string field_line(const std::string& id, double time, const std::string& json,
                                     const FieldData& field);
/// Its levels follow.
[[nodiscard]] std::string levels_line(const ServedPing& served, const PingRecord& record,
                                      const Scenario& scenario);
/// Of a scenario that was saved. \param ping  of it that is the next one, at \p time
[[nodiscard]] std::string save_line(const std::string& id, int ping, double time,
                                    const std::string& file, const std::string& toml);
[[nodiscard]] std::string limits_line(const std::string& id, const SessionLimits& limits);
/// \param number  of commands that were called off
[[nodiscard]] std::string cancel_line(const std::string& id, std::size_t number);
[[nodiscard]] std::string quit_line(const std::string& id, int pings, const LatencyLog& latency);
[[nodiscard]] std::string refusal_line(const std::string& id, const std::string& code,
                                       const std::string& message);

}  // namespace asdic::detail::serve
