#include "io/bellhop/file_bytes.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace asdic::bellhop {

std::string unreadable(int error) {
  if (error == ENOENT || error == ENOTDIR) return "no such file";
  if (error == EACCES) return "a file that nobody may read";
  return error != 0 ? std::string("a file that cannot be opened (") + std::strerror(error) + ")"
                    : "a file that cannot be opened";
}

std::string read_bytes(const std::filesystem::path& path, const std::string& expected) {
  errno = 0;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::error_code not_a_folder;
  const auto refuse = [&](const std::string& got) {
    throw InputError({.where = path.string(), .got = got, .expected = expected});
  };
  if (std::filesystem::is_directory(path, not_a_folder)) refuse("a folder");
  if (!file) refuse(unreadable(errno));
  std::string bytes(std::size_t(std::max<std::streamoff>(file.tellg(), 0)), '\0');
  file.seekg(0);
  file.read(bytes.data(), std::streamsize(bytes.size()));
  if (!file && !bytes.empty()) refuse("a file that cannot be read");
  return bytes;
}

void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  const std::filesystem::path part = path.string() + ".part";
  errno = 0;
  std::ofstream file(part, std::ios::binary);
  file.write(bytes.data(), std::streamsize(bytes.size()));
  file.close();
  std::error_code error;
  if (!file) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "it cannot be written";
    std::filesystem::remove(part, error);
    throw RunError(path.string() + ": " + reason);
  }
  std::filesystem::rename(part, path, error);
  if (error) throw RunError(path.string() + ": " + error.message());
}

}  // namespace asdic::bellhop
