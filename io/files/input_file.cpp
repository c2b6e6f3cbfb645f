#include "io/files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "core/error.h"
#include "io/files/files_read.h"

namespace asdic::detail {
namespace {

/// Why there is nothing to read, from errno.
std::string reason(int error) {
  if (error == ENOENT || error == ENOTDIR) return "no such file";
  if (error == EACCES || error == EPERM) return "a file that may not be read";
  return std::string("a file that cannot be opened (") + std::strerror(error) + ")";
}

/// What is there in place of a regular file.
std::string kind_of(mode_t mode) {
  if (S_ISREG(mode)) return "a file";
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe, which is no file";
  if (S_ISSOCK(mode)) return "a socket, which is no file";
  return "a device, which is no file";
}

InputError fault(const std::filesystem::path& path, const std::string& got,
                 const std::string& expected) {
  return InputError({.where = path.string(), .got = got, .expected = expected});
}

void check(int failed, const struct stat& status, const std::filesystem::path& path,
           const std::string& expected) {
  if (failed != 0) throw fault(path, reason(errno), expected);
  if (!S_ISREG(status.st_mode)) throw fault(path, kind_of(status.st_mode), expected);
}

}  // namespace

std::string what_is_at(const std::filesystem::path& path) {
  struct stat status {};
  return stat(path.c_str(), &status) != 0 ? reason(errno) : kind_of(status.st_mode);
}

void require_file(const std::filesystem::path& path, const std::string& expected) {
  note_read(path);
  struct stat status {};
  check(stat(path.c_str(), &status), status, path, expected);
}

InputFile::InputFile(const std::filesystem::path& path, const std::string& expected)
    : path_(path), expected_(expected) {
  require_file(path, expected);  // opening a device may already do something
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (descriptor_ < 0) throw fault(path, reason(errno), expected);
  struct stat status {};
  try {
    check(fstat(descriptor_, &status), status, path, expected);
  } catch (const InputError&) {
    close(descriptor_);
    throw;
  }
  size_ = static_cast<std::size_t>(status.st_size);
}

InputFile::~InputFile() { close(descriptor_); }

std::string InputFile::read(std::size_t most) {
  std::string bytes;
  constexpr std::size_t piece = 4096;  // of what has grown since it was opened: rarely anything
  bytes.reserve(std::min(most, size_ + piece));
  while (bytes.size() < most) {
    const std::size_t have = bytes.size();
    const std::size_t next = std::min(most - have, have < size_ ? size_ - have + 1 : piece);
    bytes.resize(have + next);
    ssize_t got = 0;
    do got = ::read(descriptor_, bytes.data() + have, next);
    while (got < 0 && errno == EINTR);
    if (got < 0)
      throw fault(path_, std::string("a file that cannot be read (") + std::strerror(errno) + ")",
                  expected_);
    bytes.resize(have + static_cast<std::size_t>(got));
    if (got == 0) break;
  }
  return bytes;
}

std::string read_input(const std::filesystem::path& path, const std::string& expected) {
  return InputFile(path, expected).read();
}

}  // namespace asdic::detail
