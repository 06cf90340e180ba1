#include "session.hpp"

#include <fmt/core.h>

#include "number_check.hpp"
#include "voxdag/core/atomic_file.hpp"

namespace voxdag {

CLI::App& add_command(CLI::App& app, const std::string& name, const std::string& purpose,
                      const std::string& example) {
  CLI::App& command = *app.add_subcommand(name, purpose);
  command.footer("Example:\n  " + example);
  return command;
}

void add_threads_option(CLI::App& command, Session& session) {
  command.add_option("--threads", session.threads, "Threads to use (default: one per processor)")
      ->check(whole_number(1, 4096))
      ->type_name("N");
}

void add_quiet_option(CLI::App& command, Session& session) {
  command.add_flag("-q,--quiet", session.quiet, "No progress bar");
}

void add_json_option(CLI::App& command, Session& session) {
  command.add_flag("--json", session.json, "Print the result as JSON");
}

void print_warnings(const std::vector<std::string>& warnings, Session& session) {
  session.bar.clear();
  for (const std::string& warning : warnings) fmt::print(stderr, "voxdag: warning: {}\n", warning);
}

void warn_if_empty(std::uint64_t voxels, const std::string& output, Session& session) {
  if (voxels == 0)
    print_warnings({output + ": no voxels: none of the mesh's surface is seen in the grid"},
                   session);
}

void check_writable(const std::string& path) { AtomicFile{path}; }

}  // namespace voxdag
