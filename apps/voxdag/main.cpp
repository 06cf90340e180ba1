/// The voxdag command line.
#include "cli/commands.hpp"
#include "cli/run_program.hpp"
#include "version.hpp"

int main(int argc, char** argv) {
  using namespace voxdag::cli;
  return run_program(
      argc, argv,
      {.name = "voxdag",
       .version = version_text(),
       .purpose = "Sparse voxel DAGs and octrees from triangle meshes: build, inspect, trace and "
                  "render them.",
       .families = {
           {"Build",
            {add_scene_command, add_build_command, add_import_command, add_convert_command,
             add_coarsen_command}},
           {"Edit",
            {add_combine_command, add_diff_command, add_components_command, add_materials_command,
             add_edit_command, add_edit_commands}},
           {"Inspect", {add_info_command, add_verify_command, add_export_command}},
           {"Render and view", {add_render_command, add_view_command}},
           {"Trace and query", {add_trace_command, add_query_command}},
           {"Benchmark", {add_bench_command}},
           {"Shell", {add_completion_command}},
       }});
}
