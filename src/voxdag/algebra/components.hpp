#pragma once
/// Connected components of voxels, and the cavities that bodies enclose.
#include <cstdint>
#include <vector>

#include "voxdag/algebra/grow.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// So many components have this number of voxels.
struct ComponentSizes {
  std::uint64_t voxels = 0, count = 0;

  friend bool operator==(const ComponentSizes&, const ComponentSizes&) = default;
};

/// Returns the sizes of all connected components, the largest first. O(different nodes and pairs of
/// nodes side by side) time and memory. `dag` must be valid. Throws OverMemory and Cancelled.
std::vector<ComponentSizes> component_sizes(const SvdagView& dag, Neighbours neighbours,
                                            Work work = {});

/// Returns the minimal DAG, in canonical order, of the components that have at least `least`
/// voxels. Throws Error if it outgrows 32-bit pointers; see component_sizes() for the rest.
Svdag keep_components(const SvdagView& dag, std::uint64_t least, Neighbours neighbours,
                      Work work = {});

/// Returns the minimal DAG, in canonical order, of all voxels, and of all places without voxels
/// that no way over faces (6 neighbours) connects with the sides of the grid. Throws as
/// keep_components() does.
Svdag fill_cavities(const SvdagView& dag, Work work = {});

}  // namespace voxdag
