#include "voxdag/stored/esvo/validate_esvo.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/esvo_bytes.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/stored/esvo/color_block.hpp"
#include "voxdag/stored/esvo/esvo_bytes.hpp"

namespace voxdag {
namespace {

using test::packed_esvo;
using test::PackedEsvo;

/// Reads everything that a walk may read. Returns a value that depends on all of it.
std::uint64_t read_everything(const EsvoView& view) {
  std::uint64_t sum = 0;
  std::vector<std::uint64_t> open{view.root};
  while (!open.empty()) {
    const std::uint64_t slot = open.back();
    open.pop_back();
    const ChildDescriptor d = view.descriptor(slot);
    for (const EsvoAttachmentKind kind :
         {EsvoAttachmentKind::kColors, EsvoAttachmentKind::kNormals})
      if (const std::uint64_t* block = view.attachment(slot, kind)) sum += *block;
    for (int i = 0; i < 8; ++i) {
      if ((d.contour_mask() >> i & 1) != 0) sum += view.contour(slot, d, i).bits;
      if ((d.inner_mask() >> i & 1) != 0) open.push_back(view.child(slot, d, i));
    }
  }
  return sum;
}

TEST(ValidateEsvo, ValidOctreesPassWithTheirCounts) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const PackedEsvo esvo = packed_esvo(3 + static_cast<int>(seed % 4), 100, seed);
    EXPECT_EQ(validate_esvo(esvo.view(), esvo.packed.blocks), esvo.packed.counts);
    EXPECT_EQ(esvo_bytes(esvo.view(), esvo.packed.blocks).total(), esvo.packed.slots.size() * 8);
  }
  EXPECT_EQ(validate_esvo({}, {}), EsvoCounts{});
}

TEST(ValidateEsvo, AnAcceptedOctreeIsSafeToReadWithAnyBytes) {
  // Under AddressSanitizer this finds every read out of bounds.
  std::mt19937_64 random(1);
  std::vector<PackedEsvo> sound;
  for (std::uint32_t seed = 0; seed < 5; ++seed) sound.push_back(packed_esvo(4, 60, seed));
  int passed = 0, refused = 0;
  for (std::size_t run = 0; run < 3000; ++run) {
    PackedEsvo esvo = sound[run % 5];
    for (std::size_t change = 0; change < 1 + run % 3; ++change) {
      // Half of the changes are in descriptors, where they matter most.
      std::size_t slot = random() % esvo.packed.slots.size();
      if (random() % 2 == 0)
        slot = esvo.packed.blocks[random() % esvo.packed.blocks.size()].begin + random() % 100;
      if (random() % 2 == 0)
        esvo.packed.slots[slot] ^= std::uint64_t{1} << random() % 64;
      else
        esvo.packed.slots[slot] = random();
    }
    try {
      validate_esvo(esvo.view(), esvo.packed.blocks);
      read_everything(esvo.view());
      ++passed;
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(passed, 100) << "attributes and padding may be anything";
  EXPECT_GT(refused, 100);
}

TEST(ValidateEsvo, ADirectoryThatDoesNotFitIsRefused) {
  const PackedEsvo sound = packed_esvo(5, 60, 2);
  const auto refuses = [&](auto change) {
    PackedEsvo esvo = sound;
    change(esvo.packed.blocks);
    EXPECT_THROW(validate_esvo(esvo.view(), esvo.packed.blocks), Error);
  };
  using Blocks = std::vector<EsvoBlockEntry>;
  refuses([](Blocks& b) { b[1].begin += kEsvoPageSlots; });
  refuses([](Blocks& b) { b[0].slots += kEsvoPageSlots; });
  refuses([](Blocks& b) { b.pop_back(); });
  refuses([](Blocks& b) { b[0].parent += 1; });
  refuses([](Blocks& b) { b[0].level += 1; });
  refuses([](Blocks& b) { b[0].cell.x ^= 1; });
  refuses([](Blocks& b) { b.back().parent = 0; });
  refuses([](Blocks& b) { std::swap(b[0], b[1]); });
}

}  // namespace
}  // namespace voxdag
