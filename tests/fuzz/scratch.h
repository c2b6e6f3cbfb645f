#pragma once
#include <stdlib.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace asdic::detail::fuzz {

/// A folder in memory for readers that want files, gone with the program.
class Scratch {
 public:
  /// \param companions  a folder whose files lie in this one, too
  explicit Scratch(const std::filesystem::path& companions = {}) {
    const char* const memory = "/dev/shm";
    std::string name =
        (std::filesystem::is_directory(memory) ? std::filesystem::path(memory)
                                               : std::filesystem::temp_directory_path()) /
        "asdic-fuzz-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder " + name);
    folder_ = name;
    if (!companions.empty()) std::filesystem::copy(companions, folder_);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return folder_ / name;
  }
  /// A file of these bytes, in place of one of that name. \return its path
  std::filesystem::path write(const std::string& name, const void* data, std::size_t size) const {
    const std::filesystem::path path = folder_ / name;
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr || std::fwrite(data, 1, size, file) != size || std::fclose(file) != 0)
      throw std::runtime_error("cannot write " + path.string());
    return path;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace asdic::detail::fuzz
