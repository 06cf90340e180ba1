#pragma once
/// Coordinates of the voxels of a leaf block, along one axis.
namespace voxdag {

/// Returns the coordinate, 0 to 3, of bit `voxel` of a leaf block.
constexpr int leaf_coordinate(int voxel, int axis) {
  return (voxel >> (3 + axis) & 1) << 1 | (voxel >> axis & 1);
}
/// Returns the bits that a coordinate, 0 to 3, sets in the number of a voxel.
constexpr int leaf_bits(int coordinate, int axis) {
  return (coordinate >> 1) << (3 + axis) | (coordinate & 1) << axis;
}

}  // namespace voxdag
