#include <gtest/gtest.h>

#include <cmath>

#include "edit/edit_model.hpp"
#include "edit/shape_oracle.hpp"
#include "voxdag/edit/shapes.hpp"

namespace voxdag {
namespace {

TEST(EditShapes, RefuseWhatIsNoShape) {
  const Grid grid{.levels = 4};
  EXPECT_THROW(make_ball(grid, {0, 0, 0}, -1), Error);
  EXPECT_THROW(make_ball(grid, {0, 0, HUGE_VAL}, 1), Error);
  EXPECT_THROW(make_ball(grid, {1e9, 0, 0}, 1), Error);
  EXPECT_THROW(make_capsule(grid, {0, 0, 0}, {0, 0, NAN}, 1), Error);
  EXPECT_THROW(make_half_space(grid, {0, 0, 0}, {0, 0, 0}), Error);
}

TEST(EditShapes, PlaceCellsAsTheirVoxelsAre) {
  RandomEdits random(6, 9);
  for (int i = 0; i < 3000; ++i) {
    const EditShape shape = random.shape();
    const int bits = random.below(4);
    const int cells = 64 >> bits;
    const Vec3i origin =
        Vec3i{random.below(cells), random.below(cells), random.below(cells)} * (1 << bits);
    int inside = 0;
    const int side = 1 << bits;
    for (int v = 0; v < side * side * side; ++v)
      inside +=
          oracle_has(shape, origin + Vec3i{v % side, v / side % side, v / side / side}) ? 1 : 0;
    const CellPlace place =
        std::visit([&](const auto& of) { return of.place(origin, bits); }, shape);
    if (place == CellPlace::kInside) {
      ASSERT_EQ(inside, side * side * side);
    }
    if (place == CellPlace::kOutside) {
      ASSERT_EQ(inside, 0);
    }
    if (bits != 2) continue;
    const std::uint64_t block = std::visit([&](const auto& of) { return of.block(origin); }, shape);
    for (int v = 0; v < 64; ++v)
      ASSERT_EQ((block >> v & 1) != 0,
                oracle_has(shape, origin + morton_decode(static_cast<std::uint64_t>(v))));
  }
}

}  // namespace
}  // namespace voxdag
