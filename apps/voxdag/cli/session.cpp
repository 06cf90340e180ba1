#include "cli/session.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "cli/number_check.hpp"
#include "voxdag/io/atomic_file.hpp"
#include "voxdag/io/resolved_output.hpp"

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
  command.add_flag("-q,--quiet", session.quiet, "No progress bar and no summary");
}

void add_json_option(CLI::App& command, Session& session) {
  command.add_flag("--json", session.json, "Print the result as JSON");
}

void print_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  text = "voxdag: " + text + "\n";
  std::fputs(text.c_str(), stderr);
}

void print_warnings(const std::vector<std::string>& warnings, Session& session) {
  session.bar.clear();
  for (const std::string& warning : warnings) print_line("warning: " + warning);
}

void warn_if_empty(std::uint64_t voxels, const std::string& output, Session& session) {
  if (voxels == 0)
    print_warnings({output + ": no voxels: none of the mesh's surface is seen in the grid"},
                   session);
}

std::string json_text(const nlohmann::ordered_json& json) {
  using Handler = nlohmann::ordered_json::error_handler_t;
  return json.dump(2, ' ', false, Handler::replace) + "\n";
}

void check_writable(const std::string& path) {
  std::error_code unknown;
  // Who reads it would see its end.
  if (resolve_output(path).descriptor < 0 && std::filesystem::is_fifo(path, unknown) &&
      access(path.c_str(), W_OK) == 0)
    return;
  AtomicFile{path};
}

}  // namespace voxdag
