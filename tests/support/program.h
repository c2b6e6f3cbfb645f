#pragma once
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "support/temporary_directory.h"

namespace asdic::detail::support {

/// What a program said and how it ended.
struct Outcome {
  int status = -1;  ///< exit status, 128 + n after signal n
  std::string out, err;
};

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  all << file.rdbuf();
  return all.str();
}

/// Runs `asdic WORDS` by the shell, in a folder.
/// \param before  shell words in front of the program: "ulimit -f 10;", "NO_COLOR=1"
inline Outcome asdic(const TemporaryDirectory& folder, const std::string& words,
                     const std::string& before = "") {
  const std::string command = "cd '" + folder.path().string() + "' && { " + before +
                              " '" ASDIC_PROGRAM "' " + words + "; } >stdout.txt 2>stderr.txt";
  const int status = std::system(command.c_str());
  return {.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          .out = content(folder / "stdout.txt"),
          .err = content(folder / "stderr.txt")};
}

/// A small sea: 1500 m/s, 1000 m deep, a target 3 km away and 300 m deeper, two phones, quickly
/// simulated.
inline constexpr const char* small_scenario = R"(title = "small sea"
seed = 3
[environment]
wind_speed = 8.0
[environment.sound_speed]
kind = "isovelocity"
speed = 1500.0
[environment.bottom]
depth = 1000.0
kind = "rigid"
[environment.absorption]
kind = "none"
[platform]
position = [0.0, 0.0, 200.0]
[transmitter]
source_level_db = 200.0
taper = "omnidirectional"
[pulse]
kind = "cw"
frequency = 1000.0
duration = 0.1
[array]
kind = "horizontal"
phones = 2
spacing = 0.75
[[target]]
name = "rock"
position = [3000.0, 0.0, 500.0]
strength_db = 10.0
[noise]
spectral_level_db = 40.0
[reverberation]
azimuths = 8
[propagation]
max_surface_bounces = 1
max_bottom_bounces = 1
[pings]
count = 2
interval = 10.0
recording_duration = 5.0
sample_rate = 4000.0
)";

}  // namespace asdic::detail::support
