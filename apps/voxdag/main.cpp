/// The voxdag command line.
#include "cli/commands.hpp"
#include "cli/run_program.hpp"

int main(int argc, char** argv) {
  using namespace voxdag::cli;
  return run_program(argc, argv,
                     {"voxdag",
                      "Sparse voxel DAGs and octrees from triangle meshes: build, inspect, trace and "
                      "render them.",
                      "voxdag " VOXDAG_VERSION,
                      {add_build_command, add_import_command, add_convert_command,
                       add_coarsen_command, add_combine_command, add_diff_command,
                       add_components_command, add_edit_commands, add_info_command,
                       add_verify_command, add_view_command, add_render_command, add_trace_command,
                       add_query_command, add_export_command, add_scene_command, add_bench_command,
                       add_completion_command}});
}
