#include "voxdag/model/program_name.hpp"

namespace voxdag {

std::string program_name() { return "voxdag " VOXDAG_VERSION; }

}  // namespace voxdag
