#pragma once
#include <string>

namespace voxdag {

/// Returns the name of this program in the metadata of files: "voxdag 0.1.0".
std::string program_name();

}  // namespace voxdag
