#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "core/fields.h"
#include "core/settings_catalogue.h"
#include "io/text/toml_value.h"

namespace asdic::detail::serve {

/// Where the samples of blocks go.
enum class BlockDelivery { samples, udp, ring };
inline constexpr std::string_view block_delivery_words[] = {"samples", "udp", "ring"};
constexpr std::span<const std::string_view> words(BlockDelivery /*any*/) {
  return block_delivery_words;
}

/// The command `listen`.
struct ListenRequest {
  double block = 0.02;            ///< of samples that are handed out together [s]
  std::optional<double> seconds;  ///< until it ends [s]; none: it does not
  bool schedule = false;          ///< pings of the schedule are sent by themselves
  bool stop = false;              ///< no more of it
  BlockDelivery deliver = BlockDelivery::samples;

  void describe(Fields& field);
};

/// The keys of the command, as the manual lists them.
[[nodiscard]] SettingsList listen_settings();

/// \throws Refusal ("value")
[[nodiscard]] ListenRequest read_listen(const TomlValue& fields);

}  // namespace asdic::detail::serve
