#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

namespace asdic::detail {

/// A file that is read: the one door by which every reader of ours comes in.
///
/// It must be a regular file (or a link to one). Pipes, sockets and devices are refused before they
/// are opened: they may be waited for in vain, or never end.
class InputFile {
 public:
  /// \param expected  for messages: "a scenario file"
  /// \throws InputError that says what is there instead: "no such file", "a folder", …
  InputFile(const std::filesystem::path& path, const std::string& expected);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }
  /// [bytes] when it was opened
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// All that is left of it, `most` bytes at most. \throws InputError if reading fails
  [[nodiscard]] std::string read(std::size_t most = std::string::npos);

 private:
  std::filesystem::path path_;
  std::string expected_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

/// What a reader finds under a name, for messages: "no such file", "a folder", "a file".
[[nodiscard]] std::string what_is_at(const std::filesystem::path& path);

/// Checks a file that a library is going to open by its name, and notes it as read (FilesRead).
/// \throws InputError as InputFile
void require_file(const std::filesystem::path& path, const std::string& expected);

/// A whole file. \throws InputError as InputFile
[[nodiscard]] std::string read_input(const std::filesystem::path& path,
                                     const std::string& expected);

}  // namespace asdic::detail
