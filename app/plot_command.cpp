#include <filesystem>
#include <memory>
#include <optional>

#include "app/area_info.h"
#include "app/command.h"
#include "app/picture_source.h"
#include "app/pictures.h"
#include "app/place_info.h"
#include "app/study_comparison.h"
#include "app/study_info.h"
#include "core/error.h"
#include "io/hdf5/readable.h"
#include "io/ping/ping_file.h"
#include "io/ping/provenance.h"
#include "io/result/result_file.h"
#include "io/result/scene_file.h"
#include "io/scenario/propagation.h"
#include "io/scenario/scenario_reader.h"
#include "study/runs/study_file.h"

namespace asdic::detail::app {
namespace {

/// An option that is the script's own: it goes there as it is typed, and is checked there.
struct Passed {
  std::string option, type, help;
  std::string word{};
};

struct PlotOptions {
  ScenarioChoice scenario;  ///< its path may be that of any file to draw
  std::string folder;
  std::optional<int> ping;
  bool force = false, html = false;
  std::vector<Passed> passed{
      {"--array", "NAME",
       "array of a ping file to draw; default: the first (range over bearing: the first that tells "
       "bearings)"},
      {"--only", "NAME,...", "these pictures alone: --only levels,rays"},
      {"--format", "KIND,...", "png, pdf or svg, or several: --format png,pdf; default: png"},
      {"--dpi", "N", "pixels an inch of a PNG, and of images in the others; default: 150"},
      {"--theme", "NAME", "light or dark; default: light"},
      {"--limits", "LOW:HIGH",
       "ends of colours and levels in dB; NAME=LOW:HIGH,... of one picture each"},
  };
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
                       .expected =
                           "a file to draw: HDF5 of asdic ping, area, place, study, merge, field, "
                           "arrivals or rays, or .shd, .arr, .ray, or a scenario, .toml"});
  };
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw wrong("no such file");
  if (!std::filesystem::is_regular_file(file, error) || is_hdf5(file)) return;
  if (std::filesystem::file_size(file, error) == 0) throw wrong("an empty file");
  const std::string type = file.extension().string();
  if (type != ".shd" && type != ".arr" && type != ".ray") throw wrong("a file that is not HDF5");
}

bool is_scenario(const std::filesystem::path& file) { return file.extension() == ".toml"; }

/// What a scenario says, before anything is computed.
std::filesystem::path scene_of(const ScenarioChoice& choice, const TemporaryFolder& folder) {
  std::filesystem::path scene = folder.path() / "scene.h5";
  if (has_sonar(choice.path, choice.overrides)) {
    write_scene(scene, read_scenario(choice.path, choice.overrides));
    return scene;
  }
  std::vector<std::string> notes;
  write_scene(scene, read_propagation_case(choice.path, choice.overrides, notes));
  return scene;
}

int plot(const PlotOptions& options) {
  const std::string& given = options.scenario.path;
  if (!is_scenario(given)) {
    check_drawable(given);
    if (!options.scenario.overrides.empty())
      throw InputError({.where = "--set", .got = given, .expected = "a scenario, .toml"});
  }
  const bool has_page = !is_scenario(given) &&
                        (is_ping_file(given) || is_study_file(given) || is_comparison_file(given));
  if (options.html && !has_page)
    throw InputError({.where = given,
                      .got = "--html for a file that holds neither pings nor a study",
                      .expected = "a file of asdic ping or asdic study; the others have pictures, "
                                  "without --html"});
  const TemporaryFolder folder;
  std::filesystem::path file = given;
  std::string pictures = options.folder;
  std::vector<std::string> names;
  if (is_scenario(given)) {
    file = scene_of(options.scenario, folder);
    names = {"--names", given};
    if (pictures.empty()) pictures = folder_beside(given);
  } else if (is_study_file(given)) {
    study::StudyFile(given).check_parts();
  } else if (is_comparison_file(given)) {
    check_comparison(given);
  } else if (is_area_file(given)) {
    static_cast<void>(read_coverage_summary(given));
  } else if (is_placement_file(given)) {
    static_cast<void>(study::read_placement_answer(given));
  } else if (is_ping_file(given)) {
    static_cast<void>(PingFile(given));
  } else {
    file = picture_source(given, folder, "result");
    static_cast<void>(read_result(file));
    names = {"--names", given};
    if (pictures.empty()) pictures = folder_beside(given);
  }
  check_readable(Hdf5File::open(file));
  std::vector<std::string> words{file.string()};
  words.insert(words.end(), names.begin(), names.end());
  if (!pictures.empty()) words.insert(words.end(), {"--output", pictures});
  if (options.ping) words.insert(words.end(), {"--ping", std::to_string(*options.ping)});
  for (const Passed& one : options.passed)
    if (!one.word.empty()) words.push_back(one.option + "=" + one.word);
  words.push_back("--program=" + program_version());
  if (options.html) words.push_back("--html");
  if (options.force) words.push_back("--force");
  return draw_pictures(words);
}

}  // namespace

void add_plot_command(Program& program) {
  program.add_command(
      "plot",
      "Draw the pictures of a ping file, an area, a study, a field, arrivals or rays, or of a "
      "scenario before it runs.",
      [](const Command& command) {
        auto options = std::make_shared<PlotOptions>();
        command
            .add_option("FILE", options->scenario.path,
                        "HDF5 file of asdic ping, area, place, study, field, arrivals or rays; "
                        ".shd, .arr or "
                        ".ray; or a scenario, .toml")
            .required();
        command
            .add_option("-o,--output", options->folder,
                        "folder for the pictures; default: FILE without its ending")
            .type_name("DIR");
        command.add_option("--ping", options->ping, "ping to draw; default: the first")
            .type_name("N")
            .check(above_zero());
        for (Passed& one : options->passed)
          command.add_option(one.option, one.word, one.help).type_name(one.type);
        command.add_flag("--html", options->html,
                         "of a ping file one page for a browser, which zooms and tells values, in "
                         "place of pictures; -o names it (NAME.html) or its folder "
                         "(default: FILE.html); it holds all pings "
                         "and arrays, or those of --ping and --array");
        add_set_option(command, options->scenario);
        add_force_option(command, options->force);
        command.footer(
            "Needs Debian's python3-h5py and python3-matplotlib.\n"
            "Example:  asdic plot deep_ocean.h5 -o pictures --format pdf --only levels,rays");
        command.runs([options] { return plot(*options); });
      });
}

}  // namespace asdic::detail::app
