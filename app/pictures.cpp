#include "app/pictures.h"

#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "app/console.h"
#include "app/shared_files.h"
#include "core/error.h"

namespace asdic::detail::app {
namespace {

namespace fs = std::filesystem;

/// asdic_plot.py beside an installed program, or where the program was built from.
fs::path find_script() {
  const fs::path script = shared_file("python/asdic_plot.py");
  if (!script.empty()) return script;
  throw RunError("plot: found no " + installed_file("python/asdic_plot.py").string() +
                 ", expected the pictures' script there");
}

/// Debian's Python has the packages; ASDIC_PYTHON names another.
std::string python() {
  const char* chosen = std::getenv("ASDIC_PYTHON");
  return chosen != nullptr && *chosen != '\0' ? chosen : "/usr/bin/python3";
}

/// Runs a program without a shell. \return its exit status, 128 + n after signal n
int run(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  setenv("HDF5_USE_FILE_LOCKING", "FALSE", 0);  // it reads alone, and some systems refuse locks
  if (const int error =
          posix_spawn(&child, words[0].c_str(), nullptr, nullptr, arguments.data(), environ))
    throw RunError(
        fmt::format("plot: {}: {}; pictures need Python (Debian: python3 python3-h5py "
                    "python3-matplotlib)",
                    words[0], std::strerror(error)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) throw RunError(fmt::format("plot: {}: {}", words[0], std::strerror(errno)));
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

void check_modules(const std::string& interpreter) {
  constexpr const char* modules[] = {"numpy", "h5py", "matplotlib"};
  const int missing =
      run({interpreter, "-c",
           "import sys\n"
           // modules of the working folder are not Python's
           "sys.path[:] = [p for p in sys.path if p]\n"
           "import importlib.util as u\n"
           "names = ['numpy', 'h5py', 'matplotlib']\n"
           "sys.exit(sum(64 >> i for i, m in enumerate(names) if not u.find_spec(m)))"});
  if (missing == 0) return;
  std::string names;
  for (std::size_t i = 0; i < std::size(modules); ++i)
    if ((missing & (64 >> i)) != 0) names += std::string(names.empty() ? "" : ", ") + modules[i];
  throw RunError(
      fmt::format("plot: {} has no {}; pictures need it (Debian: python3-numpy "
                  "python3-h5py python3-matplotlib)",
                  interpreter, names.empty() ? "working Python" : names));
}

}  // namespace

int draw_pictures(const std::vector<std::string>& arguments) {
  const std::string interpreter = python();
  const fs::path script = find_script();
  check_modules(interpreter);
  flush_output();  // what was said before stands before what the script says
  std::vector<std::string> words{interpreter, script.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const int status = run(words);
  if (status == 128 + SIGSEGV || status == 128 + SIGABRT || status == 128 + SIGBUS)
    throw RunError(
        fmt::format("plot: Python crashed ({}) on {}", strsignal(status - 128), arguments.front()));
  return status;
}

}  // namespace asdic::detail::app
