#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "app/program.h"

// What is called `asdic`: it runs a BELLHOP case itself, for which it needs none of the libraries
// of files and pictures (loading those takes longer than all arrivals of a case), and hands every
// other command to the whole program beside it.
namespace {

/// ../libexec/asdic/asdic-full from here.
std::filesystem::path whole_program() {
  std::error_code error;
  const auto here = std::filesystem::read_symlink("/proc/self/exe", error);
  return here.parent_path().parent_path() / "libexec/asdic/asdic-full";
}

}  // namespace

int main(int argc, char** argv) {
  using namespace asdic::app;
  if (argc > 1 && std::string_view(argv[1]) == "bellhop") {
    constexpr AddCommand commands[] = {add_bellhop_command};
    return run_program(argc, argv, commands);
  }
  const std::string program = whole_program().string();
  execv(program.c_str(), argv);
  std::fprintf(stderr, "asdic: %s: %s\n", program.c_str(), std::strerror(errno));
  return 1;
}
