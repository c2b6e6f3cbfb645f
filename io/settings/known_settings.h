#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace asdic::detail {

/// What has been read or written of a file, and settings further on refer to.
struct KnownSettings {
  std::map<std::string, double, std::less<>> numbers = {};  ///< "environment.wind_speed"
  std::map<std::string, std::vector<std::string>, std::less<>> names = {};  ///< of "platform"
  std::filesystem::path folder = {};    ///< that files named by settings are relative to
  std::vector<std::string> notes = {};  ///< what the user should know
};

}  // namespace asdic::detail
