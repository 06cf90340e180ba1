#include "cli/run_program.hpp"

#include <fmt/core.h>

#include <cerrno>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "cli/command_line.hpp"
#include "cli/interrupt.hpp"
#include "cli/job.hpp"
#include "voxdag/core/parallel/thread_count.hpp"

namespace voxdag::cli {
namespace {

constexpr int kFailure = 1, kBadUsage = 2, kSignalBase = 128;
constexpr int kCancelled = -1;  // becomes kSignalBase plus the signal

int report(const std::string& text, int status) {
  print_line(text);
  return status;
}

/// Throws Error if the output could not be written.
void check_output() {
  std::cout.flush();
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout)
    throw Error("standard output", "", std::system_category().message(errno));
}

/// Returns the reason if a long text could not be printed, which fmt::print() reports without a
/// name; else an empty text.
std::string output_failure(const std::exception& error) {
  const auto* const failure = dynamic_cast<const std::system_error*>(&error);
  if (failure == nullptr || std::ferror(stdout) == 0) return "";
  return "standard output: " + failure->code().message();
}

void work(Session& session) {
  std::optional<ThreadLimit> threads;
  if (session.threads > 0) threads.emplace(static_cast<std::size_t>(session.threads));
  session.bar.enable(!session.quiet);
  const std::function<void()> chosen = session.work;  // It may run other commands.
  chosen();
  session.bar.clear();
  check_output();
}

/// Declares all subcommands.
void add_commands(const CommandLine& line, const Program& program, Session& session) {
  for (const Family& family : program.families)
    for (const AddCommand add : family.commands)
      add(line.root().with_heading(family.heading), session);
}

/// Session::run_command of the program.
void run_command(std::vector<std::string> arguments, const Program& program, Session& session) {
  const CommandState outer = std::exchange<CommandState>(session, {});
  CommandLine line(program.name, program.purpose, program.version);
  add_commands(line, program, session);
  arguments.insert(arguments.begin(), program.name);
  std::vector<char*> texts;
  for (std::string& argument : arguments) texts.push_back(argument.data());
  line.parse(static_cast<int>(texts.size()), texts.data());
  const std::function<void()> chosen = session.work;
  chosen();
  static_cast<CommandState&>(session) = outer;
}

int run(int argc, char** argv, const Program& program) {
  CommandLine line(program.name, program.purpose, program.name + " " + program.version,
                   "`" + program.name + " COMMAND --help` or `" + program.name +
                       " help COMMAND` prints the options of a command, with an example.\n\n"
                       "Results go to stdout; progress, warnings and errors go to stderr. Exit "
                       "status: 0 success, 1 failure, 2 wrong usage, 128 + N if signal N ended the "
                       "work.");
  Session session;
  add_commands(line, program, session);
  session.run_command = [&](const std::vector<std::string>& arguments) {
    run_command(arguments, program, session);
  };
  try {
    if (!line.parse(argc, argv)) {
      check_output();
      return 0;
    }
  } catch (const UsageError& error) {
    return report(error.what(), kBadUsage);
  }
  cancel_on_signals(session.progress);
  const std::string subject = session.subject.empty() ? "" : session.subject + ": ";
  const auto fail = [&](std::string text, int status) {
    text = session.named(text);
    session.bar.clear();
    // After a signal, system calls may fail.
    const int signal = cancelling_signal();
    if (!session.job || session.job->fails_first())
      report(signal != 0 && status != kCancelled ? "cancelled: " + text : text, status);
    if (signal != 0 || status == kCancelled) status = kSignalBase + signal;
    if (session.job) session.job->end(status);
    return status;
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
    const std::string output = output_failure(error);
    return fail(output.empty() ? subject + error.what() : output, kFailure);
  }
}

}  // namespace

int run_program(int argc, char** argv, const Program& program) try {
  make_writes_return_errors();
  return run(argc, argv, program);
} catch (const std::exception& error) {
  const std::string output = output_failure(error);
  return report(output.empty() ? error.what() : output, kFailure);
}

}  // namespace voxdag::cli
