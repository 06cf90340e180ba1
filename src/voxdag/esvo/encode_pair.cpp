#include "voxdag/esvo/encode_pair.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "voxdag/layout/color_block.hpp"
#include "voxdag/layout/normal_block.hpp"

namespace voxdag {

void encode_pair_colors(const PairValues& values, std::uint64_t* block) {
  const auto brightness = [](const VoxelValue& v) { return v.color[0] + v.color[1] + v.color[2]; };
  const VoxelValue *lo = nullptr, *hi = nullptr;
  for (int i = 0; i < 16; ++i) {
    if ((values.mask >> i & 1) == 0) continue;
    const VoxelValue& v = values.values[i];
    if (lo == nullptr || brightness(v) < brightness(*lo)) lo = &v;
    if (hi == nullptr || brightness(v) > brightness(*hi)) hi = &v;
  }
  const auto round565 = [](const VoxelValue& v) {
    return Rgb565{(v.color[0] * 31 + 127) / 255, (v.color[1] * 63 + 127) / 255,
                  (v.color[2] * 31 + 127) / 255};
  };
  std::uint32_t selectors = 0;
  ColorBlock ends = ColorBlock::pack(round565(*lo), round565(*hi), 0xE4E4E4E4u);
  for (int i = 0; i < 16; ++i) {
    if ((values.mask >> i & 1) == 0) continue;
    float best = HUGE_VALF;
    std::uint32_t choice = 0;
    for (std::uint32_t s = 0; s < 4; ++s) {
      const Vec3f c = ends.color(static_cast<int>(s)) * 255.0f;
      const Vec3f d{c.x - values.values[i].color[0], c.y - values.values[i].color[1],
                    c.z - values.values[i].color[2]};
      if (dot(d, d) < best) best = dot(d, d), choice = s;
    }
    selectors |= choice << (2 * i);
  }
  *block = ColorBlock::pack(round565(*lo), round565(*hi), selectors).bits;
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
