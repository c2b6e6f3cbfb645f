#include "app/program.h"

// The whole program: every command.
int main(int argc, char** argv) {
  using namespace asdic::app;
  constexpr AddCommand commands[] = {
      add_ping_command,    add_rays_command,    add_arrivals_command, add_validate_command,
      add_info_command,    add_plot_command,    add_export_command,   add_ocean_command,
      add_bellhop_command, add_convert_command, add_explain_command,  add_compare_command,
      add_field_command,   add_process_command, add_study_command,    add_merge_command,
      add_serve_command};
  return run_program(argc, argv, commands);
}
