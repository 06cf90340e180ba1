#pragma once
/// The files that a command is to write.
#include <string>
#include <vector>

namespace voxdag {

struct OutputFile {
  std::string option;  ///< That names it, for errors.
  std::string path;    ///< Empty: none is wanted.
};

/// Throws CLI::ValidationError where one would overwrite another: their paths lead to the same
/// file. Devices and pipes can be written several times.
void check_distinct(const std::vector<OutputFile>& outputs);

}  // namespace voxdag
