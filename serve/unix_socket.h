#pragma once
#include <filesystem>

namespace asdic::detail::serve {

/// Sees to it that a socket can take a name: it is free, or a server that is gone has left a socket
/// there, which is removed.
/// \throws InputError{where: "--socket"} if something else has it, or a server answers there
void make_room_for_socket(const std::filesystem::path& path);

/// The name of a socket that is there; goes with its owner, unless another has taken it.
class SocketName {
 public:
  explicit SocketName(const std::filesystem::path& path);
  ~SocketName();
  SocketName(const SocketName&) = delete;
  SocketName& operator=(const SocketName&) = delete;

 private:
  std::filesystem::path path_;
  unsigned long device_ = 0, node_ = 0;
};

}  // namespace asdic::detail::serve
