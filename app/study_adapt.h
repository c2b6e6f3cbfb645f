#pragma once
#include "app/study_options.h"

namespace asdic::detail::app {

/// --adapt: finds from where the event of [rare] is reached, and writes the study with it.
/// \return the exit status \throws InputError, RunError
int adapt_study(const StudyOptions& options);

}  // namespace asdic::detail::app
