#pragma once
/// The subcommands, one file each. A function declares its command on the parser.
#include "cli/session.hpp"

namespace voxdag {

void add_build_command(CLI::App& app, Session& session);
void add_info_command(CLI::App& app, Session& session);
void add_verify_command(CLI::App& app, Session& session);
void add_render_command(CLI::App& app, Session& session);
void add_trace_command(CLI::App& app, Session& session);
void add_export_command(CLI::App& app, Session& session);
void add_scene_command(CLI::App& app, Session& session);
void add_bench_command(CLI::App& app, Session& session);
void add_bench_trace_command(CLI::App& parent, Session& session);  ///< Below `bench`.
void add_bench_esvo_command(CLI::App& parent, Session& session);   ///< Likewise.
void add_completion_command(CLI::App& app, Session& session);

}  // namespace voxdag
