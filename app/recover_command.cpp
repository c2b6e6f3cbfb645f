#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/command.h"
#include "app/console.h"
#include "core/error.h"
#include "io/hdf5/own_files.h"
#include "io/ping/ping_file.h"
#include "io/ping/recovery.h"

namespace asdic::detail::app {
namespace {

struct RecoverOptions {
  std::string part = ".", output;
  bool force = false, quiet = false;
};

/// The name that the run would have given it.
std::filesystem::path output_of(const RecoverOptions& options) {
  if (!options.output.empty()) return options.output;
  std::filesystem::path target = target_of(options.part);
  if (target.empty())
    throw InputError({.where = options.part,
                      .got = "a name that does not tell what the file was to become",
                      .expected = "NAME.XXXX.part, or -o FILE.h5"});
  return target;
}

/// What is there is another run's, perhaps a better one.
void check_free(const std::filesystem::path& output, bool force) {
  std::error_code ignored;
  if (!force && std::filesystem::exists(output, ignored))
    throw InputError({.where = "--output",
                      .got = '"' + output.string() + "\", which is there already",
                      .expected = "another name (-o), or --force to write over it"});
}

/// Text that says how many whole pings a part holds, or why it cannot be recovered.
std::string worth_of(const std::filesystem::path& part) {
  try {
    const OutputLock still_at_work(target_of(part));
    if (!own::pings(part)) return "no whole ping in it: the next run of that name takes it away";
    const PingFile file(part);
    return fmt::format(
        "{} of {}: asdic recover {}", file.pings(),
        count_of(static_cast<std::size_t>(file.file().attribute_number("", "pings_requested")),
                 "ping"),
        part.string());
  } catch (const std::exception& error) {  // a process is at work on it, or it is damaged
    return error.what();
  }
}

/// Prints each part that an unfinished run has left in a folder, and how many pings it holds.
int list_parts(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> parts;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (std::filesystem::path part = folder == "." ? entry.path().filename() : entry.path();
        !target_of(part).empty())
      parts.push_back(std::move(part));
  std::sort(parts.begin(), parts.end());
  for (const std::filesystem::path& part : parts)
    print(fmt::format("{}: {}\n", part.string(), worth_of(part)));
  if (parts.empty()) print(folder.string() + ": no run has left a part\n");
  return 0;
}

int recover(const RecoverOptions& options) {
  if (std::filesystem::is_directory(options.part)) return list_parts(options.part);
  const std::filesystem::path output = output_of(options), written = target_of(options.part);
  check_free(output, options.force);
  std::optional<OutputLock> still_at_work;  // the run that writes the part
  if (!written.empty() && written != output) still_at_work.emplace(written);
  const Recovery found =
      recover_ping_file(options.part, OutputFile(output, {.own = own::hdf5,
                                                          .worth = own::pings,
                                                          .force = options.force,
                                                          .inputs = {options.part}}));
  if (!options.quiet)
    print(fmt::format("{}: {} of {}{}; {} is of no more use\n", output.string(), found.pings,
                      count_of(found.requested, "ping"),
                      found.pings < found.requested ? ", marked as not complete" : "",
                      options.part));
  return 0;
}

}  // namespace

void add_recover_command(Program& program) {
  program.add_command(
      "recover",
      "Make a ping file of the part that a run left which was killed, or out of power or disk.",
      [](const Command& command) {
        auto options = std::make_shared<RecoverOptions>();
        command.add_option("FILE", options->part,
                           "what is left of asdic ping, NAME.XXXX.part; a folder, by default this "
                           "one: its parts are listed");
        command
            .add_option("-o,--output", options->output,
                        "file to write; default: NAME, if it is not there")
            .type_name("FILE.h5");
        add_force_option(command, options->force);
        command.add_flag("-q,--quiet", options->quiet, "print nothing unless something is wrong");
        command.footer(
            "The part stays as it is. A study needs no recovery: the same command goes on.\n"
            "Example:  asdic recover ping.h5.k3f9.part");
        command.runs([options] { return recover(*options); });
      });
}

}  // namespace asdic::detail::app
