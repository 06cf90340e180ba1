#include "voxdag/builders/esvo/encode/pack_blocks.hpp"

#include <gtest/gtest.h>

#include "support/esvo_trees.hpp"
#include "voxdag/stored/esvo/color_block.hpp"

namespace voxdag {
namespace {

using test::random_tree;
using test::unpack;

void expect_same(const EsvoTree& a, const EsvoTree& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    ASSERT_EQ(a.nodes[i].valid_mask, b.nodes[i].valid_mask) << i;
    ASSERT_EQ(a.nodes[i].leaf_mask, b.nodes[i].leaf_mask) << i;
    ASSERT_EQ(a.nodes[i].contour_mask, b.nodes[i].contour_mask) << i;
    if (a.nodes[i].inner_count() > 0) {
      ASSERT_EQ(a.nodes[i].first_child, b.nodes[i].first_child) << i;
    }
  }
  EXPECT_EQ(a.contours, b.contours);
}

TEST(PackBlocks, AWalkReadsBackEveryNodeAndContour) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const EsvoTree tree = random_tree({.levels = 2 + static_cast<int>(seed % 6)}, seed);
    for (const std::uint32_t max_slots : {8u, 64u, 1000u, 16384u}) {
      const Esvo esvo = pack_octree(tree, 8, {.max_slots = max_slots});
      expect_same(tree, unpack(esvo.view()));
    }
  }
}

TEST(PackBlocks, SiblingsShareAPageAndPairsHaveOneParent) {
  const EsvoTree tree = random_tree({.levels = 7, .density = 0.6, .leaf_chance = 0.05}, 1);
  const Esvo esvo = pack_octree(tree, 7, {.max_slots = 4000});
  const EsvoView view = esvo.view();
  std::vector<std::uint64_t> parent(view.slot_count, ~std::uint64_t{0});
  std::vector<std::uint64_t> open{view.root};
  while (!open.empty()) {
    const std::uint64_t slot = open.back();
    open.pop_back();
    const ChildDescriptor d = view.descriptor(slot);
    std::uint64_t page = 0;
    for (int i = 0; i < 8; ++i) {
      if ((d.inner_mask() >> i & 1) == 0) continue;
      const std::uint64_t child = view.child(slot, d, i);
      if (page != 0) {
        ASSERT_EQ(child / kEsvoPageSlots, page);
      }
      page = child / kEsvoPageSlots;
      ASSERT_NE(child % kEsvoPageSlots, 0u) << "a page header";
      parent[child] = slot;
      open.push_back(child);
    }
  }
  for (std::uint64_t slot = 0; slot < view.slot_count; slot += 2)
    if (parent[slot] != ~std::uint64_t{0} && parent[slot + 1] != ~std::uint64_t{0}) {
      EXPECT_EQ(parent[slot], parent[slot + 1]);
    }
}

TEST(PackBlocks, EveryBlockEntryHasItsPlaceAndItsParent) {
  EsvoTree tree = random_tree({.levels = 6, .leaf_chance = 0.1}, 3);
  add_super_root(tree);
  const PackedBlocks packed = pack_blocks(tree, -1, {}, 0, {.max_slots = 300});
  const EsvoView view{packed.slots.data(), packed.slots.size(), packed.first_child, 6};
  ASSERT_GT(packed.blocks.size(), 4u);
  std::uint64_t end = 0, far_pointers = 0;
  for (const EsvoBlockEntry& block : packed.blocks) {
    EXPECT_EQ(block.begin, end);
    EXPECT_EQ(block.begin % kEsvoPageSlots, 0u);
    end += block.slots;
    const EsvoBlockInfo& info = view.info(block.begin);
    EXPECT_EQ(info.slots, block.slots);
    EXPECT_LE(info.descriptor_slots, 2048u);
    far_pointers += info.far_pointers;
    if (&block == &packed.blocks.back()) {
      EXPECT_EQ(block.parent, EsvoBlockEntry::kNoParent);
      EXPECT_EQ(block.begin + info.first_descriptor, view.root);
      continue;
    }
    const ChildDescriptor parent = view.descriptor(block.parent);
    EXPECT_TRUE(parent.is_far());
    EXPECT_EQ(view.first_child(block.parent, parent), block.begin + info.first_descriptor);
    // Walking down to the block's cell leads to its parent descriptor.
    std::uint64_t at = view.root;
    for (int level = 0; level < block.level; ++level) {
      const int shift = block.level - 1 - level;
      const int child = (block.cell.x >> shift & 1) | (block.cell.y >> shift & 1) << 1 |
                        (block.cell.z >> shift & 1) << 2;
      const ChildDescriptor d = view.descriptor(at);
      ASSERT_NE(d.inner_mask() >> child & 1, 0u);
      at = view.child(at, d, child);
    }
    EXPECT_EQ(at, block.parent);
  }
  EXPECT_EQ(end, packed.slots.size());
  EXPECT_EQ(far_pointers, packed.blocks.size() - 1) << "only between blocks";
}

