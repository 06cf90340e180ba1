#include "voxdag/builders/esvo/encode/encode_pair.hpp"

#include <array>
#include <cstring>

#include "voxdag/builders/esvo/encode/encode_color_block.hpp"
#include "voxdag/builders/esvo/encode/encode_normal_block.hpp"

namespace voxdag {
namespace {

/// The weight of a leaf relative to an inner voxel. Leaves may be large and near the viewer; inner
/// voxels are visible only if they are smaller than a pixel. On a flat wall, an error of a degree
/// in a leaf's normal is visible next to other leaves.
constexpr float kColorOfLeaf = 16, kNormalOfLeaf = 256;

std::array<float, kValuesPerBlock> weights_of(const PairValues& values, float leaf) {
  std::array<float, kValuesPerBlock> weights;
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] = (values.leaves >> i & 1u) != 0 ? leaf : 1.0f;
  return weights;
}

}  // namespace

void encode_pair_colors(const PairValues& values, std::uint64_t* block) {
  std::array<Vec3f, kValuesPerBlock> colors;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const std::uint8_t* rgb = values.values[i].color;
    colors[i] =
        Vec3f{static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])} *
        (1.0f / 255.0f);
  }
  *block = encode_color_block(colors, values.mask, weights_of(values, kColorOfLeaf).data()).bits;
}

void encode_pair_normals(const PairValues& values, std::uint64_t* block) {
  std::array<Vec3f, kValuesPerBlock> normals;
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = values.values[i].normal;
  const NormalBlock encoded =
      encode_normal_block(normals, values.mask, weights_of(values, kNormalOfLeaf).data());
  std::memcpy(block, encoded.words, sizeof encoded.words);
}

}  // namespace voxdag
