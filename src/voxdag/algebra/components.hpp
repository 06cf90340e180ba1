#pragma once
/// Connected components of voxels, and the cavities that bodies enclose.
#include <cstdint>
#include <memory>
#include <vector>

#include "voxdag/algebra/grow.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

class Regions;

/// So many components have this number of voxels.
struct ComponentSizes {
  std::uint64_t voxels = 0, count = 0;

  friend bool operator==(const ComponentSizes&, const ComponentSizes&) = default;
};

/// The connected components of a DAG, found once for several questions. O(different nodes and pairs
/// of nodes side by side) time and memory. All members throw OverMemory and Cancelled.
class Components {
 public:
  /// `dag` must be valid and outlive this object.
  Components(const SvdagView& dag, Neighbours neighbours, Work work = {});
  ~Components();
  Components(const Components&) = delete;
  Components& operator=(const Components&) = delete;

  /// Returns the sizes of all components, the largest first.
  std::vector<ComponentSizes> sizes() const;
  /// Returns the minimal DAG, in canonical order, of the components that have at least `least`
  /// voxels. Throws Error if it outgrows 32-bit pointers.
  Svdag keep(std::uint64_t least) const;

 private:
  std::unique_ptr<const Regions> regions_;
  Work work_;
};

/// Components(dag, neighbours, work).sizes().
std::vector<ComponentSizes> component_sizes(const SvdagView& dag, Neighbours neighbours,
                                            Work work = {});

/// Components(dag, neighbours, work).keep(least).
Svdag keep_components(const SvdagView& dag, std::uint64_t least, Neighbours neighbours,
                      Work work = {});

/// Returns the minimal DAG, in canonical order, of all voxels, and of all places without voxels
/// that no way over faces (6 neighbours) connects with the sides of the grid. Throws as
/// keep_components() does.
Svdag fill_cavities(const SvdagView& dag, Work work = {});

}  // namespace voxdag
