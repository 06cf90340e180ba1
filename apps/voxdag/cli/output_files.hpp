#pragma once
/// The files that a command writes, and checks that they overwrite no other file of the command.
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cli/session.hpp"

namespace voxdag::cli {

struct OutputFile {
  std::string option;  ///< The option that names the file, for errors.
  std::string path;    ///< Empty: none.
};

/// Throws UsageError if the paths of an output and of another output or an input lead to the same
/// file. Devices and pipes may be written several times.
void check_distinct(const std::vector<OutputFile>& outputs, const Session& session);

/// Throws Error if an output would overwrite one of `files`, which the file `namer` names.
void check_not_overwritten(const std::vector<OutputFile>& outputs,
                           std::span<const std::filesystem::path> files, const std::string& namer);

/// Returns a path that writes to the standard output, for "-". From then on, the program prints to
/// stderr, for example its summary.
std::string standard_output();

/// Returns the canonical path of the file that receives output to `path`.
std::filesystem::path canonical_output(const std::string& path);

/// Returns whether both paths name the same existing file.
bool are_same_file(const std::string& a, const std::string& b);

}  // namespace voxdag::cli