TEST(PackBlocks, ABlockPackedEarlierIsReachedByAFarPointer) {
  // The root's child 5 is packed first, the root itself later.
  EsvoTree below = random_tree({.levels = 4}, 7);
  const PackedBlocks first = pack_blocks(below, 1, {1, 0, 1}, 0, {});
  EsvoTree above;
  above.nodes.resize(2);
  above.contours = below.contours;
  above.values = below.values;
  above.nodes[0].valid_mask = 1 << 5;
  above.nodes[0].first_child = 1;
  above.values.emplace_back();
  above.nodes[0].first_value = static_cast<std::uint32_t>(above.values.size() - 1);
  above.nodes[1] = below.nodes[0];
  above.nodes[1].is_packed = true;
  above.nodes[1].first_child = 0;
  above.packed = {first.first_child};
  add_super_root(above);
  const PackedBlocks second = pack_blocks(above, -1, {}, first.slots.size(), {});
  ASSERT_EQ(second.links.size(), 1u);
  EXPECT_EQ(second.links[0].child, first.first_child);

  Esvo esvo;
  esvo.levels = 5;
  esvo.slots = first.slots;
  esvo.slots.insert(esvo.slots.end(), second.slots.begin(), second.slots.end());
  esvo.root = first.slots.size() + second.first_child;
  const EsvoTree read = unpack(esvo.view());
  ASSERT_EQ(read.nodes.size(), below.nodes.size() + 1);
  EXPECT_EQ(read.nodes[0].valid_mask, 1 << 5);
  for (std::size_t i = 0; i < below.nodes.size(); ++i)
    EXPECT_EQ(read.nodes[i + 1].valid_mask, below.nodes[i].valid_mask);
}

TEST(PackBlocks, EveryVoxelHasItsOwnValueInTheAttachments) {
  // One colour for each block of values, so that the coding is lossless.
  EsvoTree tree = random_tree({.levels = 5}, 11);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const EsvoNode& n = tree.nodes[i];
    for (int k = 0; k < std::popcount(std::uint32_t{n.valid_mask}); ++k) {
      VoxelValue& value = tree.values[n.first_value + static_cast<std::uint32_t>(k)];
      value.color[0] = i % 2 != 0 ? 255 : 0;
      value.color[1] = value.color[2] = 0;
    }
  }
  const Esvo esvo = pack_octree(tree, 5);
  const EsvoView view = esvo.view();
  std::vector<std::uint64_t> slots{view.root};
  for (std::size_t at = 0; at < slots.size(); ++at) {
    const ChildDescriptor d = view.descriptor(slots[at]);
    for (int i = 0; i < 8; ++i) {
      if ((d.inner_mask() >> i & 1) != 0) slots.push_back(view.child(slots[at], d, i));
      if ((d.valid_mask() >> i & 1) == 0) continue;
      const ColorBlock block{*view.attachment(slots[at], EsvoAttachmentKind::kColors)};
      EXPECT_EQ(block.color(attachment_value({slots[at], i})).x, at % 2 != 0 ? 1.0f : 0.0f);
    }
  }
}

}  // namespace
}  // namespace voxdag
