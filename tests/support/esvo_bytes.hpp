#pragma once
/// Small ESVO files for tests.
#include <filesystem>

#include "support/esvo_trees.hpp"
#include "voxdag/builders/esvo/encode/pack_blocks.hpp"
#include "voxdag/file/esvo_writer.hpp"

namespace voxdag::test {

struct PackedEsvo {
  PackedBlocks packed;
  int levels = 0;
  EsvoView view() const {
    return {packed.slots.data(), packed.slots.size(), packed.first_child, levels};
  }
};

/// Returns a random octree in blocks of about `max_slots` descriptors.
inline PackedEsvo packed_esvo(int levels, std::uint32_t max_slots, std::uint32_t seed) {
  EsvoTree tree = random_tree({.levels = levels, .leaf_chance = 0.1}, seed);
  add_super_root(tree);
  PackedEsvo esvo{pack_blocks(tree, -1, {}, 0, {.max_slots = max_slots}), levels};
  esvo.packed.blocks.back().level = 0;
  esvo.packed.counts.voxels_per_level[0] = 1;
  return esvo;
}

inline EsvoMetadata metadata_of(const PackedEsvo& esvo) {
  EsvoMetadata metadata;
  metadata.grid.levels = esvo.levels;
  metadata.grid.voxel_size = 0.1;
  metadata.root = esvo.packed.first_child;
  metadata.counts = esvo.packed.counts;
  metadata.source = {"random.obj", 3, 1};
  metadata.program = "voxdag test";
  metadata.build = {{"max_error", "0.5"}};
  return metadata;
}

inline void write_esvo(const std::filesystem::path& path, const PackedEsvo& esvo) {
  EsvoFileWriter writer(path);
  writer.append(esvo.packed.slots);
  writer.finish(esvo.packed.blocks, metadata_of(esvo));
}

}  // namespace voxdag::test
