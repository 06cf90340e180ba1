#pragma once
#include <string>

namespace voxdag {

/// Returns the program that writes files, for their metadata: "voxdag 0.2.0". It does not name the
/// commit, so that equal input makes equal bytes.
std::string written_by();

}  // namespace voxdag
