/// The voxdag command line for browsers: see index.js.
#include "cli/commands.hpp"
#include "cli/run_program.hpp"

int main(int argc, char** argv) {
  using namespace voxdag::cli;
  return run_program(argc, argv,
                     {.name = "voxdag",
                      .version = VOXDAG_VERSION,
                      .purpose = "Sparse voxel DAGs and octrees from triangle meshes.",
                      .families = {
                          {"Build",
                           {add_scene_command, add_build_command, add_import_command,
                            add_convert_command, add_coarsen_command}},
                          {"Edit",
                           {add_combine_command, add_diff_command, add_components_command,
                            add_edit_command, add_edit_commands}},
                          {"Inspect", {add_info_command, add_verify_command, add_export_command}},
                      }});
}
