// Cuts plain DAGs out of DAGs with long pointers.
#include "voxdag/algebra/long_source_dag.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include "support/long_form.hpp"
#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/algebra/crop.hpp"

namespace voxdag {
namespace {

TEST(LongSourceDag, CropsAndCoarsensAsThePlainDag) {
  for (int levels = 2; levels <= 7; ++levels) {
    const Svdag plain = brute_svdag(levels, random_voxels(levels, 900, 3));
    const LongForm form = long_form(plain);
    const std::int32_t side = 1 << levels;
    EXPECT_EQ(crop(form.view(), {{0, 0, 0}, {side, side, side}}), plain);
    const Box3i box{{1, 0, side / 3}, {side - 1, side / 2, side}};
    EXPECT_EQ(crop(form.view(), box), crop(plain.view(), box));
    for (int coarse = 2; coarse <= levels; ++coarse)
      EXPECT_EQ(coarsen(form.view(), coarse), coarsen(plain.view(), coarse));
  }
  EXPECT_TRUE(
      crop(long_form(brute_svdag(4, {})).view(), {{0, 0, 0}, {16, 16, 16}}).view().is_empty());
}

/// Address space whose pages the system makes when they are written.
class Pages {
 public:
  explicit Pages(std::size_t bytes)
      : bytes_(bytes),
        memory_(mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)) {}
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  ~Pages() {
    if (is_mapped()) munmap(memory_, bytes_);
  }
  bool is_mapped() const { return memory_ != MAP_FAILED; }
  template <class T>
  T* as() const {
    return static_cast<T*>(memory_);
  }

 private:
  std::size_t bytes_;
  void* memory_;
};

TEST(LongSourceDag, FollowsPointersBeyond32Bits) {
  // The root, then a level of 6 * 2^32 words with one node, and 3 * 2^32 blocks with one in use.
  constexpr std::uint64_t kLevelWords = std::uint64_t{6} << 32, kBlocks = std::uint64_t{3} << 32;
  const Pages words((3 + kLevelWords) * 4), blocks(kBlocks * 8);
  if (!words.is_mapped() || !blocks.is_mapped()) GTEST_SKIP() << "no address space of 125 GB";
  const std::uint64_t node = (std::uint64_t{5} << 32) + 9, block = (std::uint64_t{2} << 32) + 7;
  std::uint32_t* const nodes = words.as<std::uint32_t>();
  nodes[0] = 0b1000'0001 | upper_bits_of(node, 0) | upper_bits_of(node, 7);
  nodes[1] = nodes[2] = static_cast<std::uint32_t>(node);
  nodes[3 + node] = 0b10 | upper_bits_of(block, 1);
  nodes[3 + node + 1] = static_cast<std::uint32_t>(block);
  blocks.as<std::uint64_t>()[block] = 1;
  LongSvdagView view;
  view.nodes = nodes;
  view.leaf_blocks = blocks.as<std::uint64_t>();
  view.leaf_block_count = kBlocks;
  view.levels = 4;
  view.level_begin[1] = 3;
  std::fill(view.level_begin + 2, std::end(view.level_begin), 3 + kLevelWords);
  const Svdag expected = brute_svdag(4, {{4, 0, 0}, {12, 8, 8}});
  EXPECT_EQ(crop(view, {{0, 0, 0}, {16, 16, 16}}), expected);
  EXPECT_EQ(coarsen(view, 3), coarsen(expected.view(), 3));
}

}  // namespace
}  // namespace voxdag
