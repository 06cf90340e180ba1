#include "voxdag/stored/attributes/material_ids.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/damaged_pages.hpp"
#include "support/error_of.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"
#include "voxdag/stored/attributes/validate_pages.hpp"

namespace voxdag {
namespace {

MaterialIds encoded(const std::vector<std::uint32_t>& ids, std::uint32_t materials) {
  MaterialEncoder encoder(materials);
  for (const std::uint32_t id : ids) encoder.add(id, 1);
  return encoder.finish();
}

/// Returns ids in runs of random lengths up to `longest`.
std::vector<std::uint32_t> random_runs(std::size_t count, std::uint32_t materials,
                                       std::uint32_t longest) {
  std::mt19937 rng(materials + longest);
  std::vector<std::uint32_t> ids;
  while (ids.size() < count) {
    const auto id = static_cast<std::uint32_t>(rng() % materials);
    for (std::uint32_t left = 1 + static_cast<std::uint32_t>(rng() % longest);
         left > 0 && ids.size() < count; --left)
      ids.push_back(id);
  }
  return ids;
}

TEST(MaterialIds, EveryIdIsReadBack) {
  for (const std::uint32_t materials : {1u, 2u, 3u, 256u, 257u, 65535u})
    for (const std::uint32_t longest : {1u, 5u, 300u, 100000u})
      for (const std::size_t count : {1u, 255u, 256u, 257u, 40000u}) {
        const std::vector<std::uint32_t> ids = random_runs(count, materials, longest);
        const MaterialIds packed = encoded(ids, materials);
        ASSERT_NO_THROW(validate_material_ids(packed.view()));
        ASSERT_EQ(packed.values, count);
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(read_material(packed.view(), i), ids[i]);
      }
}

/// The example of docs/format.md.
TEST(MaterialIds, ThreeCellsOfMaterialFourAndOneOfMaterialTwo) {
  const MaterialIds packed = encoded({4, 4, 4, 2}, 5);
  EXPECT_EQ(packed.words, (std::vector<std::uint64_t>{0xA94}));
  EXPECT_EQ(packed.groups, (std::vector<std::uint64_t>{0}));
  EXPECT_EQ(packed.pages, (std::vector<std::uint16_t>{0}));
}

TEST(MaterialIds, ManyCellsOfOneMaterialTakeAByteAndTheirTablesPerPage) {
  MaterialEncoder encoder(100);
  encoder.add(42, 256 * 640);
  const MaterialIds packed = encoder.finish();
  EXPECT_EQ(packed.view().bytes(), 640u + 640 * 2 + 10 * 8);
}

TEST(MaterialIds, TheCallsDoNotMatter) {
  MaterialEncoder encoder(3);
  encoder.add(2, 700);
  encoder.add(1, 100);
  const MaterialIds once = encoder.finish();
  std::vector<std::uint32_t> ids(800, 2);
  std::fill(ids.begin() + 700, ids.end(), 1);
  EXPECT_EQ(once.words, encoded(ids, 3).words);
}

/// A flipped bit is refused, or gives other ids whose bits are exactly the changed ones.
TEST(MaterialIds, EveryFlippedBitIsRefusedOrGivesOtherIds) {
  const MaterialIds packed = encoded(random_runs(700, 5, 40), 5);
  int accepted = 0;
  const int refused =
      refused_bit_flips(packed, validate_material_ids, [&](const MaterialIds& changed, auto bit) {
        ++accepted;
        std::vector<std::uint32_t> ids;
        for (std::uint64_t i = 0; i < changed.values; ++i)
          ids.push_back(read_material(changed.view(), i));
        ASSERT_EQ(encoded(ids, 5).words, changed.words) << "bit " << bit;
      });
  EXPECT_GT(refused, 0);
  EXPECT_GT(accepted, 0);
}

TEST(MaterialIds, ABrokenTableIsRefused) {
  MaterialIds packed = encoded(random_runs(70000, 5, 9), 5);
  packed.pages[3] ^= 1;
  EXPECT_EQ(error_of([&] { validate_material_ids(packed.view()); }),
            "page 3: does not begin where the page before it ends");
  packed.pages[3] ^= 1;
  packed.groups[4] = ~std::uint64_t{0};
  EXPECT_EQ(error_of([&] { validate_material_ids(packed.view()); }),
            "page 256: does not begin where the page before it ends");
}

}  // namespace
}  // namespace voxdag
