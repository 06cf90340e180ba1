#pragma once
/// Estimates the memory that a build will need.
#include <cstdint>
#include <optional>

#include "voxdag/builders/dag/build_methods.hpp"

namespace voxdag {

/// Estimates the peak bytes of a build, without the mesh, from the growth of the DAG between two
/// coarse builds. The finer of the two has 2^-steps of the resolution. Takes about 4^-steps of the
/// build's time. Returns nothing if even the coarse builds exceed the budget. Throws Cancelled.
std::optional<std::uint64_t> estimate_memory(const BuildInput& input, int steps);

/// Returns a rough upper bound on the bytes of the DAG, from the area of the triangles alone. Real
/// DAGs seldom exceed it; most are much smaller.
std::uint64_t area_bound(const Mesh& mesh, const Grid& grid);

}  // namespace voxdag
