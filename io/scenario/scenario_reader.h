#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/text/noted_settings.h"
#include "io/text/toml_value.h"
#include "sonar/scenario/scenario.h"

namespace asdic::detail {

/// Reads a scenario file (docs/formats/scenario.md), checks all of it, and applies `--set`
/// overrides "key.path=value".
/// \throws InputError "FILE:LINE: key.path: found X, expected Y" at the first fault
[[nodiscard]] Scenario read_scenario(const std::filesystem::path& path,
                                     std::span<const std::string> overrides = {});

/// The same for text in memory. \param path  named in messages; files that the text names are
/// relative to its folder
[[nodiscard]] Scenario parse_scenario(std::string_view text, const std::filesystem::path& path,
                                      std::span<const std::string> overrides = {});

/// The same of a tree that was read before, with its includes and overrides in it
/// (scenario::read_document): what a study does for every realisation.
/// \param noted  if not null, grows by every setting that was read
[[nodiscard]] Scenario scenario_of(const TomlValue& document, const std::filesystem::path& path,
                                   NotedSettings* noted = nullptr);

}  // namespace asdic::detail
