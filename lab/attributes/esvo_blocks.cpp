#include "lab/attributes/esvo_blocks.hpp"

#include <array>
#include <bit>
#include <utility>

#include "voxdag/builders/esvo/encode/encode_color_block.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/stored/attributes/numbered_cell.hpp"

namespace voxdag::lab {
namespace {

class Encoder {
 public:
  Encoder(const SvdagView& dag, const CellIndexView& index, const std::vector<Value8>& colors,
          std::vector<Value8>& decoded)
      : dag_(dag), index_(index), colors_(colors), decoded_(decoded) {}

  /// Encodes the children of one or two siblings.
  void encode_pair(std::span<const NumberedCell> parents) const {
    std::array<Vec3f, kValuesPerBlock> values{};
    std::array<std::uint64_t, kValuesPerBlock> numbers{};
    std::uint32_t used = 0;
    for (std::size_t p = 0; p < parents.size(); ++p)
      for (std::uint32_t left = children_of(dag_, parents[p]); left != 0; left &= left - 1) {
        const int child = std::countr_zero(left);
        const std::size_t i = 8 * p + static_cast<std::size_t>(child);
        numbers[i] = child_of(dag_, index_, parents[p], child).number;
        const Value8 color = colors_[numbers[i]];
        values[i] = Vec3f{static_cast<float>(color.x), static_cast<float>(color.y),
                          static_cast<float>(color.z)} *
                    (1.0f / 255);
        used |= 1u << i;
      }
    const ColorBlock block = encode_color_block(values, used);
    for (; used != 0; used &= used - 1) {
      const int i = std::countr_zero(used);
      const Vec3f color = block.color(i);
      Value8& stored = decoded_[numbers[static_cast<std::size_t>(i)]];
      for (int c = 0; c < 3; ++c) stored[c] = static_cast<std::uint8_t>(color[c] * 255 + 0.5f);
    }
  }

  /// Encodes all blocks below the children of a cell whose own children have a block. Returns their
  /// number. Lists the children of level `last` in `below` instead of descending.
  std::uint64_t encode_below(const NumberedCell& cell, int last,
                             std::vector<NumberedCell>& below) const {
    if (cell.level + 1 >= index_.finest_level) return 0;
    std::array<NumberedCell, 8> children;
    std::size_t count = 0;
    for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1)
      children[count++] = child_of(dag_, index_, cell, std::countr_zero(left));
    std::uint64_t blocks = 0;
    for (std::size_t i = 0; i < count; i += 2, ++blocks)
      encode_pair(std::span(children).subspan(i, std::min<std::size_t>(2, count - i)));
    for (std::size_t i = 0; i < count; ++i) {
      if (children[i].level == last)
        below.push_back(children[i]);
      else
        blocks += encode_below(children[i], last, below);
    }
    return blocks;
  }

 private:
  const SvdagView& dag_;
  const CellIndexView& index_;
  const std::vector<Value8>& colors_;
  std::vector<Value8>& decoded_;
};

}  // namespace

EsvoColors encode_esvo_colors(const SvdagView& dag, const CellIndexView& index,
                              const std::vector<Value8>& colors, const Progress& progress) {
  constexpr int kTaskLevel = 6;
  EsvoColors encoded;
  encoded.colors = colors;
  if (dag.is_empty() || index.finest_level == 0) return encoded;
  const Encoder encoder(dag, index, colors, encoded.colors);
  const NumberedCell root;
  encoder.encode_pair({&root, 1});
  std::vector<NumberedCell> tasks;
  encoded.blocks = 1 + encoder.encode_below(root, kTaskLevel, tasks);
  std::vector<std::uint64_t> blocks(tasks.size());
  parallel_for(tasks.size(), [&](std::size_t i) {
    progress.throw_if_cancelled();
    std::vector<NumberedCell> none;
    blocks[i] = encoder.encode_below(tasks[i], -1, none);
  });
  for (const std::uint64_t count : blocks) encoded.blocks += count;
  return encoded;
}

}  // namespace voxdag::lab
