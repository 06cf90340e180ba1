#include "voxdag/file/model/written_by.hpp"

namespace voxdag {

std::string written_by() { return "voxdag " VOXDAG_VERSION; }

}  // namespace voxdag
