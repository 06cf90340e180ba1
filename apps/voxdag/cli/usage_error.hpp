#pragma once
/// The exception for a wrong command line.
#include <stdexcept>
#include <string>

namespace voxdag::cli {

/// The program exits with status 2 and prints "OPTION: REASON (usage: voxdag COMMAND --help)".
class UsageError : public std::runtime_error {
 public:
  explicit UsageError(const std::string& reason) : std::runtime_error(reason) {}
  UsageError(const std::string& option, const std::string& reason)
      : std::runtime_error(option + ": " + reason) {}
};

}  // namespace voxdag::cli
