#pragma once
/// Casts batches of rays on the CPU.
#include <span>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cpu/cpu_scene.hpp"
#include "voxdag/trace/hit.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// Sets hits[i] to the first voxel along rays[i], which is in world units. The spans must have
/// equal length. The scene must be valid and have the grid's levels. Runs on the threads of the
/// current TBB arena; the result does not depend on their number. Throws Cancelled.
void trace_batch(const CpuScene& scene, const Grid& grid, std::span<const Ray> rays,
                 std::span<Hit> hits, Work work = {});

/// Casts at a compact DAG in place. It takes less memory and more time than a CpuScene of the same
/// voxels, and gives equal hits.
void trace_batch(const InPlaceDag& dag, const Grid& grid, std::span<const Ray> rays,
                 std::span<Hit> hits, Work work = {});

}  // namespace voxdag
