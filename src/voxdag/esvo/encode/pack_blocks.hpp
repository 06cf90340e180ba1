#pragma once
/// From nodes to blocks: where each descriptor stands.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.1: approximate
/// depth-first order within a block, siblings together, gaps so that pairs of descriptors have one
/// parent.
///
/// A subtree that outgrows `max_slots` is cut below its root: the heaviest sets of siblings, with
/// all below them, become blocks of their own until the rest is small enough. So no block is much
/// smaller than an eighth of the largest, and within a block every child pointer reaches: only
/// pointers between blocks are far.
#include <cstdint>
#include <vector>

#include "voxdag/esvo/encode/esvo_tree.hpp"
#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/esvo_counts.hpp"
#include "voxdag/layout/esvo_directory.hpp"

namespace voxdag {

struct PackOptions {
  /// Descriptor slots of a block, more or less: up to 2^14. 8192 make blocks of about 200 KB.
  std::uint32_t max_slots = 8192;
  bool with_colors = true, with_normals = true;  ///< Attachments, where the tree has values.
};

/// A far pointer to children that were packed before.
struct PackedLink {
  std::uint64_t child;   ///< As tree.packed gives it.
  std::uint64_t parent;  ///< The descriptor with the far pointer, as a slot among these blocks.
};

/// Blocks that were packed together, in the order in which they will be stored.
struct PackedBlocks {
  std::vector<std::uint64_t> slots;
  /// `begin` and `parent` count from the first of these slots.
  std::vector<EsvoBlockEntry> blocks;
  std::vector<PackedLink> links;
  /// The first descriptor of the children of node 0, as a slot among these.
  std::uint64_t first_child = 0;
  /// Of the descriptors in these blocks and the voxels that they describe.
  EsvoCounts counts;
};

/// How many slots the descriptors below node 0 will take: an estimate, without page headers.
std::uint64_t packed_slots(const EsvoTree& tree);

/// Packs all that is below node 0, which must have inner children that are not packed yet. Where
/// `tree` refers to packed children, `position` is the slot that these blocks will begin at among
/// those that tree.packed counts; far pointers reach 16 GiB either way. `level` and `cell` are
/// those of node 0's voxel. The block that holds the children of node 0 comes last; its entry has
/// no parent. The result depends on the arguments alone.
PackedBlocks pack_blocks(const EsvoTree& tree, int level, Vec3i cell, std::uint64_t position,
                         const PackOptions& options);

/// Puts a node above node 0, which becomes its only child, so that node 0 has a descriptor when the
/// tree is packed: the root of an octree has no parent to make a place for it.
void add_super_root(EsvoTree& tree);

/// A whole octree in memory. Node 0 is the root.
Esvo pack_octree(EsvoTree tree, int levels, const PackOptions& options = {});

}  // namespace voxdag
