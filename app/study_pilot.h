#pragma once
#include <string>

#include "app/study_options.h"
#include "study/pilot/pilot.h"

namespace asdic::detail::app {

/// What a pilot has found, for people. \param threads  that the whole study is to have
[[nodiscard]] std::string pilot_text(const study::Pilot& pilot, int threads);

/// asdic study --pilot: makes a few rows and says what all will cost. Writes nothing.
/// \return the exit status
int try_study(const StudyOptions& options);

}  // namespace asdic::detail::app
