#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "app/command.h"
#include "core/error.h"
#include "io/ping_file.h"

namespace asdic::app {
namespace {

namespace fs = std::filesystem;

/// asdic_plot.py beside an installed program, or where the program was built from.
fs::path find_script() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed =
      program.parent_path().parent_path() / "share/asdic/python/asdic_plot.py";
  const fs::path source = fs::path(ASDIC_SOURCE_DIR) / "python/asdic_plot.py";
  for (const fs::path& script : {installed, source})
    if (fs::exists(script, error)) return script;
  throw RunError("plot: found no " + installed.string() + ", expected the pictures' script there");
}

/// Debian's Python has the packages; ASDIC_PYTHON names another.
std::string python() {
  const char* chosen = std::getenv("ASDIC_PYTHON");
  return chosen != nullptr && *chosen != '\0' ? chosen : "/usr/bin/python3";
}

/// Runs a program without a shell. \return its exit status, 128 + n after signal n
int run(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
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
           "import importlib.util as u, sys\n"
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

struct Options {
  std::string file, folder;
  std::optional<int> ping;
};

int plot(const Options& options) {
  static_cast<void>(PingFile(options.file));  // a file that is none is told in our own words
  const std::string interpreter = python();
  const fs::path script = find_script();
  check_modules(interpreter);
  std::vector<std::string> words{interpreter, script.string(), options.file};
  if (!options.folder.empty()) words.insert(words.end(), {"--output", options.folder});
  if (options.ping) words.insert(words.end(), {"--ping", std::to_string(*options.ping)});
  return run(words);
}

}  // namespace

void add_plot_command(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("plot", "Draw the pictures of a ping file (PNG).");
  command->add_option("FILE", options->file, "ping file (HDF5), written by asdic ping")->required();
  command
      ->add_option("-o,--output", options->folder,
                   "folder for the pictures; default: FILE without .h5")
      ->type_name("DIR");
  command->add_option("--ping", options->ping, "ping to draw; default: the first")
      ->type_name("N")
      ->check(above_zero());
  command->footer(
      "Needs Debian's python3-h5py and python3-matplotlib.\n"
      "Example:  asdic plot deep_ocean.h5 -o pictures");
  command->callback([options, &action] { action = [options] { return plot(*options); }; });
}

}  // namespace asdic::app
