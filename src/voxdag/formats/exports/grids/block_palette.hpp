#pragma once
/// The blocks of Minecraft that stand for colours.
#include <cstdint>

#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

struct ColoredBlock {
  const char* name;
  Value8 color;  ///< The mean of its texture, sRGB encoded.
};

inline constexpr ColoredBlock kColoredBlocks[] = {{"white_concrete", {207, 213, 214}},
                                                  {"orange_concrete", {224, 97, 1}},
                                                  {"magenta_concrete", {169, 48, 159}},
                                                  {"light_blue_concrete", {36, 137, 199}},
                                                  {"yellow_concrete", {241, 175, 21}},
                                                  {"lime_concrete", {94, 169, 24}},
                                                  {"pink_concrete", {214, 101, 143}},
                                                  {"gray_concrete", {55, 58, 62}},
                                                  {"light_gray_concrete", {125, 125, 115}},
                                                  {"cyan_concrete", {21, 119, 136}},
                                                  {"purple_concrete", {100, 32, 156}},
                                                  {"blue_concrete", {45, 47, 143}},
                                                  {"brown_concrete", {96, 60, 32}},
                                                  {"green_concrete", {73, 91, 36}},
                                                  {"red_concrete", {142, 33, 33}},
                                                  {"black_concrete", {8, 10, 15}},
                                                  {"terracotta", {152, 94, 68}},
                                                  {"white_terracotta", {210, 178, 161}},
                                                  {"orange_terracotta", {162, 84, 38}},
                                                  {"magenta_terracotta", {150, 88, 109}},
                                                  {"light_blue_terracotta", {113, 109, 138}},
                                                  {"yellow_terracotta", {186, 133, 35}},
                                                  {"lime_terracotta", {104, 118, 53}},
                                                  {"pink_terracotta", {162, 78, 79}},
                                                  {"gray_terracotta", {58, 42, 36}},
                                                  {"light_gray_terracotta", {135, 107, 98}},
                                                  {"cyan_terracotta", {87, 91, 91}},
                                                  {"purple_terracotta", {118, 70, 86}},
                                                  {"blue_terracotta", {74, 60, 91}},
                                                  {"brown_terracotta", {77, 51, 36}},
                                                  {"green_terracotta", {76, 83, 42}},
                                                  {"red_terracotta", {143, 61, 47}},
                                                  {"black_terracotta", {37, 23, 16}}};

inline std::int32_t distance2(Value8 a, Value8 b) {
  const std::int32_t x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  return x * x + y * y + z * z;
}

/// Returns the index in kColoredBlocks of the block with the nearest colour; the first of equals.
inline int nearest_block(Value8 color) {
  int nearest = 0, index = 0;
  for (const ColoredBlock& block : kColoredBlocks) {
    if (distance2(block.color, color) < distance2(kColoredBlocks[nearest].color, color))
      nearest = index;
    ++index;
  }
  return nearest;
}

}  // namespace voxdag
