#pragma once
/// The files that a command is to write.
#include <filesystem>
#include <string>
#include <vector>

#include "cli/session.hpp"

namespace voxdag {

struct OutputFile {
  std::string option;  ///< That names it, for errors.
  std::string path;    ///< Empty: none is wanted.
};

/// Throws CLI::ValidationError where one would overwrite another, or what is read: their paths lead
/// to the same file. Devices and pipes can be written several times.
void check_distinct(const std::vector<OutputFile>& outputs, const Session& session);

/// Where what is written to a path goes: the same for all names of a file.
std::filesystem::path place_of(const std::string& path);

/// Whether both are names of one file that exists.
bool are_same_file(const std::string& a, const std::string& b);

}  // namespace voxdag
