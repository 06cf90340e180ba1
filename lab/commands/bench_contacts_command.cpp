/// The command line of `voxdag bench contacts`.
#include <memory>

#include "lab/commands/bench_output.hpp"
#include "lab/commands/commands.hpp"
#include "lab/contacts/bench_contacts.hpp"

namespace voxdag::lab {

void add_bench_contacts_command(const Command& bench, Session& session) {
  struct Arguments {
    ContactsPlan plan;
    BenchOutput output;
  };
  const auto arguments = std::make_shared<Arguments>();
  ContactsPlan& plan = arguments->plan;
  const Command command =
      bench.add("contacts", "Measure overlaps, sweeps and closest points per millisecond",
                "voxdag bench contacts sponza.vdag --mesh sponza.obj -o contacts.json");
  command.text("scene", plan.scene, "FILE.vdag", "The DAG").required();
  const Option mesh = command.text("--mesh", plan.mesh, "MESH",
                                   "The mesh of the DAG: Embree finds the closest triangles");
  command
      .text("--bullet", plan.bullet, "PROGRAM",
            "The program rival_bullet, which sweeps spheres against the mesh")
      .needs(mesh);
  command.number("--count", plan.count, NumberRange::whole(1, 100000000), "N",
                 "Number of queries of each kind");
  command.number("--radius", plan.radius, NumberRange::up_to(100000), "R",
                 "Radius of spheres and capsules, in voxels");
  command.number("--repeat", plan.repeats, NumberRange::whole(1, 1000), "N",
                 "Number of runs; the fastest counts");
  command.text("-o,--output", arguments->output.json_file, "FILE.json",
               "Also write the JSON to a file");
  add_run_options(command, session);
  command.when_parsed([arguments, &session] {
    session.work = [arguments, &session] {
      arguments->output.check_writable(session.progress);
      const nlohmann::ordered_json machine = machine_json();
      const ContactsRun run = bench_contacts(arguments->plan, session.progress);
      arguments->output.write(contacts_json(run, machine),
                              machine_text(machine) + contacts_table(run), session);
    };
  });
}

}  // namespace voxdag::lab
