#include "app/provenance.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <tbb/version.h>
#include <unistd.h>

#include <Eigen/Core>
#include <array>
#include <chrono>
#include <fstream>

#include "core/instruction_level.h"

// ASDIC_VERSION, ASDIC_BUILD and ASDIC_LIBRARIES come from cmake/AsdicProgramInfo.cmake.

namespace asdic::app {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name"))
      if (const auto colon = line.find(": "); colon != std::string::npos)
        return line.substr(colon + 2);
  return "unknown";
}

/// How it was built, and the instruction level that runs.
std::string build_text() { return fmt::format("{}, {}", ASDIC_BUILD, instruction_level_name()); }

std::string library_versions() {
  return fmt::format("{}, oneTBB {}, Eigen {}.{}.{}", ASDIC_LIBRARIES, TBB_runtime_version(),
                     EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION);
}

}  // namespace

Provenance provenance(int threads) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {.program_version = ASDIC_VERSION,
          .build = build_text(),
          .host = host_name(),
          .started = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now)),
          .cpu = cpu_model(),
          .library_versions = library_versions(),
          .threads = threads};
}

std::string program_and_build() { return fmt::format("{} ({})", ASDIC_VERSION, build_text()); }

std::string version_text() {
  return fmt::format("asdic {}\nbuild: {}\nlibraries: {}", ASDIC_VERSION, build_text(),
                     library_versions());
}

}  // namespace asdic::app
