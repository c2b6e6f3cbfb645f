#include "app/command.h"
#include "app/program.h"
#include "io/ping/provenance.h"

// asdic: every command.
namespace asdic::detail::app {
namespace {

int run(int argc, char** argv) {
  Program program("asdic",
                  "asdic simulates an active sonar in a real ocean: a ping goes out, sound\n"
                  "refracts, strikes the surface and the targets, and comes back to every phone.",
                  version_text());
  program.footer(
      "Example:  asdic ping scenarios/deep_ocean.toml -o deep_ocean.h5\n"
      "Exit status: 0 done, 1 it could not be done, 2 the input is wrong.");
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
  add_process_command(program);
  add_study_command(program);
  add_merge_command(program);
  add_recover_command(program);
  add_serve_command(program);
  add_settings_command(program);
  return program.parse(argc, argv)();
}

}  // namespace
}  // namespace asdic::detail::app

int main(int argc, char** argv) {
  return asdic::detail::app::run_program("asdic",
                                         [&] { return asdic::detail::app::run(argc, argv); });
}
