#include "voxdag/stored/attributes/build_cell_index.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Returns the number of cells in the subtree of a child. `pointer` is its pointer in a node of
/// `level`, which has slots. The slots of the level below must be in `index`.
std::uint64_t subtree_cells(const SvdagView& dag, const CellIndexView& index, int level,
                            std::uint32_t pointer) {
  const int finest = index.finest_level, below = level + 1;
  if (below == dag.levels - 2)
    return leaf_block_cells(dag.leaf_blocks[pointer], dag.levels, finest);
  const auto children = static_cast<std::uint64_t>(popcount(child_mask(dag.nodes + pointer)));
  if (!has_cell_sums(dag, below, finest)) return 1 + children;
  return cell_sum(dag, index, below, pointer + children);
}

/// Calls fn(word, sum) for each slot of a level in order, with the DAG's word beside it. The sum is
/// 0 for the slot of a mask.
template <class Fn>
void for_each_sum(const SvdagView& dag, const CellIndexView& index, int level, const Fn& fn) {
  for (std::uint64_t at = dag.level_begin[level]; at < dag.level_begin[level + 1];) {
    const int children = popcount(child_mask(dag.nodes + at));
    fn(at++, std::uint64_t{0});
    std::uint64_t sum = 1;
    for (int i = 0; i < children; ++i, ++at) {
      sum += subtree_cells(dag, index, level, dag.nodes[at]);
      fn(at, sum);
    }
  }
}

/// Returns the words that the slots of a level take.
std::uint64_t level_words(const SvdagView& dag, int level, int width) {
  const std::uint64_t slots = dag.level_begin[level + 1] - dag.level_begin[level];
  return (slots * static_cast<std::uint64_t>(width) + 63) / 64;
}

/// Returns the number of bits of the largest sum of a level. The slots of the level below must be
/// in `index`.
int needed_width(const SvdagView& dag, const CellIndexView& index, int level) {
  std::uint64_t most = 0;
  for_each_sum(dag, index, level,
               [&](std::uint64_t, std::uint64_t sum) { most = std::max(most, sum); });
  return static_cast<int>(std::bit_width(most));
}

/// Returns the number of all cells. All slots must be in `index`.
std::uint64_t count_cells(const SvdagView& dag, const CellIndexView& index) {
  if (dag.is_empty()) return 0;
  if (index.finest_level == 0) return 1;
  if (dag.levels == 2) return leaf_block_cells(dag.leaf_blocks[0], 2, index.finest_level);
  const auto children = static_cast<std::uint64_t>(popcount(child_mask(dag.nodes)));
  return has_cell_sums(dag, 0, index.finest_level) ? cell_sum(dag, index, 0, children)
                                                   : 1 + children;
}

}  // namespace

CellIndex build_cell_index(const SvdagView& dag, int finest_level, MemoryBudget* memory) {
  // The sums of a level need those of the level below, whose words come later.
  std::vector<CountedVector<std::uint64_t>> parts(kMaxLevels, CountedVector<std::uint64_t>(memory));
  CellIndex index;
  index.finest_level = static_cast<std::uint8_t>(finest_level);
  CellIndexView view = index.view();
  const std::uint64_t* below = nullptr;
  for (int level = dag.levels - 3; level >= 0; --level) {
    if (dag.is_empty() || !has_cell_sums(dag, level, finest_level)) continue;
    view.words = below;
    const int width = needed_width(dag, view, level);
    CountedVector<std::uint64_t>& words = parts[static_cast<std::size_t>(level)];
    words.assign(level_words(dag, level, width), 0);
    const std::uint64_t begin = dag.level_begin[level];
    for_each_sum(dag, view, level, [&](std::uint64_t word, std::uint64_t sum) {
      write_bits(words.data(), (word - begin) * static_cast<std::uint64_t>(width), width, sum);
    });
    index.width[static_cast<std::size_t>(level)] = view.width[level] =
        static_cast<std::uint8_t>(width);
    below = words.data();  // view.begin stays 0: each level has an array of its own
  }
  std::uint64_t count = 0;
  for (const auto& part : parts) count += part.size();
  const MemoryReservation counted(memory, 8 * count);
  index.words.reserve(count);
  for (std::size_t level = 0; level < kMaxLevels; ++level) {
    index.begin[level] = index.words.size();
    index.words.insert(index.words.end(), parts[level].begin(), parts[level].end());
    parts[level] = CountedVector<std::uint64_t>(memory);
  }
  index.begin[kMaxLevels] = index.words.size();
  index.cells = count_cells(dag, index.view());
  return index;
}

void validate_cell_index(const SvdagView& dag, const CellIndexView& index) {
  if (index.finest_level > dag.levels)
    fail_at("", "its finest level, " + std::to_string(index.finest_level) +
                    ", is finer than the voxels, level " + std::to_string(dag.levels));
  std::uint64_t words = 0;
  for (int level = 0; level < kMaxLevels; ++level) {
    const bool has_slots = !dag.is_empty() && has_cell_sums(dag, level, index.finest_level);
    const int width = index.width[level];
    if (width > 64 || (width != 0) != has_slots)
      fail_at(ErrorPlace::level(level), "cannot have slots of " + std::to_string(width) + " bits");
    if (index.begin[level] != words)
      fail_at(ErrorPlace::level(level), "does not begin at word " + std::to_string(words));
    words += level_words(dag, level, width);
  }
  if (index.word_count() != words)
    fail_at("", "has " + std::to_string(index.word_count()) +
                    " words, but the widths of its slots need " + std::to_string(words));
  for (int level = dag.levels - 3; level >= 0; --level) {
    const int width = index.width[level];
    if (width == 0) continue;
    const int needed = needed_width(dag, index, level);
    if (needed != width)
      fail_at(ErrorPlace::level(level), "has slots of " + std::to_string(width) +
                                            " bits, but the DAG needs " + std::to_string(needed));
    for_each_sum(dag, index, level, [&](std::uint64_t word, std::uint64_t sum) {
      const std::uint64_t stored = cell_sum(dag, index, level, word);
      if (stored != sum)
        fail_at(
            ErrorPlace::level(level) / ErrorPlace::word(word),
            "the slot is " + std::to_string(stored) + ", but the DAG needs " + std::to_string(sum));
    });
    const std::uint64_t bits =
        (dag.level_begin[level + 1] - dag.level_begin[level]) * static_cast<std::uint64_t>(width);
    if (bits % 64 != 0 && index.words[index.begin[level + 1] - 1] >> (bits % 64) != 0)
      fail_at(ErrorPlace::level(level), "padding is not zero");
  }
  const std::uint64_t cells = count_cells(dag, index);
  if (cells != index.cells)
    fail_at("", "is for " + std::to_string(index.cells) + " cells, but the DAG has " +
                    std::to_string(cells));
}

}  // namespace voxdag
