#pragma once
#include <filesystem>
#include <string>

namespace asdic::detail::app {

/// A file or folder that comes with the program: of share/asdic (docs: share/doc/asdic) beside an
/// installed one, or of the sources that it was built from. "" if it is in neither.
/// \param name  "scenarios"
[[nodiscard]] std::filesystem::path shared_file(const std::filesystem::path& name);

/// Where it would be beside an installed program.
[[nodiscard]] std::filesystem::path installed_file(const std::filesystem::path& name);

/// How a page or a scenario is told to people: where it is, or its name in the sources.
/// \param name  "docs/guide/python.md", "scenarios/deep_ocean.toml"
[[nodiscard]] std::string told_place(const std::string& name);

}  // namespace asdic::detail::app
