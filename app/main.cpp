#include <string>
#include <vector>

#include "app/command.h"
#include "app/program.h"
#include "app/topics.h"
#include "io/ping/provenance.h"

// asdic: every command.
namespace asdic::detail::app {
namespace {

/// What asdic can do, a line a command.
std::vector<CommandGroup> overview() {
  return {{"Simulate a sonar",
           {{"ping", "what every phone receives, into an HDF5 file"},
            {"process", "what a sonar makes of it: detections, places, tracks"},
            {"area", "what it sees all round: echo, reverberation, detection"},
            {"place", "where sensors are best put, and how sure that is"},
            {"study", "many pings with drawn conditions: probability of detection"},
            {"merge", "put the parts of a study together"},
            {"recover", "a ping file out of what a killed run left"},
            {"serve", "pings on command, for other programs"},
            {"listen", "hear a phone of what a server sends"}}},
          {"Sound in the sea",
           {{"arrivals", "every eigenray: angles, delays, losses"},
            {"rays", "a fan of rays, and where they go"},
            {"field", "transmission loss over range and depth"},
            {"ocean", "the water and the sea floor of a real place"}}},
          {"Write and check a scenario",
           {{"validate", "read and check it, say what was understood"},
            {"settings", "keys, units, ranges and defaults of files"}}},
          {"Look at results",
           {{"info", "what a file holds, on one screen"},
            {"plot", "pictures of a file"},
            {"export", "a ping as WAV or MAT"},
            {"compare", "how far two results are apart"}}},
          {"BELLHOP",
           {{"bellhop", "run a case: .env in, .shd, .arr or .ray out"},
            {"explain", "why BELLHOP's answer and the right one differ"},
            {"convert", "cases and results to asdic's files and back"}}},
          {"Help", {{"help", "of a command or a subject; manual pages, completions"}}}};
}

int run(int argc, char** argv) {
  Program program(
      "asdic",
      "asdic simulates an active sonar in a real ocean: a ping goes out, sound refracts, "
      "strikes the surface and the targets, and comes back to every phone.",
      version_text());
  program.overview(overview());
  program.footer(
      "asdic COMMAND --help tells every option of a command. asdic help TOPIC tells of a "
      "subject: " +
      joined_topics() +
      ".\n"
      "Exit status: 0 done, 1 it could not be done, 2 the input is wrong.\n" +
      example_of_beginning());
  add_ping_command(program);
  add_rays_command(program);
  add_arrivals_command(program);
  add_validate_command(program);
  add_info_command(program);
  add_plot_command(program);
  add_export_command(program);
  add_ocean_command(program);
  add_bellhop_command(program);
  add_convert_command(program);
  add_explain_command(program);
  add_compare_command(program);
  add_field_command(program);
  add_area_command(program);
  add_place_command(program);
  add_process_command(program);
  add_study_command(program);
  add_merge_command(program);
  add_recover_command(program);
  add_serve_command(program);
  add_listen_command(program);
  add_settings_command(program);
  add_help_command(program);
  return program.parse(argc, argv)();
}

}  // namespace
}  // namespace asdic::detail::app

int main(int argc, char** argv) {
  return asdic::detail::app::run_program("asdic",
                                         [&] { return asdic::detail::app::run(argc, argv); });
}
