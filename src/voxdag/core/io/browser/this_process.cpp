#include "voxdag/core/io/this_process.hpp"

namespace voxdag {

std::filesystem::path path_of_program() { return {}; }

std::string boot_id() { return {}; }

}  // namespace voxdag
