/// `voxdag bench`: the parent of the benchmark commands.
#include "cli/commands.hpp"

namespace voxdag {

void add_bench_command(const Command& program, Session& session) {
  const Command bench =
      program.add("bench", "Benchmark builds and rays, also against other programs",
                  "voxdag bench build sponza.obj -r 2048,4096,8192");
  bench.require_subcommand();
  add_bench_build_command(bench, session);
  add_bench_trace_command(bench, session);
  add_bench_esvo_command(bench, session);
  add_bench_compact_command(bench, session);
  add_bench_compact_rays_command(bench, session);
  add_bench_attributes_command(bench, session);
  add_bench_papers_command(bench, session);
  add_bench_untrusted_command(bench, session);
}

}  // namespace voxdag
