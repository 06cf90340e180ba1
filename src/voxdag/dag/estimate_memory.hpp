#pragma once
/// How much memory a build will need.
#include <cstdint>
#include <optional>

#include "voxdag/dag/build_methods.hpp"

namespace voxdag {

/// Estimates the bytes that a build holds at most, besides the mesh: two coarse builds, of which
/// the finer has 2^-steps of the resolution, show how the DAG grows. Takes about 4^-steps of the
/// build's time. Returns nothing if even the coarse builds exceed the budget. Throws Cancelled.
std::optional<std::uint64_t> estimate_memory(const BuildInput& input, BuildMethod method,
                                             int steps);

/// Returns an upper bound of a kind on the bytes of the DAG, from the area of the triangles alone:
/// real DAGs are seldom above it, and most far below.
std::uint64_t area_bound(const Mesh& mesh, const Grid& grid);

}  // namespace voxdag
