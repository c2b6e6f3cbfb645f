#include "serve/unix_socket.h"

#include <sys/stat.h>
#include <unistd.h>

#include <asio.hpp>

#include "core/error.h"
#include "core/text.h"

namespace asdic::detail::serve {

void make_room_for_socket(const std::filesystem::path& path) {
  const auto refuse = [&](const std::string& got, const std::string& expected) {
    throw InputError({.where = "--socket " + path.string(), .got = got, .expected = expected});
  };
  constexpr std::size_t longest = 107;  // sockaddr_un
  if (path.string().size() > longest)
    refuse(std::to_string(path.string().size()) + " bytes", "a path of at most 107 bytes");
  std::error_code error;
  const auto status = std::filesystem::symlink_status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) return;
  if (status.type() != std::filesystem::file_type::socket)
    refuse("something that is no socket", "a name that is free, or a socket left behind");
  asio::io_context io;
  asio::local::stream_protocol::socket probe(io);
  probe.connect(asio::local::stream_protocol::endpoint(path.string()), error);
  if (error != asio::error::connection_refused)
    refuse("a server that listens there", "a name that is free");
  std::filesystem::remove(path, error);
}

namespace {

bool status_of(const std::filesystem::path& path, struct stat& found) {
  return ::lstat(path.c_str(), &found) == 0 && S_ISSOCK(found.st_mode);
}

}  // namespace

SocketName::SocketName(const std::filesystem::path& path) : path_(std::filesystem::absolute(path)) {
  struct stat found {};
  if (!status_of(path_, found)) return;
  device_ = found.st_dev;
  node_ = found.st_ino;
}

SocketName::~SocketName() {
  struct stat found {};
  if (status_of(path_, found) && found.st_dev == device_ && found.st_ino == node_)
    ::unlink(path_.c_str());
}

}  // namespace asdic::detail::serve
