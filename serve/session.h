#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/ping_file.h"
#include "serve/command.h"
#include "serve/latency.h"
#include "serve/live_scenario.h"
#include "serve/pace.h"
#include "serve/ping_request.h"
#include "serve/session_limits.h"
#include "serve/turns.h"
#include "sonar/paths/shared_propagation.h"
#include "sonar/ping/ping.h"

namespace asdic::serve {

/// What all sessions of a server have in common.
struct SessionSettings {
  ScenarioSource scenario;
  DataFolder data;
  std::filesystem::path output;  ///< folder for files of pings; empty: none are written
  SessionLimits limits;
  Pace pace;
  Provenance provenance;
  /// Told what is not for clients: why a file could not be written.
  std::function<void(const std::string&)> report = [](const std::string&) {};
};

/// One line of JSON, without its end, and what follows it.
struct Answer {
  std::string line;
  std::vector<float> samples;  ///< little-endian float32 after the line; none: nothing follows
  bool last = false;           ///< the connection is closed after it
};

/// What one client does with a scenario: pings it, changes it, asks about it. Knows nothing of
/// sockets: takes lines, gives answers (docs/formats/serve.md).
class Session {
 public:
  /// \param clock  seconds of a clock that never goes back
  /// \throws InputError if the scenario is wrong
  Session(const SessionSettings& settings, std::function<double()> clock);

  /// The answer to the handshake.
  [[nodiscard]] Answer greeting() const;
  /// A line's answer. Never throws for what a client says.
  [[nodiscard]] Answer answer(std::string_view line);

  /// How long until a command is to be carried out [s]: a ping at a later time by the clock.
  [[nodiscard]] double wait(const Command& command) const;
  [[nodiscard]] Answer execute(const Command& command);

  [[nodiscard]] const LatencyLog& latency() const noexcept { return latency_; }

 private:
  struct Simulator {
    std::string key;
    std::unique_ptr<PingSimulator> simulator;
  };

  [[nodiscard]] Answer carry_out(const Command& command);
  [[nodiscard]] Answer ping(const Command& command);
  [[nodiscard]] Answer update(const Command& command);
  [[nodiscard]] Answer state(const Command& command) const;

  [[nodiscard]] double now() const;  ///< of the scenario [s]
  [[nodiscard]] Delivery usual_delivery() const;
  [[nodiscard]] Transmission transmission_of(const PingRequest& request) const;
  const PingSimulator& simulator_of(LiveScenario::State state);
  [[nodiscard]] std::filesystem::path next_file();

  const SessionSettings& settings_;
  std::function<double()> clock_;
  double start_;
  LiveScenario live_;
  Turns turns_;
  int pings_ = 0;                                   // done
  bool judged_ = false;                             // what bounces leave out: at the first ping
  MemoryBudget budget_;                             // of a ping
  std::shared_ptr<SharedPropagation> propagation_;  // what was traced
  std::list<Simulator> simulators_;                 // the latest used first
  std::filesystem::path folder_;                    // of this session's files
  LatencyLog latency_;
};

/// A refusal as an answer. \param id  JSON
[[nodiscard]] Answer refusal_answer(const std::string& id, const std::string& code,
                                    const std::string& message, bool last = false);

}  // namespace asdic::serve
