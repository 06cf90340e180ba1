#include "lab/rivals/rival.hpp"

namespace voxdag::lab {

std::vector<TraceRunner> Rival::prepare(const Grid&, const RaySet&) { return {}; }

std::vector<RivalTime> Rival::cast_all(int, Progress&) { return {}; }

}  // namespace voxdag::lab
