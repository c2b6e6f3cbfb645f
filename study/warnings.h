#pragma once
#include <string>
#include <vector>

#include "study/study.h"

namespace asdic::study {

/// What a user should know of a study before he trusts its numbers, in one line each: warnings of
/// the study file itself, and of the scenarios of its first realisations (32 at most, by their
/// index), each key once, with the realisation where it came up first. A function of the study
/// alone: all parts of it say the same.
[[nodiscard]] std::vector<std::string> warnings(const Study& study);

}  // namespace asdic::study
