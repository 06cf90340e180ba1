#pragma once
/// The surroundings of a mask in a unit: the context in which the mask is coded.
///
/// A unit is a cube of 16³ voxels. It consists of 2³ bricks of 8³ voxels, 4³ leaves of 4³ and 8³
/// cells of 2³. Each of them has a mask of eight bits, one bit for each octant. The masks of all
/// bricks come first. Then come, for one inline brick after the other, the masks of its leaves and
/// the masks of its cells, both in Morton order. A mask counts as zero until it is read, outside
/// the unit, and for leaves and cells of shared bricks. The features of a mask are those of its
/// neighbours of the same size, at the distances (dx, dy, dz):
///
///   bits 0..23    the masks of (-1,0,0), (0,-1,0) and (0,0,-1), eight bits each
///   bits 24..47   the masks of (-1,-1,0), (-1,0,-1) and (0,-1,-1)
///   bits 48..49   bits 2 and 6 of the mask of (1,-1,0), the edge at this cell
///   bits 50..51   bits 4 and 6 of the mask of (1,0,-1), the edge at this cell
///   bits 52..63   whether these neighbours are present, by the masks that were read:
///                 (1,0,0) (0,1,0) (0,0,1) (1,-1,0) (1,0,-1) (-1,1,0)
///                 (0,1,-1) (-1,0,1) (0,-1,1) (1,1,0) (1,0,1) (0,1,1)
#include <cstdint>

#include "voxdag/core/host_device.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {

/// The masks of the N³ cells of one size, with a border of zeros.
template <int N>
class CellMasks {
 public:
  /// Marks the cells of the 2³ group at (2x, 2y, 2z) that are in `mask` as present.
  VOXDAG_HD void set_present(int x, int y, int z, std::uint32_t mask) {
    std::uint16_t* row = rows_ + row_index(2 * y, 2 * z);
    const int shift = 2 * x + 1;
    row[0] = static_cast<std::uint16_t>(row[0] | (mask & 3u) << shift);
    row[1] = static_cast<std::uint16_t>(row[1] | (mask >> 2 & 3u) << shift);
    row[kSide] = static_cast<std::uint16_t>(row[kSide] | (mask >> 4 & 3u) << shift);
    row[kSide + 1] = static_cast<std::uint16_t>(row[kSide + 1] | (mask >> 6 & 3u) << shift);
  }
  VOXDAG_HD void set(int x, int y, int z, std::uint32_t mask) {
    masks_[row_index(y, z) * kSide + x + 1] = static_cast<std::uint8_t>(mask);
  }

  VOXDAG_HD std::uint64_t features(int x, int y, int z) const {
    const int at = row_index(y, z);
    const std::uint8_t* mask = masks_ + at * kSide + x + 1;
    constexpr int kY = kSide, kZ = kSide * kSide;
    const auto byte = [&](int offset, int shift) {
      return static_cast<std::uint64_t>(mask[offset]) << shift;
    };
    const auto bits = [](std::uint32_t value, int from, int to, int shift) {
      return static_cast<std::uint64_t>((value >> from & 1u) | (value >> to & 1u) << 1) << shift;
    };
    // Three bits of a row: of the cells at x-1, x and x+1.
    const auto row = [&](int dy, int dz) {
      return static_cast<std::uint32_t>(rows_[at + dy + dz * kSide]) >> x & 7u;
    };
    const auto present = [](std::uint32_t three, int dx, int shift) {
      return static_cast<std::uint64_t>(three >> (dx + 1) & 1u) << shift;
    };
    const std::uint32_t here = row(0, 0), low_y = row(-1, 0), low_z = row(0, -1),
                        high_y = row(1, 0), high_z = row(0, 1);
    return byte(-1, 0) | byte(-kY, 8) | byte(-kZ, 16) | byte(-1 - kY, 24) | byte(-1 - kZ, 32) |
           byte(-kY - kZ, 40) | bits(mask[1 - kY], 2, 6, 48) | bits(mask[1 - kZ], 4, 6, 50) |
           present(here, 1, 52) | present(high_y, 0, 53) | present(high_z, 0, 54) |
           present(low_y, 1, 55) | present(low_z, 1, 56) | present(high_y, -1, 57) |
           present(row(1, -1), 0, 58) | present(high_z, -1, 59) | present(row(-1, 1), 0, 60) |
           present(high_y, 1, 61) | present(high_z, 1, 62) | present(row(1, 1), 0, 63);
  }

