#pragma once
/// The files that a command writes, and what they must not overwrite.
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cli/session.hpp"

namespace voxdag {

struct OutputFile {
  std::string option;  ///< The option that names it, for errors.
  std::string path;    ///< Empty: none.
};

/// Throws UsageError if an output would overwrite another output or an input of the session: their
/// paths lead to the same file. Devices and pipes may be written several times.
void check_distinct(const std::vector<OutputFile>& outputs, const Session& session);

/// Throws Error if an output would overwrite one of `files`, which the file `namer` names.
void check_not_overwritten(const std::vector<OutputFile>& outputs,
                           std::span<const std::filesystem::path> files, const std::string& namer);

/// Returns the canonical path of the file that output to `path` goes to.
std::filesystem::path canonical_output(const std::string& path);

/// Whether both are names of one file that exists.
bool are_same_file(const std::string& a, const std::string& b);

}  // namespace voxdag
