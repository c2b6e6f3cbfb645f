#pragma once
#include <filesystem>
#include <string>

#include "study/placement/placement_file.h"

namespace asdic::detail::app {

/// A placement, for people.
[[nodiscard]] std::string placement_text(const study::PlacementAnswer& answer);
/// The same for programs (docs/formats/placement.md).
[[nodiscard]] std::string placement_json(const study::PlacementAnswer& answer,
                                         const std::filesystem::path& plan,
                                         const std::filesystem::path& output);

/// Whether it is a file of `asdic place`.
[[nodiscard]] bool is_placement_file(const std::string& path);
/// Says what it holds. \return the exit status
int placement_info(const std::string& path);

}  // namespace asdic::detail::app
