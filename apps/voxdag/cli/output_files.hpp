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

/// Returns whether `path` is the one that standard_output() returned.
bool is_standard_output(const std::string& path);

/// Returns the text with "standard output" in place of the path that standard_output() returned.
std::string with_output_name(std::string text);

/// Returns the canonical path of the file that receives output to `path`.
std::filesystem::path canonical_output(const std::string& path);

/// Returns the output of a command line without -o: the name of the input with this ending, in the
/// current folder. The input is the argument, or `file` if the argument is a pattern. Throws
/// UsageError if the input has no name, or if the output exists: only .vdag and .esvo files are
/// replaced by their like.
std::string default_output(const std::string& argument, const std::string& file,
                           const std::string& ending);

/// Returns whether output to `path` goes to a pipe or a device.
bool is_pipe_or_device(const std::string& path);

/// Returns whether both paths name the same existing file.
bool are_same_file(const std::string& a, const std::string& b);

}  // namespace voxdag::cli
