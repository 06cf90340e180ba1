#pragma once
/// Runs a program as a user would: arguments in, status and output out.
#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace voxdag::cli {

struct ProcessResult {
  int status = 0;  ///< Exit status, or 128 + the signal that ended it.
  std::string out, err;
};

/// A running program. The destructor kills it, unless wait() was called, and reaps it.
class Process {
 public:
  /// Starts `command` (command[0] is searched in PATH). stdin is empty. stdout goes to the file
  /// `stdout_path` if one is given, else it is collected.
  explicit Process(const std::vector<std::string>& command, const std::string& stdout_path = {});
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  void send_signal(int number) const;
  /// Waits until is_so(). Returns false if the program has ended without.
  bool wait_until(const std::function<bool()>& is_so) const;
  /// Waits until the program has a handler for the signal, or has ended.
  void wait_until_it_catches(int number) const;
  /// Waits until the program has written to a file in `folder`, which may have no name. Returns
  /// false if the program has ended.
  bool wait_until_it_writes(const std::filesystem::path& folder) const;
  /// Waits until the program has written `text` to stderr. Returns false if it has ended without.
  bool wait_until_it_warns(const std::string& text) const;
  /// Waits until the program has written a line to stdout, or has ended. Returns the line.
  std::string wait_for_line() const;
  /// Waits until the program has mapped the file into its memory, or has ended.
  void wait_until_it_maps(const std::filesystem::path& file) const;
  ProcessResult wait();

 private:
  bool has_ended() const;

  pid_t pid_ = -1;
  int out_ = -1, err_ = -1;  ///< Temporary files without a name.
};

/// Runs the voxdag command line of this build with these arguments.
ProcessResult run_voxdag(std::vector<std::string> arguments, const std::string& stdout_path = {});
/// Returns the command for Process.
std::vector<std::string> voxdag_command(std::vector<std::string> arguments);

/// Returns whether this build has voxdag-lab, which `voxdag bench` runs: extended tests build it.
bool has_lab();

/// Expects a failure that is reported correctly: nothing on stdout, one line on stderr that begins
/// with "voxdag: " and contains `text`, and the exit status.
void expect_failure(const ProcessResult& result, int status, const std::string& text);

/// Returns whether a command with --plot failed because matplotlib is not installed.
bool lacks_matplotlib(const ProcessResult& result);

}  // namespace voxdag::cli
