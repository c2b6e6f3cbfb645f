#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

namespace asdic::detail::serve {

/// The folder that commands may name files of (--data-dir), and nothing outside of it.
class DataFolder {
 public:
  DataFolder() = default;  ///< none: every name is refused
  /// \throws InputError{where: "--data-dir"} if it is no directory
  explicit DataFolder(const std::filesystem::path& folder);

  /// A file by its name relative to the folder, symbolic links followed; what they lead to has to
  /// lie inside as well.
  /// \param where  key of the command, for messages   \param most_bytes  that the file may have
  /// \throws Refusal ("file") that names the key and nothing of the file system
  [[nodiscard]] std::filesystem::path file(const std::string& name, const std::string& where,
                                           std::size_t most_bytes) const;

 private:
  std::filesystem::path folder_;  // canonical; empty: none
};

}  // namespace asdic::detail::serve
