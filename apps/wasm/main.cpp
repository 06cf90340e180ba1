/// The voxdag command line for browsers: apps/viewer/page/build/program.js runs it.
#include "cli/commands.hpp"
#include "cli/run_program.hpp"

int main(int argc, char** argv) {
  using namespace voxdag::cli;
  return run_program(
      argc, argv,
      {.name = "voxdag",
       .version = VOXDAG_VERSION,
       .purpose = "Sparse voxel DAGs from meshes, points, volumes and voxels.",
       .families = {
           {"Build",
            {add_scene_command, add_build_command, add_import_command, add_convert_command}},
           {"Inspect", {add_info_command, add_export_command}},
       }});
}
