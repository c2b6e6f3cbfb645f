#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/quantity.h"
#include "io/text/toml_value.h"
#include "serve/data_folder.h"
#include "serve/live_scenario.h"
#include "serve/session_limits.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail::serve {

/// What an update is applied to.
struct UpdateContext {
  const Scenario& scenario;
  const DataFolder& data;
  const SessionLimits& limits;
  double now = 0.0;  ///< of positions, where the command says no time [s]
  /// From when on tracks keep where things were [s]; none: they keep nothing.
  std::optional<double> since = {};
};

/// Writes what a client wants into the tree of a scenario's file. What may change is what its
/// description calls `live` (serve/client_names.h), and nothing else.
/// \return the sections that changed, such as "platform" or "environment.wind_speed"; none if
/// everything is already as the client asks
/// \throws Refusal ("value", "file") naming the command's key
std::vector<std::string> apply_update(const TomlValue& fields, const UpdateContext& context,
                                      TomlValue& document);

/// The same of what a ping has of its own.
std::vector<std::string> apply_ping_changes(const PingChanges& wanted, TomlValue& document);

/// A fault of a command's own value: key, found, expected.
[[nodiscard]] Refusal refusal_of_value(const InputError& error);

}  // namespace asdic::detail::serve
