#include "voxdag/formats/imports/volumes/block_color.hpp"

#include "voxdag/formats/exports/grids/block_palette.hpp"

namespace voxdag {
namespace {

struct BlockWord {
  std::string_view word;
  Rgb8 color;
};

/// Words of names, the first one that is found counts: leaves come before their tree.
constexpr BlockWord kBlockWords[] = {{"cherry_leaves", {229, 172, 194}},
                                     {"leaves", {60, 110, 40}},
                                     {"deepslate", {80, 80, 83}},
                                     {"blackstone", {42, 36, 41}},
                                     {"sandstone", {216, 203, 155}},
                                     {"end_stone", {219, 222, 158}},
                                     {"glowstone", {171, 131, 84}},
                                     {"dripstone", {134, 107, 92}},
                                     {"redstone", {175, 24, 5}},
                                     {"nether_brick", {44, 21, 26}},
                                     {"netherrack", {97, 38, 38}},
                                     {"mud_brick", {137, 104, 79}},
                                     {"stone_brick", {122, 121, 122}},
                                     {"brick", {150, 97, 83}},
                                     {"dark_oak", {66, 43, 20}},
                                     {"oak", {162, 130, 78}},
                                     {"spruce", {114, 84, 48}},
                                     {"birch", {192, 175, 121}},
                                     {"jungle", {160, 115, 80}},
                                     {"acacia", {168, 90, 50}},
                                     {"mangrove", {117, 54, 48}},
                                     {"cherry", {226, 178, 172}},
                                     {"bamboo", {193, 173, 80}},
                                     {"crimson", {101, 48, 70}},
                                     {"warped", {43, 104, 99}},
                                     {"soul_s", {81, 62, 51}},
                                     {"sand", {219, 207, 163}},
                                     {"gravel", {131, 127, 126}},
                                     {"podzol", {129, 86, 49}},
                                     {"mycelium", {111, 99, 101}},
                                     {"dirt", {134, 96, 67}},
                                     {"farmland", {134, 96, 67}},
                                     {"mud", {60, 57, 60}},
                                     {"clay", {160, 166, 179}},
                                     {"granite", {149, 103, 85}},
                                     {"diorite", {188, 188, 188}},
                                     {"andesite", {136, 136, 136}},
                                     {"tuff", {108, 109, 102}},
                                     {"calcite", {223, 224, 220}},
                                     {"basalt", {73, 72, 77}},
                                     {"obsidian", {15, 10, 24}},
                                     {"bedrock", {85, 85, 85}},
                                     {"quartz", {235, 229, 222}},
                                     {"prismarine", {99, 156, 151}},
                                     {"purpur", {169, 125, 169}},
                                     {"sea_lantern", {172, 199, 190}},
                                     {"gold", {246, 208, 61}},
                                     {"iron", {220, 220, 220}},
                                     {"diamond", {98, 237, 228}},
                                     {"emerald", {42, 203, 87}},
                                     {"lapis", {30, 67, 140}},
                                     {"copper", {192, 107, 79}},
                                     {"coal", {16, 15, 15}},
                                     {"amethyst", {133, 97, 191}},
                                     {"water", {64, 84, 200}},
                                     {"lava", {212, 90, 18}},
                                     {"ice", {145, 183, 253}},
                                     {"snow", {249, 254, 254}},
                                     {"glass", {175, 213, 219}},
                                     {"moss", {89, 109, 45}},
                                     {"grass", {127, 178, 56}},
                                     {"fern", {108, 141, 60}},
                                     {"vine", {73, 105, 37}},
                                     {"kelp", {87, 140, 44}},
                                     {"sapling", {78, 111, 42}},
                                     {"cactus", {85, 127, 43}},
                                     {"sugar_cane", {148, 192, 101}},
                                     {"lily_pad", {32, 128, 48}},
                                     {"melon", {111, 145, 30}},
                                     {"pumpkin", {198, 118, 24}},
                                     {"hay_block", {166, 136, 38}},
                                     {"bookshelf", {143, 119, 72}},
                                     {"chest", {143, 119, 72}},
                                     {"barrel", {143, 119, 72}},
                                     {"crafting", {143, 119, 72}},
                                     {"ladder", {143, 119, 72}},
                                     {"tnt", {142, 62, 53}},
                                     {"torch", {255, 216, 130}},
                                     {"lantern", {255, 216, 130}},
                                     {"mushroom", {204, 153, 120}},
                                     {"stone", {125, 125, 125}}};

constexpr Rgb8 kUnknownBlock{127, 127, 127};

Rgb8 rgb8_of(Value8 color) { return {color.x, color.y, color.z}; }

/// Returns the name without its space and its properties.
std::string_view short_name(std::string_view name) {
  name = name.substr(0, name.find('['));
  return name.substr(name.find(':') + 1);
}

}  // namespace

bool is_air(std::string_view name) {
  name = short_name(name);
  return name == "air" || name == "cave_air" || name == "void_air" || name == "structure_void";
}

Rgb8 color_of_block(std::string_view name) {
  name = short_name(name);
  for (const ColoredBlock& block : kColoredBlocks)
    if (name == block.name) return rgb8_of(block.color);
  if (name.starts_with("red_sand")) return {190, 102, 33};
  if (name == "blue_ice") return {116, 167, 253};
  // Wool, glass, carpets and beds have the dyes of concrete.
  for (const ColoredBlock& block : kColoredBlocks) {
    const std::string_view concrete = block.name;
    constexpr std::string_view kEnding = "concrete";
    if (concrete.ends_with(kEnding) &&
        name.starts_with(concrete.substr(0, concrete.size() - kEnding.size())))
      return rgb8_of(block.color);
  }
  for (const BlockWord& known : kBlockWords)
    if (name.find(known.word) != std::string_view::npos) return known.color;
  return kUnknownBlock;
}

}  // namespace voxdag
