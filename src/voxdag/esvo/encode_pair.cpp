#include "voxdag/esvo/encode_pair.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "voxdag/esvo/encode_color_block.hpp"
#include "voxdag/layout/normal_block.hpp"

namespace voxdag {

void encode_pair_colors(const PairValues& values, std::uint64_t* block) {
  std::array<Vec3f, kValuesPerBlock> colors;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const std::uint8_t* rgb = values.values[i].color;
    colors[i] =
        Vec3f{static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2])} *
        (1.0f / 255.0f);
  }
  *block = encode_color_block(colors, values.mask).bits;
}

void encode_pair_normals(const PairValues& values, std::uint64_t* block) {
  Vec3f sum{};
  for (int i = 0; i < 16; ++i)
    if ((values.mask >> i & 1) != 0) sum = sum + values.values[i].normal;
  Vec3f size{std::fabs(sum.x), std::fabs(sum.y), std::fabs(sum.z)};
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  if (!(size[axis] > 0)) sum[axis] = size[axis] = 1;
  const Vec3f p = sum * (1 / size[axis]);
  CubePoint base;
  base.face = 2 * axis + (p[axis] < 0 ? 1 : 0);
  base.u = static_cast<int>(std::lround(p[(axis + 1) % 3] * 16383.0f)) + 16384;
  base.v = static_cast<int>(std::lround(p[(axis + 2) % 3] * 8191.0f)) + 8192;
  const NormalBlock result = NormalBlock::pack(base, {}, {}, 0, 0);
  std::memcpy(block, result.words, sizeof result.words);
}

}  // namespace voxdag
