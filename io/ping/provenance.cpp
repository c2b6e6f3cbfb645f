#include "io/ping/provenance.h"

#include <tbb/version.h>
#include <unistd.h>

#include <Eigen/Core>
#include <array>
#include <ctime>
#include <fstream>

#include "core/instruction_level.h"

// ASDIC_VERSION, ASDIC_BUILD and ASDIC_LIBRARIES come from cmake/AsdicProgramInfo.cmake.

namespace asdic::detail {
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
std::string build_text() {
  return std::string(ASDIC_BUILD) + ", " + std::string(instruction_level_name());
}

/// "2026-11-23T17:05:00Z"
std::string now_text() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

std::string library_versions() {
  return std::string(ASDIC_LIBRARIES) + ", oneTBB " + TBB_runtime_version() + ", Eigen " +
         std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
         std::to_string(EIGEN_MINOR_VERSION);
}

}  // namespace

Provenance provenance(int threads) {
  return {.program_version = ASDIC_VERSION,
          .build = build_text(),
          .host = host_name(),
          .started = now_text(),
          .cpu = cpu_model(),
          .library_versions = library_versions(),
          .threads = threads};
}

std::string program_version() { return ASDIC_VERSION; }

std::string program_and_build() { return std::string(ASDIC_VERSION) + " (" + build_text() + ")"; }

std::string version_text() {
  return std::string("asdic ") + ASDIC_VERSION + "\nbuild: " + build_text() +
         "\nlibraries: " + library_versions();
}

}  // namespace asdic::detail
