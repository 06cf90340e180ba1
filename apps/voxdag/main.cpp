/// The voxdag command line: exit status 0 for success, 1 for a failure, 2 for bad usage, and
/// 128 + N where signal N cancelled the work. What goes wrong is one line on stderr.
#include <fmt/core.h>
#include <tbb/global_control.h>

#include <cerrno>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <system_error>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"

namespace voxdag {
namespace {

constexpr int kFailure = 1, kBadUsage = 2, kSignalBase = 128;
constexpr int kCancelled = -1;  // kSignalBase and the signal

int report(const std::string& text, int status) {
  print_line(text);
  return status;
}

std::string usage_line(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> commands = app.get_subcommands();
  const std::string usage = commands.empty() ? "voxdag" : "voxdag " + commands[0]->get_name();
  const std::vector<std::string> unknown = app.remaining();
  const std::string reason = commands.empty() && !unknown.empty()
                                 ? fmt::format("there is no command \"{}\"", unknown[0])
                                 : error.what();
  return fmt::format("{} (usage: {} --help)", reason, usage);
}

/// Throws CLI::ValidationError for an option with an empty text: most are names of files, of a
/// variable of the shell that was not set.
void check_not_empty(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    for (const std::string& text : option->results())
      if (text.empty()) throw CLI::ValidationError(option->get_name(), "is empty");
  for (const CLI::App* below : command.get_subcommands()) check_not_empty(*below);
}

/// Throws Error if what was printed could not be written.
void check_output() {
  std::cout.flush();
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout)
    throw Error("standard output", "", std::system_category().message(errno));
}

void work(Session& session) {
  std::optional<tbb::global_control> threads;
  if (session.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism, session.threads);
  session.bar.enable(!session.quiet);
  session.work();
  session.bar.clear();
  check_output();
}

int run(int argc, char** argv) {
  CLI::App app("Sparse voxel DAGs from triangle meshes: build, inspect, trace and render them.",
               "voxdag");
  app.set_version_flag("--version", "voxdag " VOXDAG_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  Session session;
  for (const auto add : {add_build_command, add_info_command, add_verify_command,
                         add_render_command, add_trace_command, add_export_command,
                         add_scene_command, add_bench_command, add_completion_command})
    add(app, session);
  try {
    app.parse(argc, argv);
    check_not_empty(app);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      const int status = app.exit(error);  // Prints the help or the version.
      check_output();
      return status;
    }
    return report(usage_line(app, error), kBadUsage);
  }
  cancel_on_signals(session.progress);
  const std::string subject = session.subject.empty() ? "" : session.subject + ": ";
  const auto fail = [&](const std::string& text, int status) {
    session.bar.clear();
    // A signal lets calls of the system fail.
    if (const int signal = cancelling_signal(); signal != 0 && status != kCancelled)
      return report("cancelled: " + text, kSignalBase + signal);
    return report(text, status == kCancelled ? kSignalBase + cancelling_signal() : status);
  };
  try {
    work(session);
    return 0;
  } catch (const Cancelled& cancelled) {
    return fail(subject + cancelled.what(), kCancelled);
  } catch (const Error& error) {
    return fail(error.file().empty() ? subject + error.what() : error.what(), kFailure);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(fmt::format("{}: {}", error.path1().string(), error.code().message()), kFailure);
  } catch (const std::bad_alloc&) {
    return fail(subject + "out of memory", kFailure);
  } catch (const std::exception& error) {
    return fail(subject + error.what(), kFailure);
  }
}

}  // namespace
}  // namespace voxdag

int main(int argc, char** argv) try {
  voxdag::make_writes_fail_plainly();
  return voxdag::run(argc, argv);
} catch (const std::exception& error) {
  return voxdag::report(error.what(), voxdag::kFailure);
}
