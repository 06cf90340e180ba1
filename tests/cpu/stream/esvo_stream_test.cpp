#include "voxdag/cpu/stream/esvo_stream.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/esvo_bytes.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

using test::packed_esvo;
using test::PackedEsvo;
using test::unpack;

bool same(const EsvoTree& a, const EsvoTree& b) {
  if (a.nodes.size() != b.nodes.size() || a.contours != b.contours) return false;
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    if (a.nodes[i].valid_mask != b.nodes[i].valid_mask ||
        a.nodes[i].leaf_mask != b.nodes[i].leaf_mask ||
        a.nodes[i].contour_mask != b.nodes[i].contour_mask)
      return false;
  return true;
}

class EsvoStreamTest : public testing::Test {
 protected:
  EsvoStreamTest() { write_esvo(path(), esvo); }
  std::filesystem::path path() const { return dir / "a.esvo"; }
  std::uint64_t bytes() const { return esvo.packed.slots.size() * 8; }

  TempDir dir;
  PackedEsvo esvo = packed_esvo(7, 120, 3);
};

TEST_F(EsvoStreamTest, IsTheWholeOctreeAfterLoadingAllBlocksInAnyOrder) {
  std::mt19937 random(1);
  for (int run = 0; run < 5; ++run) {
    EsvoStream stream(path(), bytes());
    ASSERT_GT(stream.directory().size(), 20u);
    EXPECT_FALSE(same(unpack(stream.view()), unpack(esvo.view())));
    while (stream.counts().blocks_loaded < stream.directory().size()) {
      const std::size_t block = random() % stream.directory().size();
      if (stream.is_loaded(block) || !stream.can_load(block)) continue;
      ASSERT_TRUE(stream.has_room(block));
      stream.load(block);
    }
    EXPECT_TRUE(same(unpack(stream.view()), unpack(esvo.view())));
    EXPECT_EQ(stream.counts().bytes_loaded, bytes());
  }
}

TEST_F(EsvoStreamTest, WithLessMemoryBlocksAreLoadedAndEvicted) {
  std::mt19937 random(2);
  const std::uint64_t memory = bytes() / 3;
  EsvoStream stream(path(), memory);
  for (int step = 0; step < 2000; ++step) {
    const std::size_t block = random() % stream.directory().size();
    if (stream.can_evict(block) && random() % 2 == 0)
      stream.evict(block);
    else if (!stream.is_loaded(block) && stream.can_load(block) && stream.has_room(block))
      stream.load(block);
    EXPECT_LE(stream.counts().bytes_loaded, memory);
    if (step % 100 != 0) continue;
    // The loaded octree is complete, and not finer than the octree in the file.
    const EsvoTree tree = unpack(stream.view());
    EXPECT_LE(tree.nodes.size(), unpack(esvo.view()).nodes.size());
  }
  EXPECT_GT(stream.counts().blocks_evicted, 100u);
}

TEST_F(EsvoStreamTest, ACopyThatTakesTheChangesIsTheLoadedOctree) {
  std::mt19937 random(3);
  EsvoStream stream(path(), bytes() / 3);
  std::vector<std::uint64_t> slots(stream.view().slot_count, ~std::uint64_t{0});
  std::vector<std::uint32_t> cut(slots.size() / 32, ~std::uint32_t{0});
  std::uint64_t version = 0;
  for (int step = 0; step < 2000; ++step) {
    const std::size_t block = random() % stream.directory().size();
    const std::uint64_t before = stream.version();
    if (stream.can_evict(block) && random() % 2 == 0)
      stream.evict(block);
    else if (!stream.is_loaded(block) && stream.can_load(block) && stream.has_room(block))
      stream.load(block);
    else
      continue;
    EXPECT_GT(stream.version(), before);
    if (random() % 8 != 0) continue;
    const PartialEsvoView loaded = stream.loaded();
    for (const SlotRange& range : stream.changes_since(version)) {
      std::copy_n(loaded.octree.slots + range.begin, range.count,
                  slots.begin() + static_cast<std::ptrdiff_t>(range.begin));
      std::copy_n(loaded.cut + range.begin / 32, range.count / 32,
                  cut.begin() + static_cast<std::ptrdiff_t>(range.begin / 32));
    }
    version = stream.version();
    EXPECT_TRUE(stream.changes_since(version).empty());
    PartialEsvoView copy = loaded;
    copy.octree.slots = slots.data();
    copy.cut = cut.data();
    ASSERT_TRUE(same(unpack(copy.octree), unpack(loaded.octree))) << "step " << step;
    std::vector<std::uint64_t> open{copy.octree.root};
    while (!open.empty()) {
      const std::uint64_t slot = open.back();
      open.pop_back();
      ASSERT_EQ(copy.missing_block(slot), loaded.missing_block(slot)) << "step " << step;
      const ChildDescriptor d = copy.octree.descriptor(slot);
      for (int i = 0; i < 8; ++i)
        if ((d.inner_mask() >> i & 1) != 0) open.push_back(copy.octree.child(slot, d, i));
    }
  }
}

TEST_F(EsvoStreamTest, WhereABlockIsMissingTheVoxelsAboveItAreLeaves) {
  EsvoStream stream(path(), bytes());
  std::size_t missing = 0;
  std::vector<std::uint64_t> open{stream.view().root};
  while (!open.empty()) {
    const EsvoView view = stream.view();
    const std::uint64_t slot = open.back();
    open.pop_back();
    const ChildDescriptor d = view.descriptor(slot);
    const std::int64_t block = stream.loaded().missing_block(slot);
    if (block >= 0) {
      EXPECT_EQ(d.leaf_mask(), d.valid_mask());
      EXPECT_FALSE(stream.is_loaded(static_cast<std::size_t>(block)));
      EXPECT_TRUE(stream.can_load(static_cast<std::size_t>(block)));
      ++missing;
    }
    for (int i = 0; i < 8; ++i)
      if ((d.inner_mask() >> i & 1) != 0) open.push_back(view.child(slot, d, i));
  }
  EXPECT_GT(missing, 0u);
}

TEST_F(EsvoStreamTest, TooLittleMemoryForTheRootIsRefused) {
  EXPECT_THROW(EsvoStream(path(), 1000), Error);
}

TEST_F(EsvoStreamTest, ADamagedBlockIsNamedWhenItIsLoaded) {
  std::string text = read_text(path());
  // Damages the first block, which is not the root's.
  text[256 + 4000] = static_cast<char>(text[256 + 4000] ^ 1);
  write_text(path(), text);
  EsvoStream stream(path(), bytes());
  EXPECT_THROW(
      {
        for (int round = 0; round < 50; ++round)
          for (std::size_t i = 0; i < stream.directory().size(); ++i)
            if (!stream.is_loaded(i) && stream.can_load(i)) stream.load(i);
      },
      Error);
}

}  // namespace
}  // namespace voxdag
