#pragma once
#include <vector>

#include "io/ping/growing_table.h"

// The columns of a ping file's tables (docs/formats/ping.md).
namespace asdic::detail::ping_file {

[[nodiscard]] std::vector<GrowingTable::Column> echo_columns();
/// \param on_earth  whether latitudes and longitudes are known
[[nodiscard]] std::vector<GrowingTable::Column> patch_columns(bool on_earth);
[[nodiscard]] std::vector<GrowingTable::Column> interference_columns();

}  // namespace asdic::detail::ping_file
