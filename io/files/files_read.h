#pragma once
#include <filesystem>
#include <optional>

namespace asdic::detail {

/// Notes every file that io opens for reading during its lifetime, by device and inode, so that no
/// result is written over the scenario or a file that it names. The program has one for each
/// command; a library without one notes nothing. Only one may exist at a time. Files read by child
/// processes (io/isolated) are noted by this process through require_file().
class FilesRead {
 public:
  FilesRead();
  ~FilesRead();
  FilesRead(const FilesRead&) = delete;
  FilesRead& operator=(const FilesRead&) = delete;
};

/// A file is about to be read. From any thread.
void note_read(const std::filesystem::path& path);

/// A result that a command reads and writes anew by turns: it is no input.
void forget_read(const std::filesystem::path& path);

/// The name under which a file has been read, whatever it is called here (links of both kinds).
[[nodiscard]] std::optional<std::filesystem::path> read_before(const std::filesystem::path& path);

}  // namespace asdic::detail