 private:
  static constexpr int kSide = N + 2;
  VOXDAG_HD static constexpr int row_index(int y, int z) { return (z + 1) * kSide + y + 1; }

  std::uint8_t masks_[kSide * kSide * kSide] = {};
  std::uint16_t rows_[kSide * kSide] = {};  ///< Bit x + 1: present.
};

/// Visits the masks of a unit in the order of the stream. The coders read or write a mask: a writer
/// finds it in the argument, a reader sets it there.
class UnitCells {
 public:
  /// Starts a unit. `children` is the mask of its bricks.
  VOXDAG_HD explicit UnitCells(std::uint32_t children) { bricks_.set_present(0, 0, 0, children); }

  /// Returns the features of the mask of the brick in octant `brick`.
  VOXDAG_HD std::uint64_t brick_features(int brick) const {
    const Vec3i b = child_offset(brick);
    return bricks_.features(b.x, b.y, b.z);
  }
  VOXDAG_HD void set_brick(int brick, std::uint32_t mask) {
    const Vec3i b = child_offset(brick);
    bricks_.set(b.x, b.y, b.z, mask);
    leaves_.set_present(b.x, b.y, b.z, mask);
  }

  /// Visits the masks of the leaves, then of the cells, of the brick in octant `brick`, which has
  /// the mask `brick_mask`. Calls code_leaf(features, mask) and code_cell(features, mask). `leaves`
  /// has the 64-bit masks of the eight leaves; a reader passes zeros. Stops at a mask that is zero,
  /// which only a broken stream has, and returns false.
  template <class CodeLeaf, class CodeCell>
  VOXDAG_HD bool visit_brick(int brick, std::uint32_t brick_mask, std::uint64_t (&leaves)[8],
                             const CodeLeaf& code_leaf, const CodeCell& code_cell) {
    const Vec3i b = child_offset(brick);
    std::uint32_t leaf_masks[8];
    for (int q = 0; q < 8; ++q) {
      leaf_masks[q] = 0;
      if ((brick_mask >> q & 1u) == 0) continue;
      const Vec3i l = b * 2 + child_offset(q);
      leaf_masks[q] = child_mask_of(leaves[q]);
      code_leaf(leaves_.features(l.x, l.y, l.z), leaf_masks[q]);
      if (leaf_masks[q] == 0) return false;
      leaves_.set(l.x, l.y, l.z, leaf_masks[q]);
      cells_.set_present(l.x, l.y, l.z, leaf_masks[q]);
    }
    for (int q = 0; q < 8; ++q) {
      const std::uint64_t before = leaves[q];
      leaves[q] = 0;
      const Vec3i corner = b * 4 + child_offset(q) * 2;
      for (int c = 0; c < 8; ++c) {
        if ((leaf_masks[q] >> c & 1u) == 0) continue;
        const Vec3i p = corner + child_offset(c);
        auto cell = static_cast<std::uint32_t>(before >> (8 * c) & 0xFFu);
        code_cell(cells_.features(p.x, p.y, p.z), cell);
        if (cell == 0) return false;
        cells_.set(p.x, p.y, p.z, cell);
        leaves[q] |= static_cast<std::uint64_t>(cell) << (8 * c);
      }
    }
    return true;
  }

 private:
  VOXDAG_HD static std::uint32_t child_mask_of(std::uint64_t leaf) {
    std::uint32_t mask = 0;
    for (int i = 0; i < 8; ++i) mask |= (leaf >> (8 * i) & 0xFFu) != 0 ? 1u << i : 0u;
    return mask;
  }

  CellMasks<2> bricks_;
  CellMasks<4> leaves_;
  CellMasks<8> cells_;
};

}  // namespace voxdag
