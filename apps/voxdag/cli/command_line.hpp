#pragma once
/// The command line as a whole: parsing, help and usage errors.
#include <memory>
#include <string>

#include "cli/command.hpp"

namespace voxdag::cli {

class CommandLine {
 public:
  /// Makes the parser of `program`; `version` is the text that --version prints, `notes` the end of
  /// the help.
  CommandLine(const std::string& program, const std::string& purpose, const std::string& version,
              const std::string& notes = "");
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Returns the handle of the program, to which subcommands are added.
  Command root() const;

  /// Parses the arguments and calls the function that when_parsed() registered for the chosen
  /// command. Returns false if it printed the help or the version instead. Throws UsageError; its
  /// text is one line that ends with the way to get help.
  bool parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace voxdag::cli
