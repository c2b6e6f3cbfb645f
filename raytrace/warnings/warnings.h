#pragma once
#include <string>
#include <vector>

#include "raytrace/cases/propagation_case.h"

/// What a user should know of an ocean or a run before he trusts a number, in one line each: "KEY:
/// what is the matter". Every check is a function of this file (and of sonar/warnings, for what
/// only a sonar has); readers of files ask all of them, and commands print them and write them
/// beside the numbers (docs/guide/scenarios.md).
namespace asdic::detail {

/// Of the ocean at frequencies from `lowest` to `highest` [Hz].
[[nodiscard]] std::vector<std::string> warnings(const Environment& ocean, double lowest,
                                                double highest);
/// Of a run, its ocean included.
[[nodiscard]] std::vector<std::string> warnings(const PropagationCase& run_case);

/// The same, each added to a list that has not got it yet.
void add_warnings(const std::vector<std::string>& more, std::vector<std::string>& all);

namespace checks {

/// Levels of a profile that leave out more than 1 % of the water at its top or its bottom; "" where
/// they do not. \param first, last  level [m]   \param beyond  how the speed goes on there
[[nodiscard]] std::string profile_reach(double first, double last, const Environment& ocean,
                                        const std::string& beyond);
[[nodiscard]] std::string profile_reach(const Environment& ocean);
/// Absorption asked about frequencies or water that its law was not measured in.
[[nodiscard]] std::string absorption_range(const Environment& ocean, double lowest, double highest);
/// The loss in bubbles asked about frequencies that it was not measured at.
[[nodiscard]] std::string bubble_range(const Environment& ocean, double lowest, double highest);
/// A solid behind the surface or the bottom that reflects more than comes in. Scenarios refuse it;
/// BELLHOP's files, and materials node by node, run as they stand.
[[nodiscard]] std::string gaining_boundary(const Environment& ocean);
/// Cerveny beams of no width, which carry no sound.
[[nodiscard]] std::string silent_beams(const PropagationCase& run_case);

}  // namespace checks
}  // namespace asdic::detail
