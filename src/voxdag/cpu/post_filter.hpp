#pragma once
/// The filter of a picture's voxels, on the CPU.
#include <vector>

#include "voxdag/render/post_filter.hpp"

namespace voxdag {

/// The filtered colours, on the threads of the current TBB arena; they do not depend on the number
/// of threads.
std::vector<Vec3f> filter_picture(const FilterInput& input);

}  // namespace voxdag
