#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "core/fields.h"
#include "core/settings_catalogue.h"
#include "serve/live_scenario.h"

namespace asdic::detail::serve {

/// Where a ping's samples go.
enum class Delivery { file, samples, none };
inline constexpr std::string_view delivery_words[] = {"file", "samples", "none"};
constexpr std::span<const std::string_view> words(Delivery /*any*/) { return delivery_words; }

/// The command `ping`.
struct PingRequest {
  std::optional<int> transmitter;   ///< an index; none: whose turn it is
  std::optional<double> time;       ///< [s]; none: by the session's clock or schedule
  std::optional<double> elevation;  ///< of the beam, positive up [rad]
  PingChanges changes;              ///< its transmitter is set when that is known
  Delivery deliver = Delivery::none;
  bool replica = false;  ///< follows the samples

  /// But for `transmitter` and what the client's scenario says itself.
  void describe(Fields& field);
};

/// The keys of the command, as the manual lists them.
[[nodiscard]] SettingsList ping_settings();

/// \param usual  delivery where the command does not say \throws Refusal ("value", "file")
[[nodiscard]] PingRequest read_ping(const TomlValue& fields, const LiveScenario& live,
                                    const SessionLimits& limits, Delivery usual);

}  // namespace asdic::detail::serve
