#pragma once
/// Many rays at once: batch visibility queries on the CPU.
#include <span>

#include "voxdag/core/grid.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/trace/hit.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// hits[i] becomes the first voxel along rays[i], which is in world units. The spans have equal
/// length; `grid.levels` is the scene's, which must be valid. Runs on the threads of the current
/// TBB arena; the result does not depend on them. Throws Cancelled.
void trace_batch(const CpuScene& scene, const Grid& grid, std::span<const Ray> rays,
                 std::span<Hit> hits, Progress* progress = nullptr);

}  // namespace voxdag
