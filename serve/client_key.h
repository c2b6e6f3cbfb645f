#pragma once
#include <string>

#include "io/text/toml_value.h"

namespace asdic::detail::serve {

/// A key of the scenario as a client knows it.
struct ClientKey {
  std::string name;    ///< "targets[1].strength_db", "waveform.frequency"; of what no command
                       ///< changes, the scenario's own: "pings.sample_rate"
  bool given = false;  ///< the command says something there
  bool under = false;  ///< or at least about the table in which it stands
};

/// Where a command has what stands at a key of the scenario.
/// \param key       "target[1].strength_db"   \param fields  of the command
/// \param document  the scenario as the command would have it: its targets have names
[[nodiscard]] ClientKey client_key(const std::string& key, const TomlValue& fields,
                                   const TomlValue& document);

}  // namespace asdic::detail::serve
