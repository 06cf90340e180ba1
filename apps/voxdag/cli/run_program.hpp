#pragma once
/// Runs a program of subcommands. Exit status 0: success, 1: failure, 2: wrong usage, 128 + N:
/// signal N cancelled the work. Every error is one line on stderr.
#include <string>
#include <vector>

#include "cli/session.hpp"

namespace voxdag::cli {

/// Declares a subcommand on the parser.
using AddCommand = void (*)(const Command& program, Session& session);

/// The subcommands of one heading of the help.
struct Family {
  const char* heading;
  std::vector<AddCommand> commands;
};

struct Program {
  std::string name;     ///< "voxdag"
  std::string version;  ///< "0.2.0"
  std::string purpose;  ///< The first line of the help.
  std::vector<Family> families;
};

/// Parses the arguments, runs the chosen command, and returns the exit status.
int run_program(int argc, char** argv, const Program& program);

}  // namespace voxdag::cli
