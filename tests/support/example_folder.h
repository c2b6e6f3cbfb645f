#pragma once
#include <filesystem>

#include "support/temporary_directory.h"

namespace asdic::detail::support {

/// A folder to work in, with copies of the scenarios, for as long as this lives.
class ExampleFolder {
 public:
  ExampleFolder() : before_(std::filesystem::current_path()) {
    std::filesystem::copy(ASDIC_SCENARIOS, folder_.path(),
                          std::filesystem::copy_options::recursive);
    std::filesystem::current_path(folder_.path());
  }
  ExampleFolder(const ExampleFolder&) = delete;
  ExampleFolder& operator=(const ExampleFolder&) = delete;
  ~ExampleFolder() { std::filesystem::current_path(before_); }

 private:
  TemporaryDirectory folder_;
  std::filesystem::path before_;
};

}  // namespace asdic::detail::support
