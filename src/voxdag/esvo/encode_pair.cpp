#include "voxdag/esvo/encode_pair.hpp"

#include <array>
#include <cstring>

#include "voxdag/esvo/encode_color_block.hpp"
#include "voxdag/esvo/encode_normal_block.hpp"

namespace voxdag {

void encode_pair_colors(const PairValues& values, std::uint64_t* block) {
  std::array<Vec3f, kValuesPerBlock> colors;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const std::uint8_t* rgb = values.values[i].color;
    colors[i] =
        Vec3f{static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])} *
        (1.0f / 255.0f);
  }
  *block = encode_color_block(colors, values.mask, values.weights).bits;
}

void encode_pair_normals(const PairValues& values, std::uint64_t* block) {
  std::array<Vec3f, kValuesPerBlock> normals;
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = values.values[i].normal;
  const NormalBlock encoded = encode_normal_block(normals, values.mask, values.weights);
  std::memcpy(block, encoded.words, sizeof encoded.words);
}

}  // namespace voxdag
