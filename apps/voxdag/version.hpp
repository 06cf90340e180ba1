#pragma once
#include <string>

namespace voxdag::cli {

/// Returns what `voxdag --version` prints behind the program's name: the version; then, a line
/// each, the commit if it is known, the optional parts that were built, and the vector instructions
/// that this processor uses.
std::string version_text();

}  // namespace voxdag::cli
