#include "voxdag/algebra/voxels/voxel_builder.hpp"

#include <string>

#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {

void throw_outside_of_grid(Vec3i voxel, int levels) {
  throw Error("", "",
              "voxel (" + std::to_string(voxel.x) + ", " + std::to_string(voxel.y) + ", " +
                  std::to_string(voxel.z) + ") lies outside of the grid of " +
                  std::to_string(std::int64_t{1} << levels) + " voxels a side");
}

VoxelBuilder::VoxelBuilder(int levels, std::size_t most_voxels, const std::filesystem::path& folder,
                           Work work)
    : levels_(levels), memory_(work.memory), codes_(most_voxels, folder, work) {}

Svdag VoxelBuilder::finish() {
  MortonBuilder builder(levels_, memory_);
  codes_.visit_all([&](std::uint64_t code) { builder.add(code); });
  return builder.finish();
}

Svdag svdag_of_sorted(int levels, std::span<const std::uint64_t> codes, MemoryBudget* memory) {
  MortonBuilder builder(levels, memory);
  for (const std::uint64_t code : codes) builder.add(code);
  return builder.finish();
}

}  // namespace voxdag
