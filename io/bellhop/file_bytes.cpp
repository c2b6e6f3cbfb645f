#include "io/bellhop/file_bytes.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace asdic::bellhop {

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
