#pragma once
/// Makes a DAG from others by a rule for cells, without visiting equal cells twice.
///
/// A rule says what the voxels of a cell depend on: its *key*, a few nodes of the sources. Cells of
/// one level that have equal keys are equal. So the work follows the number of different keys, not
/// of voxels. One pass from the root finds the different keys of each level, and one pass from the
/// voxels joins equal results.
///
/// The result needs no sorting. Keys are numbered in the order in which a walk in Morton order
/// first meets them. A node is added at the first of its keys, so nodes are in canonical order
/// (stored/svdag/svdag.hpp).
///
/// A rule is a type with
///   kWords                        the number of words of a key
///   root()                        returns the key of the root
///   children(level, key, keys)    sets the keys of the children of a cell of a level below L-2;
///                                 a key of kNoCell words is a cell without voxels
///   block(key)                    returns the voxels of a cell of level L-2, as a leaf block
#include <array>

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/svdag/svdag.hpp"
#include "voxdag/stored/svdag/unique_cells.hpp"

namespace voxdag {

/// Stands in keys for a node that has no voxels.
inline constexpr std::uint32_t kNoCell = 0xFFFFFFFFu;

template <std::size_t N>
constexpr std::array<std::uint32_t, N> empty_key() {
  std::array<std::uint32_t, N> key{};
  key.fill(kNoCell);
  return key;
}

namespace detail {

/// Joins the different nodes of all levels, in canonical order, to a DAG.
Svdag join_levels(int levels, const std::vector<UniqueNodes>& nodes, MemoryBudget* memory);

template <class Rule>
class Rewriter {
 public:
  Rewriter(const Rule& rule, int levels, Work work) : rule_(rule), levels_(levels), work_(work) {}

  Svdag run() {
    const Key root = rule_.root();
    Svdag empty;
    empty.levels = levels_;
    if (root == kEmpty) return empty;
    CountedVector<Key> keys(1, root, work_.memory);
    for (int level = 0; level < levels_ - 2; ++level) keys = find_keys_below(level, keys);
    for (int level = 0; level < levels_ - 1; ++level) nodes_.emplace_back(work_.memory);
    CountedVector<std::uint32_t> places = add_blocks(keys);
    for (int level = levels_ - 3; level >= 0; --level) places = add_nodes(level, places);
    return places[0] == kNoCell ? empty : join_levels(levels_, nodes_, work_.memory);
  }

 private:
  static constexpr std::size_t kWords = Rule::kWords;
  using Key = std::array<std::uint32_t, kWords>;
  static constexpr Key kEmpty = empty_key<kWords>();

  /// Returns the different keys of the children, and notes which child has which.
  CountedVector<Key> find_keys_below(int level, const CountedVector<Key>& keys) {
    UniqueCells<Key> below(work_.memory);
    CountedVector<std::uint32_t>& links = links_.emplace_back(work_.memory);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      work_.poll_seldom(i);
      Key children[8];
      rule_.children(level, keys[i], children);
      const std::size_t place = links.size();
      links.push_back(0);
      for (std::uint32_t child = 0; child < 8; ++child) {
        if (children[child] == kEmpty) continue;
        links[place] |= 1u << child;
        links.push_back(below.add(children[child]));
      }
    }
    return below.take();
  }

  /// Returns where the block of each key is; kNoCell if it has no voxels.
  CountedVector<std::uint32_t> add_blocks(const CountedVector<Key>& keys) {
    CountedVector<std::uint32_t> places(work_.memory);
    places.reserve(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      work_.poll_seldom(i);
      const std::uint64_t block = rule_.block(keys[i]);
      const std::uint32_t words[] = {static_cast<std::uint32_t>(block),
                                     static_cast<std::uint32_t>(block >> 32)};
      places.push_back(block == 0 ? kNoCell : nodes_.back().add(words, 2));
    }
    return places;
  }

  /// Returns where the node of each key of `level` is, from where its children are.
  CountedVector<std::uint32_t> add_nodes(int level, const CountedVector<std::uint32_t>& below) {
    CountedVector<std::uint32_t>& links = links_[static_cast<std::size_t>(level)];
    UniqueNodes& nodes = nodes_[static_cast<std::size_t>(level)];
    CountedVector<std::uint32_t> places(work_.memory);
    for (std::size_t i = 0; i < links.size();) {
      work_.poll_seldom(i);
      const std::uint32_t candidates = links[i++];
      std::array<std::uint32_t, 9> words{};
      std::size_t size = 1;
      for (std::uint32_t child = 0; child < 8; ++child) {
        if ((candidates >> child & 1) == 0) continue;
        const std::uint32_t place = below[links[i++]];
        if (place == kNoCell) continue;
        words[0] |= 1u << child;
        words[size++] = place;
      }
      places.push_back(size == 1 ? kNoCell : nodes.add(words.data(), size));
    }
    CountedVector<std::uint32_t>(work_.memory).swap(links);
    return places;
  }

  const Rule& rule_;
  int levels_;
  Work work_;
  /// For each key of a level: a mask, then the number of the key of each child in the mask.
  std::vector<CountedVector<std::uint32_t>> links_;
  std::vector<UniqueNodes> nodes_;  ///< Of each level, the leaf blocks last.
};

}  // namespace detail

/// Returns the minimal DAG, in canonical order, of a grid of `levels` levels that follows `rule`.
/// O(different keys) time and memory. Throws Error if a level has too many keys or nodes for 32-bit
/// numbers, OverMemory and Cancelled.
template <class Rule>
Svdag rewrite(const Rule& rule, int levels, Work work) {
  return detail::Rewriter<Rule>(rule, levels, work).run();
}

}  // namespace voxdag
