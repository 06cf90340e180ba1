#pragma once
/// Counts and selects voxels by their materials.
#include <cstdint>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// The voxels of one material.
struct MaterialVoxels {
  std::uint64_t voxels = 0;
  Box3i bounds{};  ///< The least voxel, and one past the last on each axis; without voxels: all 0.

  friend bool operator==(const MaterialVoxels&, const MaterialVoxels&) = default;
};

/// Returns the voxels of each material, by id. A voxel has the material of its cell of the finest
/// level with attributes. `attributes` are those of `dag`, and have materials unless it is empty.
/// The time grows with the voxels. Throws Cancelled.
std::vector<MaterialVoxels> material_voxels(const SvdagView& dag,
                                            const DagAttributesView& attributes, Work work = {});

/// Returns the voxels whose material has `keeps[id]`, which has a value for each id. Throws
/// OverMemory and Cancelled.
Svdag keep_materials(const SvdagView& dag, const DagAttributesView& attributes,
                     const std::vector<bool>& keeps, Work work = {});

}  // namespace voxdag
