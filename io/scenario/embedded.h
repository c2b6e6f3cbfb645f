#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/text/toml_value.h"
#include "sonar/scenario/scenario.h"

// Scenarios that came inside of a file of results: somebody else may have written them.
namespace asdic::detail::scenario {

/// Every file that a tree names must lie in a folder or below it, links followed: what stands in
/// other files is nobody's business, and messages quote what they find.
/// \param tree  of a scenario, before `include` is merged, or of a part of it
/// \param remedy  what the user may do who trusts it: "--scenario says where it lay"
/// \throws InputError naming the key
void check_names(const TomlValue& tree, const std::filesystem::path& folder,
                 const std::string& remedy);

/// The same for `--set` overrides that came along: "environment.bottom.file=depths.csv".
void check_names(std::span<const std::string> overrides, const std::filesystem::path& folder,
                 const std::string& remedy);

}  // namespace asdic::detail::scenario

namespace asdic::detail {

/// parse_scenario() for text that came inside of a file of results, with its overrides: files that
/// it names must lie in the folder of `path`, or below.
[[nodiscard]] Scenario parse_embedded_scenario(std::string_view text,
                                               const std::filesystem::path& path,
                                               std::span<const std::string> overrides);

}  // namespace asdic::detail
