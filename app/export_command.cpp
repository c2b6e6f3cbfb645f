#include <fmt/format.h>

#include <memory>
#include <optional>

#include "app/command.h"
#include "app/console.h"
#include "core/error.h"
#include "io/ping_file.h"
#include "io/wav.h"

namespace asdic::app {
namespace {

struct ExportOptions {
  std::string file, folder = ".";
  bool wav = false, force = false;
  std::optional<int> ping;
};

int export_wav(const ExportOptions& options) {
  const PingFile file(options.file);
  if (options.ping && static_cast<std::size_t>(*options.ping) > file.pings())
    throw InputError({.where = "--ping",
                      .got = std::to_string(*options.ping),
                      .expected = fmt::format("a ping from 1 to {}", file.pings())});
  if (file.is_complex())
    throw InputError({.where = options.file,
                      .got = "complex baseband",
                      .expected = "pressure: pings.samples = \"pressure\" in the scenario"});
  if (file.pings() == 0)
    throw InputError({.where = options.file, .got = "no ping", .expected = "at least one"});
  std::error_code error;
  std::filesystem::create_directories(options.folder, error);
  if (error) throw RunError(options.folder + ": " + error.message());
  const std::string stem = std::filesystem::path(options.file).stem().string();
  const std::size_t first = options.ping ? static_cast<std::size_t>(*options.ping) - 1 : 0;
  const std::size_t end = options.ping ? first + 1 : file.pings();
  for (std::size_t i = first; i < end; ++i) {
    std::vector<float> pressure;
    for (std::size_t channel = 0; channel < file.channels(); ++channel) {
      const std::vector<float> phone = file.pressure(i, channel);
      pressure.insert(pressure.end(), phone.begin(), phone.end());
    }
    const std::filesystem::path path =
        std::filesystem::path(options.folder) / fmt::format("{}_ping{:03}.wav", stem, i + 1);
    const WavScale scale =
        write_wav(path, pressure, file.channels(), file.sample_rate(), {.force = options.force});
    print(fmt::format("{}: {}, {} Hz, full scale {:.6g} Pa\n", path.string(),
                      count_of(file.channels(), "channel"), scale.sample_rate,
                      scale.pascal_per_unit));
  }
  return 0;
}

}  // namespace

void add_export_command(Program& program) {
  program.add_command(
      "export", "Write the phones of a ping file in another format.", [](const Command& command) {
        auto options = std::make_shared<ExportOptions>();
        command.add_option("FILE", options->file, "ping file (HDF5), written by asdic ping")
            .required();
        command
            .add_flag(
                "--wav", options->wav,
                "NAME_pingNNN.wav, 32-bit float, a channel a phone, and NAME_pingNNN.wav.json "
                "with the scale in pascal")
            .required();
        command.add_option("-o,--output", options->folder, "folder to write into; made if need be")
            .show_default()
            .type_name("DIR");
        command.add_option("--ping", options->ping, "this ping alone; default: all")
            .type_name("N")
            .check(above_zero());
        add_force_option(command, options->force);
        command.footer("Example:  asdic export deep_ocean.h5 --wav -o sounds");
        command.runs([options] { return export_wav(*options); });
      });
}

}  // namespace asdic::app
