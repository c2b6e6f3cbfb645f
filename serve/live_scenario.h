#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "io/text/toml_value.h"
#include "serve/data_folder.h"
#include "serve/refusal.h"
#include "serve/session_limits.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail::serve {

/// A scenario file as it was when the server started.
struct ScenarioSource {
  std::string text;
  std::filesystem::path path;
  std::vector<std::string> overrides;  ///< "key.path=value"
};

/// What a ping may have of its own, for itself alone.
struct PingChanges {
  int transmitter = 0;                                         ///< index
  std::vector<std::pair<std::string, TomlValue>> values = {};  ///< by names of the command's
};

/// A scenario that a client changes while it goes on.
///
/// A change replaces a whole section of the file ("platform", "target", "environment.sound_speed",
/// …) by an override "section=TOML", and all is read and checked again as `asdic ping --set` would:
/// so the overrides that a file of pings holds say what it was made of. There are never more
/// overrides than sections.
class LiveScenario {
 public:
  /// \throws InputError as read_scenario(), or where the scenario exceeds the limits
  LiveScenario(ScenarioSource source, DataFolder data, const SessionLimits& limits);

  /// Sections with their values, in the order in which they were first changed.
  using Changes = std::vector<std::pair<std::string, std::string>>;

  /// A scenario, a text that is the same for the same one, and what it is made of.
  struct State {
    Scenario scenario;
    std::string key;
    Changes changes = {};
  };

  [[nodiscard]] const State& state() const noexcept { return state_; }
  [[nodiscard]] const DataFolder& data() const noexcept { return data_; }
  /// The tree of the file with all changes in it.
  [[nodiscard]] const TomlValue& document() const noexcept { return document_; }

  /// The command `update`: all of it, or nothing. \param fields  of the command
  /// \param now  time of the positions where the command gives none [s]
  /// \return false if everything is already as the command asks, so that nothing changes
  /// \throws Refusal
  bool update(const TomlValue& fields, double now);
  /// From now on tracks keep where things were, from a time on: what is received now was sent and
  /// struck before. Samples follow without gaps, and their rate stays. \throws Refusal
  void listen(double since);
  /// Where things were before that is forgotten [s].
  void forget_before(double time) noexcept;
  /// The scenario of other changes than the latest. \throws InputError, Refusal
  [[nodiscard]] State of(const Changes& changes) const { return read(changes); }
  /// At which the latest change is meant [s]; −∞: there was none.
  [[nodiscard]] double changed() const noexcept { return changed_; }

  /// What a client is told of a fault that comes to light when the scenario is used.
  /// \param fields  of the command
  [[nodiscard]] Refusal refusal(const InputError& error, const TomlValue& fields) const {
    return refusal(error, changes_, fields, document_);
  }

  /// The override that says a beam's elevation, where the scenario says it. \param elevation [rad]
  [[nodiscard]] std::string elevation_override(int transmitter, double elevation) const;

  /// The scenario with what one ping has of its own. \param fields  of the command \throws Refusal
  [[nodiscard]] State with(const PingChanges& changes, const TomlValue& fields) const;

 private:
  [[nodiscard]] State read(const Changes& changes) const;  // \throws InputError, Refusal
  [[nodiscard]] State read_for_client(const Changes& changes, const TomlValue& fields,
                                      const TomlValue& document) const;
  /// What a client is told of a fault, with these changes, of which `document` is made.
  [[nodiscard]] Refusal refusal(const InputError& error, const Changes& changes,
                                const TomlValue& fields, const TomlValue& document) const;

  ScenarioSource source_;
  DataFolder data_;
  SessionLimits limits_;
  TomlValue document_;
  Changes changes_;
  int pings_ = 1;                // of the file's schedule
  std::optional<double> since_;  // of which tracks keep where things were [s]
  double changed_ = -infinity;
  State state_;
};

/// A fault of a scenario in words for a client: the key as commands have it, and what is expected
/// there; what was found only where the client said it: else it is the scenario's or a file's. Of a
/// fault in a file not even what is expected, which may name its other values.
/// \param scenario  path of the scenario's own file   \param fields  of the command
/// \param document  the scenario with the command's changes
[[nodiscard]] Refusal refusal_of(const InputError& error, const std::string& scenario,
                                 const TomlValue& fields, const TomlValue& document);

}  // namespace asdic::detail::serve
