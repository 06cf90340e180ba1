#pragma once
/// The output of `voxdag build` and `voxdag import`. Its ending chooses what it becomes.
#include <functional>
#include <string>

#include "cli/session.hpp"

namespace voxdag::cli {

/// Returns the command that makes this output of a DAG: "export" or "render". Returns "" if the
/// output is the built file: it ends in .vdag or .esvo, or is a pipe or a device. Throws UsageError
/// for all other names.
std::string maker_of(const std::string& output);

/// Returns whether an output that maker_of() makes of a DAG shows colours.
bool shows_colors(const std::string& output);

/// Calls build(output) if the output is the built file. Otherwise calls build() with a scratch
/// file, quietly, and runs the command that makes the output of it, with its options at their
/// defaults.
void build_output(const std::string& output, Session& session,
                  const std::function<void(const std::string& file)>& build);

}  // namespace voxdag::cli
