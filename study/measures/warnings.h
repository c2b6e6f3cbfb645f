#pragma once
#include <limits>
#include <string>
#include <vector>

#include "study/plan/study.h"

namespace asdic::detail::study {

/// What a user should know of a study before he trusts its numbers.
struct Judgement {
  /// In one line each: warnings of the study file itself, and of the scenarios of its first
  /// realisations (32 at most, by their index), each key once, with the realisation where it came
  /// up first.
  std::vector<std::string> warnings;
  /// What bounces that are not followed leave out of the levels of the first realisation that can
  /// be made, estimated [dB]; not a number where that is not known.
  double left_out_db = std::numeric_limits<double>::quiet_NaN();
};

/// A function of the study alone: all parts of it say the same.
[[nodiscard]] Judgement judge(const Study& study);

}  // namespace asdic::detail::study
