#include "voxdag/voxels/voxel_builder.hpp"

#include <array>
#include <string>
#include <vector>

#include "voxdag/algebra/rewrite.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

/// Joins leaf blocks in Morton order to a DAG. It holds the unfinished nodes of one path.
class PathBuilder {
 public:
  PathBuilder(int levels, MemoryBudget* memory) : levels_(levels), memory_(memory) {
    for (int level = 0; level <= levels - 2; ++level) nodes_.emplace_back(memory);
    open_.resize(static_cast<std::size_t>(levels - 2));
  }

  /// Adds a voxel; codes ascend.
  void add(std::uint64_t code) {
    if (block_ != 0 && code >> 6 != block_code_) close_block(code >> 6);
    block_code_ = code >> 6;
    block_ |= std::uint64_t{1} << (code & 63);
  }

  Svdag finish() {
    if (block_ == 0) {
      Svdag empty;
      empty.levels = levels_;
      return empty;
    }
    // No block follows: all nodes are complete.
    close_block(~std::uint64_t{0});
    return detail::join_levels(levels_, nodes_, memory_);
  }

 private:
  /// The words of a node, as UniqueNodes has them.
  struct Node {
    std::array<std::uint32_t, 9> words{};
    std::size_t size = 1;
  };

  /// Adds the block, and all nodes that have no child at or after the block `next`.
  void close_block(std::uint64_t next) {
    const std::uint32_t words[] = {static_cast<std::uint32_t>(block_),
                                   static_cast<std::uint32_t>(block_ >> 32)};
    std::uint32_t place = nodes_.back().add(words, 2);
    block_ = 0;
    for (int level = levels_ - 3; level >= 0; --level) {
      const int below = 3 * (levels_ - 3 - level);
      Node& node = open_[static_cast<std::size_t>(level)];
      node.words[0] |= 1u << (block_code_ >> below & 7);
      node.words[node.size++] = place;
      if (block_code_ >> (below + 3) == next >> (below + 3)) return;
      place = nodes_[static_cast<std::size_t>(level)].add(node.words.data(), node.size);
      node = {};
    }
  }

  int levels_;
  MemoryBudget* memory_;
  std::vector<UniqueNodes> nodes_;
  std::vector<Node> open_;
  std::uint64_t block_ = 0, block_code_ = 0;
};

}  // namespace

VoxelBuilder::VoxelBuilder(int levels, std::size_t most_voxels, const std::filesystem::path& folder,
                           MemoryBudget* memory, Progress* progress)
    : levels_(levels), memory_(memory), codes_(most_voxels, folder, memory, progress) {}

void VoxelBuilder::add(Vec3i voxel) {
  for (int axis = 0; axis < 3; ++axis)
    if (voxel[axis] < 0 || voxel[axis] >> levels_ != 0)
      throw Error("", "",
                  "voxel (" + std::to_string(voxel.x) + ", " + std::to_string(voxel.y) + ", " +
                      std::to_string(voxel.z) + ") lies outside of the grid of " +
                      std::to_string(std::int64_t{1} << levels_) + " voxels a side");
  codes_.add(morton_encode(voxel));
}

Svdag VoxelBuilder::finish() {
  PathBuilder builder(levels_, memory_);
  codes_.visit_all([&](std::uint64_t code) { builder.add(code); });
  return builder.finish();
}

Svdag svdag_of_sorted(int levels, std::span<const std::uint64_t> codes, MemoryBudget* memory) {
  PathBuilder builder(levels, memory);
  for (const std::uint64_t code : codes) builder.add(code);
  return builder.finish();
}

}  // namespace voxdag
