#include <filesystem>
#include <memory>
#include <optional>

#include "app/command.h"
#include "app/picture_source.h"
#include "app/pictures.h"
#include "app/study_info.h"
#include "core/error.h"
#include "io/hdf5/readable.h"
#include "io/ping/ping_file.h"
#include "io/result/result_file.h"
#include "study/runs/study_file.h"

namespace asdic::detail::app {
namespace {

struct PlotOptions {
  std::string file, folder, array;
  std::optional<int> ping;
  bool force = false;
};

/// Whether it is a file of `asdic ping`; what is neither that nor a result of the propagation model
/// is told in our own words.
bool is_ping_file(const std::string& path) {
  if (!is_hdf5(path)) return false;
  const std::string type = filetype_of(path);
  return type == "asdic ping" || !type.starts_with("asdic ");
}

/// FILE without its ending, as the script does it for a ping file.
std::string folder_beside(const std::filesystem::path& file) {
  return file.has_extension() ? std::filesystem::path(file).replace_extension().string()
                              : file.string() + "_pictures";
}

/// \throws InputError for what cannot hold anything to draw
void check_drawable(const std::filesystem::path& file) {
  const auto wrong = [&](const std::string& got) {
    return InputError({.where = file.string(),
                       .got = got,
                       .expected = "a file to draw: HDF5 of asdic ping, study, merge, field, "
                                   "arrivals or rays, or .shd, .arr, .ray"});
  };
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw wrong("no such file");
  if (!std::filesystem::is_regular_file(file, error) || is_hdf5(file)) return;
  if (std::filesystem::file_size(file, error) == 0) throw wrong("an empty file");
  const std::string type = file.extension().string();
  if (type != ".shd" && type != ".arr" && type != ".ray") throw wrong("a file that is not HDF5");
}

int plot(const PlotOptions& options) {
  check_drawable(options.file);
  const TemporaryFolder folder;
  std::filesystem::path file = options.file;
  std::string pictures = options.folder;
  std::vector<std::string> names;
  if (is_study_file(options.file)) {
    study::StudyFile(options.file).check_parts();
  } else if (is_ping_file(options.file)) {
    static_cast<void>(PingFile(options.file));
  } else {
    file = picture_source(options.file, folder, "result");
    static_cast<void>(read_result(file));
    names = {"--names", options.file};
    if (pictures.empty()) pictures = folder_beside(options.file);
  }
  check_readable(Hdf5File::open(file));
  std::vector<std::string> words{file.string()};
  words.insert(words.end(), names.begin(), names.end());
  if (!pictures.empty()) words.insert(words.end(), {"--output", pictures});
  if (options.ping) words.insert(words.end(), {"--ping", std::to_string(*options.ping)});
  if (!options.array.empty()) words.insert(words.end(), {"--array", options.array});
  if (options.force) words.push_back("--force");
  return draw_pictures(words);
}

}  // namespace

void add_plot_command(Program& program) {
  program.add_command(
      "plot", "Draw the pictures of a ping file, a study, a field, arrivals or rays (PNG).",
      [](const Command& command) {
        auto options = std::make_shared<PlotOptions>();
        command
            .add_option(
                "FILE", options->file,
                "HDF5 file of asdic ping, study, field, arrivals or rays; .shd, .arr or .ray")
            .required();
        command
            .add_option("-o,--output", options->folder,
                        "folder for the pictures; default: FILE without its ending")
            .type_name("DIR");
        command.add_option("--ping", options->ping, "ping to draw; default: the first")
            .type_name("N")
            .check(above_zero());
        command
            .add_option(
                "--array", options->array,
                "array of a ping file to draw; default: the first (range over bearing: the first "
                "that tells bearings)")
            .type_name("NAME");
        add_force_option(command, options->force);
        command.footer(
            "Needs Debian's python3-h5py and python3-matplotlib.\n"
            "Example:  asdic plot deep_ocean.h5 -o pictures");
        command.runs([options] { return plot(*options); });
      });
}

}  // namespace asdic::detail::app
