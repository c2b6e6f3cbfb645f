#pragma once
#include <filesystem>
#include <string>

#include "io/files/output_file.h"

namespace asdic::detail::support {

/// What the writing of a result has left beside it: parts and a lock, "" if there are none.
inline std::string left_of(const std::filesystem::path& target) {
  std::string names;
  for (const auto& part : parts_of(target)) names += part.filename().string() + ' ';
  const std::filesystem::path lock = target.string() + ".lock";
  if (std::filesystem::exists(lock)) names += lock.filename().string();
  return names;
}

}  // namespace asdic::detail::support
