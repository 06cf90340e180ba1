#pragma once
/// The state that subcommands share: common options, progress and cancellation.
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/progress_bar.hpp"
#include "cli/stopwatch.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::cli {

class Job;

/// The state that the parser of one command line fills. A subcommand declares its options and sets
/// `work`, which runs after the parser has checked the complete command line.
struct CommandState {
  std::function<void()> work;
  /// Input files, which are never overwritten.
  std::vector<std::string> inputs;
  std::string subject;  ///< The main input; errors without a file name it.
  int threads = 0;      ///< 0: one per processor.
  bool quiet = false;   ///< No progress bar and no summary.
  bool json = false;    ///< Print the result as JSON.
};

struct Session : CommandState {
  Stopwatch watch;         ///< Since the program began.
  bool is_silent = false;  ///< No warnings: rank 0 of the job prints them.
  /// Runs another command of the program in this process: {"export", "a.vdag", "-o", "a.glb"}. The
  /// state of the session is the same afterwards. Throws what the command throws, and UsageError.
  std::function<void(const std::vector<std::string>& arguments)> run_command;
  /// A file without a name (ScratchDag), and what messages call it; empty: none.
  std::string scratch, scratch_name;

  /// Returns the text with the name of the scratch file in place of its path.
  std::string named(std::string text) const;

  ProgressBar bar;
  Progress progress{[this](std::string_view stage, double fraction, std::uint64_t items) {
    bar.update(stage, fraction, items);
  }};
  std::shared_ptr<Job> job;  ///< Null until join_job().
};

Option add_threads_option(const Command& command, Session& session);
/// Adds --memory for commands whose limit includes the program.
Option add_memory_option(const Command& command, std::uint64_t& limit);
Option add_quiet_option(const Command& command, Session& session);
Option add_json_option(const Command& command, Session& session);

/// Prints "voxdag: TEXT" as one line on stderr. Control characters, which file names may hold,
/// become spaces.
void print_line(std::string text);

/// Prints each warning as a line on stderr.
void print_warnings(const std::vector<std::string>& warnings, Session& session);

/// Prints "voxdag: WORK takes about DURATION" on stderr if that is more than a minute.
void announce_cost(const std::string& work, double seconds, Session& session);

/// Warns if there are no voxels in `output`, and says why.
void warn_if_empty(
    std::uint64_t voxels, const std::string& output, Session& session,
    const std::string& reason = "no visible part of the mesh's surface lies in the grid");

/// Returns indented JSON that ends with a line break. Bytes that are not UTF-8, which file names
/// may have, become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

/// Throws Error unless a file can be created at `path`. Call it before long work.
void check_writable(const std::string& path);
/// Throws Error also if the name is that of another format than .vdag.
void check_dag_writable(const std::string& path);

}  // namespace voxdag::cli
