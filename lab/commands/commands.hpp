#pragma once
/// The commands of voxdag-lab, one file each.
#include "cli/session.hpp"

namespace voxdag::lab {
using namespace cli;

void add_bench_build_command(const Command& program, Session& session);
void add_bench_conformance_command(const Command& program, Session& session);
void add_bench_trace_command(const Command& program, Session& session);
void add_bench_esvo_command(const Command& program, Session& session);
void add_bench_esvo_rays_command(const Command& program, Session& session);
void add_bench_attributes_command(const Command& program, Session& session);
void add_bench_compact_command(const Command& program, Session& session);
void add_bench_compact_rays_command(const Command& program, Session& session);
void add_bench_papers_command(const Command& program, Session& session);
void add_bench_contacts_command(const Command& program, Session& session);
void add_bench_edits_command(const Command& program, Session& session);
void add_bench_untrusted_command(const Command& program, Session& session);

}  // namespace voxdag::lab
