/// The commands that are written in Python: lab/report.
#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "lab/commands/commands.hpp"
#include "lab/commands/report_program.hpp"
#include "lab/runs/machine.hpp"
#include "lab/runs/scene_mesh.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {
namespace {

/// Replaces this process by the report's program.
[[noreturn]] void become_report(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = report_command(arguments);
  std::vector<char*> argv;
  argv.reserve(command.size() + 1);
  for (std::string& argument : command) argv.push_back(argument.data());
  argv.push_back(nullptr);
  ::setenv("VOXDAG_LAB_VOXDAG", voxdag_program().c_str(), 1);
  ::setenv("VOXDAG_LAB_NAME", program_name().c_str(), 1);
  ::execvp(argv[0], argv.data());
  throw Error(argv[0], "", std::strerror(errno));
}

void add(const Command& bench, Session& session, const std::string& name,
         const std::string& purpose) {
  bench.add(name, purpose, fmt::format("voxdag bench {} --help", name))
      .pass_on([name, &session](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), name);
        session.work = [arguments = std::move(arguments)] { become_report(arguments); };
      });
}

}  // namespace

void add_bench_build_command(const Command& bench, Session& session) {
  add(bench, session, "build",
      "Measure time, memory and growth of builds, each in a process of its own");
}

void add_bench_conformance_command(const Command& bench, Session& session) {
  add(bench, session, "conformance",
      "Check voxels, nodes, files and hits of fixed scenes against the table of "
      "docs/conformance.md");
}

void add_bench_esvo_command(const Command& bench, Session& session) {
  add(bench, session, "esvo",
      "Measure size, build time, rays per second and silhouettes of ESVOs, with and without "
      "contours");
}

void add_bench_papers_command(const Command& bench, Session& session) {
  add(bench, session, "papers",
      "Measure the tables and figures of both papers again, and write a report");
}

}  // namespace voxdag::lab
