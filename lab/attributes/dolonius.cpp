#include "lab/attributes/dolonius.hpp"

#include <algorithm>
#include <array>

#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag::lab {
namespace {

constexpr std::size_t kMacroColors = 16 * 1024;
constexpr std::uint64_t kBlockBits = 32 + 32;  ///< Header and end points.

struct Block {
  std::size_t begin = 0, end = 0;  ///< Colors of the macro block.
  bool may_merge = true;           ///< False: it could not, and no neighbor changed since.
  bool has_score = false;
  float score = -1;  ///< Of merging it with the next block.

  std::size_t size() const { return end - begin; }
};

/// The blocks of a macro block.
class MacroBlock {
 public:
  MacroBlock(std::span<const ColorBytes> colors, float threshold) : threshold_(threshold) {
    for (const ColorBytes color : colors) colors_.push_back(color_of_bytes(color));
    std::vector<Block> blocks;
    for (std::size_t i = 0; i < colors.size(); ++i) blocks.push_back({i, i + 1});
    for (int bits = 0; bits <= kMaxWeightBits; ++bits) {
      while (merge_pass(bits, blocks)) {
      }
      blocks_[bits] = blocks;
      for (Block& block : blocks) block = {block.begin, block.end};
    }
    find_costs();
  }

  /// Calls use(block, bits) for the blocks of the cheapest cut, in order.
  template <class Use>
  void for_each_block(const Use& use) const {
    for (std::size_t i = 0; i < blocks_[kMaxWeightBits].size(); ++i) visit(kMaxWeightBits, i, use);
  }

  std::span<const Vec3f> colors(const Block& block) const {
    return std::span(colors_).subspan(block.begin, block.size());
  }

 private:
  /// Merges blocks with neighbors, and returns whether any merged.
  bool merge_pass(int bits, std::vector<Block>& blocks) const {
    for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
      if (blocks[i].has_score) continue;
      blocks[i].score = line_score(
          std::span(colors_).subspan(blocks[i].begin, blocks[i + 1].end - blocks[i].begin), bits,
          threshold_);
      blocks[i].has_score = true;
    }
    std::vector<bool> is_joined(blocks.size());  // to the block before it
    bool any = false;
    for (std::size_t i = 1; i < blocks.size(); i += 2) {
      const bool has_next = i + 1 < blocks.size();
      if (!blocks[i - 1].may_merge && !blocks[i].may_merge &&
          !(has_next && blocks[i + 1].may_merge))
        continue;
      const float before = blocks[i - 1].score, after = has_next ? blocks[i].score : -1;
      if (before < 0 && after < 0) {
        blocks[i].may_merge = false;
        continue;
      }
      any = true;
      is_joined[before > after ? i : i + 1] = true;
      // A merge with the next block uses that up, too.
      if (before <= after) ++i;
    }
    if (any) join(is_joined, blocks);
    return any;
  }

  static void join(const std::vector<bool>& is_joined, std::vector<Block>& blocks) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      if (!is_joined[i]) {
        blocks[count++] = blocks[i];
        continue;
      }
      Block& joined = blocks[count - 1];
      joined.end = blocks[i].end;
      joined.may_merge = true;
      joined.has_score = false;
      if (count > 1) blocks[count - 2].has_score = false;
    }
    blocks.resize(count);
  }

  static std::uint64_t own_cost(int bits, const Block& block) {
    return kBlockBits + static_cast<std::uint64_t>(bits) * block.size();
  }

  /// Calls use(i) for the blocks of one bit less of which block `index` was made.
  template <class Use>
  void for_each_child(int bits, std::size_t index, const Use& use) const {
    const std::vector<Block>& below = blocks_[bits - 1];
    const Block& block = blocks_[bits][index];
    auto child =
        std::lower_bound(below.begin(), below.end(), block.begin,
                         [](const Block& b, std::size_t begin) { return b.begin < begin; });
    for (; child != below.end() && child->begin < block.end; ++child)
      use(static_cast<std::size_t>(child - below.begin()));
  }

  void find_costs() {
    for (int bits = 0; bits <= kMaxWeightBits; ++bits)
      for (std::size_t i = 0; i < blocks_[bits].size(); ++i) {
        std::uint64_t cost = own_cost(bits, blocks_[bits][i]);
        if (bits > 0) {
          std::uint64_t below = 0;
          for_each_child(bits, i, [&](std::size_t child) { below += costs_[bits - 1][child]; });
          cost = std::min(cost, below);
        }
        costs_[bits].push_back(cost);
      }
  }

  template <class Use>
  void visit(int bits, std::size_t index, const Use& use) const {
    if (costs_[bits][index] == own_cost(bits, blocks_[bits][index]))
      use(blocks_[bits][index], bits);
    else
      for_each_child(bits, index, [&](std::size_t child) { visit(bits - 1, child, use); });
  }

  float threshold_;
  std::vector<Vec3f> colors_;
  /// By bits of weights.
  std::array<std::vector<Block>, kMaxWeightBits + 1> blocks_;
  /// The bits of the cheapest cut below each block.
  std::array<std::vector<std::uint64_t>, kMaxWeightBits + 1> costs_;
};

struct MacroSize {
  std::uint64_t blocks = 0, weight_bits = 0;
};

MacroSize encode_macro(std::span<const ColorBytes> colors, float threshold,
                       std::span<ColorBytes> decoded) {
  const MacroBlock macro(colors, threshold);
  MacroSize size;
  macro.for_each_block([&](const Block& block, int bits) {
    ++size.blocks;
    size.weight_bits += static_cast<std::uint64_t>(bits) * block.size();
    const std::span<const Vec3f> originals = macro.colors(block);
    const ColorLine line = fit_line(originals, bits);
    for (std::size_t i = 0; i < originals.size(); ++i) {
      // The end points of two colors are these colors.
      const int weight = originals.size() == 2 && bits > 0 ? (i == 0 ? 0 : (1 << bits) - 1)
                                                           : line.weight_of(originals[i]);
      decoded[block.begin + i] = bytes_of_color(line.color(weight));
    }
  });
  return size;
}

}  // namespace

EncodedColors encode_dolonius(std::span<const ColorBytes> colors, float error_threshold,
                              const Progress& progress) {
  EncodedColors encoded;
  encoded.colors.resize(colors.size());
  const std::size_t macro_blocks = (colors.size() + kMacroColors - 1) / kMacroColors;
  std::vector<MacroSize> sizes(macro_blocks);
  parallel_for(macro_blocks, [&](std::size_t i) {
    progress.throw_if_cancelled();
    const std::size_t begin = i * kMacroColors;
    const std::size_t count = std::min(kMacroColors, colors.size() - begin);
    sizes[i] = encode_macro(colors.subspan(begin, count), error_threshold,
                            std::span(encoded.colors).subspan(begin, count));
  });
  MacroSize sum;
  for (const MacroSize& size : sizes) {
    sum.blocks += size.blocks;
    sum.weight_bits += size.weight_bits;
  }
  encoded.size.parts = {{"block headers", 4 * sum.blocks},
                        {"end points", 4 * sum.blocks},
                        {"weights", 4 * ((sum.weight_bits + 31) / 32)},
                        {"macro blocks", 16 * macro_blocks}};
  return encoded;
}

}  // namespace voxdag::lab
