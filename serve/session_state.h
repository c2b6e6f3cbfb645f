#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/ping/ping_file.h"
#include "serve/command_log.h"
#include "serve/latency.h"
#include "serve/listening.h"
#include "serve/live_scenario.h"
#include "serve/output_quota.h"
#include "serve/pace.h"
#include "serve/ping_schedule.h"
#include "serve/session_limits.h"
#include "sonar/paths/shared_propagation.h"
#include "sonar/ping/ping.h"

namespace asdic::detail::serve {

class BlockOutlet;

/// What all sessions of a server have in common.
struct SessionSettings {
  ScenarioSource scenario;
  DataFolder data;
  std::filesystem::path output;  ///< folder for files of pings; empty: none are written
  SessionLimits limits;
  Pace pace;
  Provenance provenance;
  bool tells_scenario = false;      ///< to clients, as text (the command `save`)
  std::shared_ptr<CommandLog> log;  ///< of what is carried out; none: nothing is written
  std::shared_ptr<OutputQuota> written = std::make_shared<OutputQuota>();  ///< of files
  std::shared_ptr<BlockOutlet> udp = {}, ring = {};  ///< `deliver` of `listen`; none: not wanted
  /// Told what is not for clients: why a file could not be written.
  std::function<void(const std::string&)> report = [](const std::string&) {};
};

/// One line of JSON, without its end, and what follows it.
struct Answer {
  std::string line;
  std::vector<float> samples = {};  ///< little-endian float32 after the line; none: nothing follows
  bool last = false;                ///< the connection is closed after it
  bool refused = false;
  /// What is done once it is delivered, as the rest of its command.
  std::function<void()> then = {};
};

/// For an answer there is no room yet: other answers have not been taken.
struct NoRoom {
  std::size_t bytes = 0;
};

/// What a session is in the middle of: what its commands look at, and change.
class SessionState {
 public:
  /// \param settings  outlive it   \param clock  seconds of a clock that never goes back
  /// \throws InputError if the scenario is wrong
  SessionState(const SessionSettings& settings, std::function<double()> clock);

  const SessionSettings& settings;
  std::function<double()> clock;
  double start;  ///< of the session, on the clock
  int number;    ///< of the session in the log
  LiveScenario live;
  PingSchedule schedule;
  int pings = 0;                   ///< done
  double latest_ping = -infinity;  ///< time of the latest in the scenario [s]
  /// Time of the scenario at which the command in hand acts: by the clock, or as a log says; none:
  /// the schedule has it [s].
  std::optional<double> acts;
  /// How far the session was heard when the command in hand began, or the latest scheduled ping;
  /// none: nobody has listened.
  std::optional<Listening::Heard> heard;
  /// A log is carried out again: what is heard goes as far as that says, and answers bring it.
  bool replayed = false;
  LatencyLog latency;
  /// From the first `listen` on.
  std::unique_ptr<Listening> listening;
  /// Hands out what answers no command. \throws Interrupted if the command is called off
  std::function<void(Answer)> tell = [](const Answer&) {};

  /// Called before what follows an answer's line is made: there is room for so many bytes.
  /// \throws NoRoom to be asked again later; a Refusal
  std::function<void(std::size_t bytes)> make_room = [](std::size_t) {};

  [[nodiscard]] double now() const;  ///< of the scenario; the same for all of a command [s]
  [[nodiscard]] double at(double clock) const;       ///< the scenario's time at a time of the clock
  [[nodiscard]] double clock_at(double time) const;  ///< and back; by the clock alone
  /// It is not heard any more, before it was over: the log has where.
  void end_listening();
  /// A simulator of a scenario, or the one that was made of it not long ago.
  std::shared_ptr<const PingSimulator> simulator_of(LiveScenario::State state);
  [[nodiscard]] const MemoryBudget& budget() const noexcept { return budget_; }
  /// For the next ping: sessions write into folders of their own, which nobody had before, so
  /// nothing is overwritten.
  [[nodiscard]] std::filesystem::path next_file();
  /// The same for a scenario that is saved.
  [[nodiscard]] std::filesystem::path next_save();

 private:
  const std::filesystem::path& folder();

  struct Simulator {
    std::string key;
    std::shared_ptr<const PingSimulator> simulator;
  };

  bool judged_ = false;                             // what bounces leave out: at the first ping
  MemoryBudget budget_;                             // of a ping
  std::shared_ptr<SharedPropagation> propagation_;  // what was traced
  std::list<Simulator> simulators_;                 // the latest used first
  std::filesystem::path folder_;                    // of this session's files
  int saves_ = 0;
};

}  // namespace asdic::detail::serve
