#pragma once
/// The command line as a whole: parsing, help and usage errors.
#include <memory>
#include <string>

#include "cli/command.hpp"

namespace voxdag {

class CommandLine {
 public:
  /// `version` is what --version prints.
  CommandLine(const std::string& program, const std::string& purpose, const std::string& version);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// The program: subcommands are added here.
  Command root() const;

  /// Parses the arguments and calls what when_parsed() of the chosen command was given. Returns
  /// false if the help or the version was asked for and printed. Throws UsageError with one line
  /// that ends with how to get help.
  bool parse(int argc, char** argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace voxdag
