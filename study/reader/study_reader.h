#pragma once
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "study/plan/study.h"

namespace asdic::detail::study {

/// Reads a study file (docs/formats/study.md) and checks all of it, the scenario included.
/// \param measures  puts measures of a program's own into the plan, before formulae name them
/// \throws InputError "FILE:LINE: key.path: found X, expected Y" at the first fault
[[nodiscard]] Study read_study(const std::filesystem::path& path,
                               std::span<const std::string> overrides = {},
                               const std::function<void(Study&)>& measures = {});

}  // namespace asdic::detail::study
