#pragma once
/// The 48 symmetries of a cube, applied to octants, leaf blocks and points.
#include <array>
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag::lab {

/// A symmetry s permutes the axes, then mirrors them: axis a of the image is axis
/// kAxisOrders[s / 8][a] of the original, and it is mirrored if bit a of s is set. The first 8 are
/// the mirrors; 0 is the identity.
inline constexpr int kSymmetries = 48;
inline constexpr int kMirrors = 8;
inline constexpr std::array<std::array<int, 3>, 6> kAxisOrders{
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

/// Returns the octant of the image in which octant `octant` of the original lies.
constexpr int image_of_octant(int symmetry, int octant) {
  int image = 0;
  for (int axis = 0; axis < 3; ++axis)
    image |= ((octant >> kAxisOrders[symmetry / 8][axis]) & 1) << axis;
  return image ^ (symmetry & 7);
}

/// Returns the voxel of the image of a cube of `size`³ voxels in which `voxel` of the original
/// lies.
constexpr Vec3i image_of_voxel(int symmetry, Vec3i voxel, int size) {
  Vec3i image{};
  for (int axis = 0; axis < 3; ++axis) {
    const int from = voxel[kAxisOrders[symmetry / 8][axis]];
    image[axis] = ((symmetry >> axis) & 1) != 0 ? size - 1 - from : from;
  }
  return image;
}

/// Returns the image of a vector, which no mirror moves.
constexpr Vec3i image_of_vector(int symmetry, Vec3i vector) {
  Vec3i image{};
  for (int axis = 0; axis < 3; ++axis) {
    const int from = vector[kAxisOrders[symmetry / 8][axis]];
    image[axis] = ((symmetry >> axis) & 1) != 0 ? -from : from;
  }
  return image;
}

/// The products and the inverses of all symmetries.
struct SymmetryGroup {
  /// octant[s][i] is image_of_octant(s, i).
  std::array<std::array<std::uint8_t, 8>, kSymmetries> octant{};
  /// product[s][t] applies t, then s.
  std::array<std::array<std::uint8_t, kSymmetries>, kSymmetries> product{};
  std::array<std::uint8_t, kSymmetries> inverse{};
};

const SymmetryGroup& symmetry_group();

/// Returns the image of a 2³ mask (bit i: octant i).
std::uint8_t image_of_mask(int symmetry, std::uint8_t mask);

/// Returns the image of a leaf block (stored/svdag/svdag.hpp).
std::uint64_t image_of_block(int symmetry, std::uint64_t block);

}  // namespace voxdag::lab
