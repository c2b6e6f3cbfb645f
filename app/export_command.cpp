#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/file_exports.h"
#include "core/error.h"

namespace asdic::detail::app {
namespace {

struct ExportOptions {
  std::string file, folder = ".";
  std::array<bool, file_exports.size()> wanted{};
  bool force = false;
  std::optional<int> ping;
};

/// \throws UsageError if none is wanted
void require_one(const ExportOptions& options) {
  if (std::find(options.wanted.begin(), options.wanted.end(), true) != options.wanted.end()) return;
  std::string names;
  for (const AnyFileExport& one : file_exports)
    names += (names.empty() ? "--" : " or --") + std::string(one.name);
  throw UsageError(names + " is required; see asdic export --help");
}

int export_file(const ExportOptions& options) {
  require_one(options);
  const PingFile file(options.file);
  if (file.pings() == 0)
    throw InputError({.where = options.file, .got = "no ping", .expected = "at least one"});
  std::size_t first = 0;
  if (options.ping) {
    const std::vector<int> numbers = file.numbers();
    const auto at = std::find(numbers.begin(), numbers.end(), *options.ping);
    if (at == numbers.end())
      throw InputError(
          {.where = "--ping",
           .got = std::to_string(*options.ping),
           .expected = fmt::format("a ping from {} to {}", numbers.front(), numbers.back())});
    first = static_cast<std::size_t>(at - numbers.begin());
  }
  const ExportChoice choice{.file = options.file,
                            .folder = options.folder,
                            .first = first,
                            .end = options.ping ? first + 1 : file.pings(),
                            .force = options.force};
  for (std::size_t i = 0; i < file_exports.size(); ++i)
    if (options.wanted[i]) file_exports[i].check(file, choice);
  std::error_code error;
  std::filesystem::create_directories(choice.folder, error);
  if (error) throw RunError(options.folder + ": " + error.message());
  for (std::size_t i = 0; i < file_exports.size(); ++i)
    if (options.wanted[i]) file_exports[i].write(file, choice);
  return 0;
}

}  // namespace

void add_export_command(Program& program) {
  program.add_command(
      "export", "Write the phones of a ping file in another format.", [](const Command& command) {
        auto options = std::make_shared<ExportOptions>();
        command.add_option("FILE", options->file, "ping file (HDF5), written by asdic ping")
            .required();
        for (std::size_t i = 0; i < file_exports.size(); ++i)
          command.add_flag("--" + std::string(file_exports[i].name), options->wanted[i],
                           std::string(file_exports[i].help));
        command.add_option("-o,--output", options->folder, "folder to write into; made if need be")
            .show_default()
            .type_name("DIR");
        command.add_option("--ping", options->ping, "this ping alone; default: all")
            .type_name("N")
            .check(above_zero());
        add_force_option(command, options->force);
        command.footer("Example:  asdic export deep_ocean.h5 --wav -o sounds");
        command.runs([options] { return export_file(*options); });
      });
}

}  // namespace asdic::detail::app
