#pragma once
/// Packs nodes into blocks: assigns a slot to each descriptor.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.1: approximate
/// depth-first order within a block, siblings together, gaps so that pairs of descriptors have one
/// parent.
///
/// A subtree of more than `max_slots` is divided below its root: the largest groups of siblings,
/// with their descendants, become blocks of their own until the rest is small enough. So no block
/// is much smaller than an eighth of the largest block. Within a block, 15 bits are enough for
/// every child pointer; only pointers between blocks are far.
#include <cstdint>
#include <vector>

#include "voxdag/builders/esvo/encode/esvo_tree.hpp"
#include "voxdag/stored/esvo/esvo.hpp"
#include "voxdag/stored/esvo/esvo_counts.hpp"
#include "voxdag/stored/esvo/esvo_directory.hpp"

namespace voxdag {

struct PackOptions {
  /// The approximate number of descriptor slots of a block, up to 2^14. 8192 slots make about 200
  /// KB.
  std::uint32_t max_slots = 8192;
  bool with_colors = true, with_normals = true;  ///< Attachments, if the tree has values.
};

/// A far pointer to children that were packed before.
struct PackedLink {
  std::uint64_t child;   ///< As in tree.packed.
  std::uint64_t parent;  ///< The descriptor with the far pointer, as a slot among these blocks.
};

/// Blocks that were packed together, in the order in which they will be stored.
struct PackedBlocks {
  std::vector<std::uint64_t> slots;
  /// Slots of `begin` and `parent` count from the first of these blocks.
  std::vector<EsvoBlockEntry> blocks;
  std::vector<PackedLink> links;
  /// The slot of the first descriptor of node 0's children, counted from the first of these blocks.
  std::uint64_t first_child = 0;
  /// Counts of the descriptors in these blocks and of the voxels that they describe.
  EsvoCounts counts;
};

/// Estimates the slots of the descriptors below node 0, without page headers.
std::uint64_t packed_slots(const EsvoTree& tree);

/// Packs the descendants of node 0, which must have inner children that are not packed yet. If
/// `tree` refers to packed children, `position` is the first slot of these blocks, counted like
/// those in tree.packed; far pointers reach 16 GiB in both directions. `level` and `cell` name node
/// 0's voxel. The block with the children of node 0 comes last; its entry has no parent. The result
/// depends on the arguments alone.
PackedBlocks pack_blocks(const EsvoTree& tree, int level, Vec3i cell, std::uint64_t position,
                         const PackOptions& options);

/// Adds a parent of node 0 whose only child is node 0. The root of an octree then gets a descriptor
/// when the tree is packed.
void add_super_root(EsvoTree& tree);

/// Packs a whole octree. Node 0 is the root.
Esvo pack_octree(EsvoTree tree, int levels, const PackOptions& options = {});

}  // namespace voxdag
