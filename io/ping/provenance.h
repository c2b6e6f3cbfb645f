#pragma once
#include <string>

#include "io/ping/ping_file.h"

namespace asdic::detail {

/// Who makes a file here and now. \param threads  that compute
[[nodiscard]] Provenance provenance(int threads);

/// "0.1.0"
[[nodiscard]] std::string program_version();

/// "0.1.0 (GNU 12.2.0, Release, …)": version and build.
[[nodiscard]] std::string program_and_build();

/// "asdic 0.1.0", its build and its libraries, for --version.
[[nodiscard]] std::string version_text();

}  // namespace asdic::detail
