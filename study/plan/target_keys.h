#pragma once
#include <string>
#include <vector>

#include "study/plan/study.h"

namespace asdic::detail::study {

/// Makes room in a scenario for keys that vary: a target whose range, bearing or depth does is put
/// by range, bearing and depth from the platform where it was put by its position; one whose
/// position, waypoints or track does loses what else said where it is.
/// \throws InputError if the scenario as it stands is at fault
void make_room(const std::vector<Variable>& variables, const std::filesystem::path& path,
               TomlValue& scenario);

}  // namespace asdic::detail::study
