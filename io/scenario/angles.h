#pragma once
#include <optional>
#include <string>
#include <vector>

#include "io/text/toml_table.h"

namespace asdic::detail::scenario {

// Angles of a scenario are degrees, "lowest_deg"; "lowest_rad" is taken as well, since not every
// angle of a program has a decimal number of degrees that reads back as the same bits.

/// \return [rad]. \throws InputError if both keys stand there, or neither and there is no fallback
[[nodiscard]] double read_angle(TomlTable& table, const std::string& name,
                                const AngleQuantity& quantity,
                                std::optional<double> fallback_rad = std::nullopt);
/// \return [n ≥ 1] [rad]
[[nodiscard]] std::vector<double> read_angles(TomlTable& table, const std::string& name,
                                              const AngleQuantity& quantity);
/// Whether the table gives the angle in either unit.
[[nodiscard]] bool has_angle(TomlTable& table, const std::string& name);

/// Which of the two keys is there; "…_deg" where neither is.
[[nodiscard]] std::string angle_key(TomlTable& table, const std::string& name);

}  // namespace asdic::detail::scenario
