#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "study/plan/study.h"

namespace asdic::detail::study {

/// Reads a study file (docs/formats/study.md) and checks all of it, the scenario included.
/// \throws InputError "FILE:LINE: key.path: found X, expected Y" at the first fault
[[nodiscard]] Study read_study(const std::filesystem::path& path,
                               std::span<const std::string> overrides = {});

}  // namespace asdic::detail::study
