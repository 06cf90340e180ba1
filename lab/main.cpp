/// voxdag-lab: measures builds and rays, also against other programs. `voxdag bench` runs it.
#include "cli/run_program.hpp"
#include "lab/commands/commands.hpp"

int main(int argc, char** argv) {
  using namespace voxdag::lab;
  return run_program(
      argc, argv,
      {.name = "voxdag-lab",
       .version = VOXDAG_VERSION,
       .purpose = "Benchmark builds and rays, also against other programs",
       .families = {
           {"Benchmarks",
            {add_bench_build_command, add_bench_conformance_command, add_bench_trace_command,
             add_bench_esvo_command, add_bench_esvo_rays_command, add_bench_compact_command,
             add_bench_compact_rays_command, add_bench_attributes_command, add_bench_edits_command,
             add_bench_contacts_command, add_bench_papers_command, add_bench_untrusted_command}}}});
}
