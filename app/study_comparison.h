#pragma once
#include <functional>

#include "app/study_options.h"

namespace asdic::detail::app {

/// Makes one study. \return the exit status
using RunStudy = std::function<int(const StudyOptions&)>;

/// `asdic study --compare`: makes each study, unless it is complete, compares their rows, writes
/// the file, and says what came of it. \return the exit status
int compare_studies(const StudyOptions& options, const RunStudy& run);

/// Whether a file is of `asdic study --compare`.
[[nodiscard]] bool is_comparison_file(const std::string& path);
/// \throws InputError where its data are not what was written
void check_comparison(const std::string& path);
/// Prints what it says. \return the exit status
int comparison_info(const std::string& path);

}  // namespace asdic::detail::app
