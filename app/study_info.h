#pragma once
#include <string>

namespace asdic::detail::app {

/// Whether a file is of `asdic study` or `asdic merge`.
[[nodiscard]] bool is_study_file(const std::string& path);

/// What it holds, on standard output. \return the exit status
int study_info(const std::string& path);

}  // namespace asdic::detail::app
