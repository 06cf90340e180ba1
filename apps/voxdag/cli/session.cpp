#include "cli/session.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/resolved_output.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/formats/exports/export_voxels.hpp"

namespace voxdag::cli {

std::string Session::named(std::string text) const {
  if (scratch.empty()) return text;
  for (std::size_t at = 0; (at = text.find(scratch, at)) != text.npos; at += scratch_name.size())
    text.replace(at, scratch.size(), scratch_name);
  return text;
}

Option add_threads_option(const Command& command, Session& session) {
  return command.optional_number<int>("--threads", session.threads, NumberRange::whole(1, 4096),
                                      "N", "Number of threads (default: one per processor)");
}

Option add_memory_option(const Command& command, std::uint64_t& limit) {
  return command.parsed("--memory", limit, parse_memory, "LIMIT",
                        "Maximum memory, including the program (default: three quarters of the "
                        "available memory)");
}

Option add_quiet_option(const Command& command, Session& session) {
  return command.flag("-q,--quiet", session.quiet, "Turn the progress bar and the summary off");
}

Option add_json_option(const Command& command, Session& session) {
  return command.flag("--json", session.json, "Print the result as JSON");
}

void print_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  text = "voxdag: " + with_output_name(std::move(text)) + "\n";
  std::fputs(text.c_str(), stderr);
}

void print_warnings(const std::vector<std::string>& warnings, Session& session) {
  if (session.is_silent) return;
  session.bar.clear();
  for (const std::string& warning : warnings) print_line("warning: " + session.named(warning));
}

void announce_cost(const std::string& work, double seconds, Session& session) {
  constexpr double kWorthALine = 60;
  if (seconds <= kWorthALine || session.is_silent) return;
  session.bar.clear();
  print_line(fmt::format("{} takes about {}", work, human_duration(seconds)));
}

void warn_if_empty(std::uint64_t voxels, const std::string& output, Session& session,
                   const std::string& reason) {
  if (voxels == 0) print_warnings({output + ": no voxels: " + reason}, session);
}

std::string json_text(const nlohmann::ordered_json& json) {
  using Handler = nlohmann::ordered_json::error_handler_t;
  return json.dump(2, ' ', false, Handler::replace) + "\n";
}

void check_writable(const std::string& path) {
  std::error_code unknown;
  // A pipe is not opened here: its reader would see end of file.
  if (resolve_output(path).descriptor < 0 && std::filesystem::is_fifo(path, unknown) &&
      access(path.c_str(), W_OK) == 0)
    return;
  AtomicFile{path};
}

void check_dag_writable(const std::string& path) {
  check_vdag_name(path);
  check_writable(path);
}

}  // namespace voxdag::cli
