#pragma once
/// Sums the extinction and the colours of splats in a cube of voxels.
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "voxdag/builders/splats/splat.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Sums of whole numbers, so that they do not depend on the order of the splats. A voxel takes
/// 2^25 splats; then sums may overflow.
class SplatBrick {
 public:
  static constexpr std::int32_t kSide = 32;

  /// A voxel is set if its sum is at least `least`, 1 or more.
  SplatBrick(std::uint64_t least, bool has_colors)
      : least_(least), sums_(kVoxels + 8), colors_(has_colors ? 4 * kVoxels + 8 : 0) {}

  /// Empties the brick, and moves its first voxel to `first`.
  void start(Vec3i first) {
    first_ = first;
    touched_.fill(0);
  }
  /// Adds the splat to the voxels that it reaches. The arithmetic is the same on every machine.
  void add(const GridSplat& splat);

  /// Calls on_block(first, voxels) for the leaf blocks that have voxels which are set, in Morton
  /// order. `first` is the block's first voxel in the grid.
  template <class OnBlock>
  void each_block(const OnBlock& on_block) const;

  /// Returns the mean colour of a voxel that has a sum, in linear light, rounded.
  std::array<std::uint16_t, 3> mean_color(Vec3i voxel) const {
    const Vec3i at = voxel - first_;
    const std::uint64_t* const sums = &colors_[4 * place({0, at.y, at.z}) + at.x];
    const std::uint64_t weight = sums[0];
    const auto mean = [&](int channel) {
      return static_cast<std::uint16_t>((sums[channel * kSide] + weight / 2) / weight);
    };
    return {mean(1), mean(2), mean(3)};
  }

 private:
  static constexpr std::size_t kVoxels = std::size_t{kSide} * kSide * kSide;

  static std::size_t place(Vec3i v) {
    return static_cast<std::size_t>((v.z * kSide + v.y) * kSide + v.x);
  }

  std::uint64_t least_;
  Vec3i first_{};
  std::array<std::uint32_t, kSide> touched_{};  ///< Bit y of item z: the row has sums.
  /// The voxels of row y + 32 z that are set; of rows that are not touched: any.
  std::array<std::uint32_t, std::size_t{kSide} * kSide> set_{};
  std::vector<std::uint64_t> sums_;  ///< Of rows that are not touched: any.
  /// For each row: the weights of its voxels, which are the extinctions in units of 2^-20, each
  /// rounded up; then the weighted sums of red, of green and of blue.
  std::vector<std::uint64_t> colors_;
};

template <class OnBlock>
void SplatBrick::each_block(const OnBlock& on_block) const {
  std::array<std::uint64_t, kVoxels / 64> blocks{};
  for (std::int32_t z = 0; z < kSide; ++z)
    for (std::uint32_t left = touched_[static_cast<std::size_t>(z)]; left != 0; left &= left - 1) {
      const int y = std::countr_zero(left);
      std::uint32_t row = set_[static_cast<std::size_t>(z * kSide + y)];
      while (row != 0) {
        const int x = std::countr_zero(row) & ~3;
        const std::uint64_t four = row >> x & 15;
        row &= ~(15u << x);
        blocks[static_cast<std::size_t>(morton_encode({x / 4, y / 4, z / 4}))] |=
            ((four & 3) | (four & 12) << 6) << (leaf_bits(y & 3, 1) | leaf_bits(z & 3, 2));
      }
    }
  for (std::size_t code = 0; code < blocks.size(); ++code)
    if (blocks[code] != 0) on_block(first_ + morton_decode(code) * 4, blocks[code]);
}

}  // namespace voxdag
