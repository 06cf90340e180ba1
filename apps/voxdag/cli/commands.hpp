#pragma once
/// The subcommands, one file each. Each function declares its command on the parser.
#include "cli/session.hpp"

namespace voxdag::cli {

void add_build_command(const Command& program, Session& session);
void add_import_command(const Command& program, Session& session);
void add_convert_command(const Command& program, Session& session);
void add_coarsen_command(const Command& program, Session& session);
void add_combine_command(const Command& program, Session& session);
void add_diff_command(const Command& program, Session& session);
void add_components_command(const Command& program, Session& session);
void add_materials_command(const Command& program, Session& session);
void add_edit_command(const Command& program, Session& session);
/// Adds crop, shift, mirror, rotate, dilate, erode and fill.
void add_edit_commands(const Command& program, Session& session);
void add_info_command(const Command& program, Session& session);
void add_verify_command(const Command& program, Session& session);
void add_render_command(const Command& program, Session& session);
void add_view_command(const Command& program, Session& session);
void add_query_command(const Command& program, Session& session);
void add_trace_command(const Command& program, Session& session);
void add_export_command(const Command& program, Session& session);
void add_scene_command(const Command& program, Session& session);
/// Adds bench, which runs voxdag-lab.
void add_bench_command(const Command& program, Session& session);
void add_completion_command(const Command& program, Session& session);

}  // namespace voxdag::cli
