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
///                                 a key of kNoCell words is a cell without voxels. Threads call
///                                 it at the same time, unless the rule has a member kOneThread
///   prefetch(level, key)          prefetches what children() reads; a rule need not have it
///   block(key)                    returns the voxels of a cell of level L-2, as a leaf block
#include <algorithm>
#include <array>

#include "voxdag/core/parallel/ordered_pipeline.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
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
  /// The children of a run of cells: masks[i] says which children cell i has; `keys` lists them.
  struct Chunk {
    explicit Chunk(MemoryBudget* memory) : masks(memory), keys(memory), hashes(memory) {}
    CountedVector<std::uint8_t> masks;
    CountedVector<Key> keys;
    CountedVector<std::uint64_t> hashes;
  };
  static constexpr bool kIsOneThread = requires { Rule::kOneThread; };
  static constexpr std::size_t kChunk = 1024;  ///< Cells.
  /// Prefetches run this many cells ahead.
  static constexpr std::size_t kAhead = 16;

  /// Finds the children of the cells from keys[begin] on.
  Chunk chunk_below(int level, const CountedVector<Key>& keys, std::size_t begin) const {
    Chunk chunk(work_.memory);
    const std::size_t end = std::min(keys.size(), begin + kChunk);
    chunk.masks.reserve(end - begin);
    chunk.keys.reserve(8 * (end - begin));
    chunk.hashes.reserve(8 * (end - begin));
    for (std::size_t i = begin; i < end; ++i) {
      if constexpr (requires { rule_.prefetch(level, keys[i]); })
        if (i + kAhead < end) rule_.prefetch(level, keys[i + kAhead]);
      Key children[8];
      rule_.children(level, keys[i], children);
      std::uint8_t mask = 0;
      for (int child = 0; child < 8; ++child) {
        if (children[child] == kEmpty) continue;
        mask |= static_cast<std::uint8_t>(1 << child);
        chunk.keys.push_back(children[child]);
        chunk.hashes.push_back(UniqueCells<Key>::hash_of(children[child]));
      }
      chunk.masks.push_back(mask);
    }
    return chunk;
  }

  /// Returns the different keys of the children, and notes which child has which.
  CountedVector<Key> find_keys_below(int level, const CountedVector<Key>& keys) {
    UniqueCells<Key> below(work_.memory);
    CountedVector<std::uint32_t>& links = links_.emplace_back(work_.memory);
    const auto add_chunk = [&](const Chunk& chunk) {
      const std::size_t count = chunk.keys.size();
      std::size_t next = 0;
      for (const std::uint8_t mask : chunk.masks) {
        links.push_back(mask);
        for (int left = popcount8(mask); left > 0; --left, ++next) {
          if (next + 2 * kAhead < count) below.prefetch(chunk.hashes[next + 2 * kAhead]);
          if (next + kAhead < count) below.prefetch_likely(chunk.hashes[next + kAhead]);
          links.push_back(below.add(chunk.keys[next], chunk.hashes[next]));
        }
      }
    };
    const std::size_t chunks = (keys.size() + kChunk - 1) / kChunk;
    const auto find_chunk = [&](std::size_t i) { return chunk_below(level, keys, i * kChunk); };
    if (chunks <= 1 || kIsOneThread) {
      for (std::size_t i = 0; i < chunks; ++i) {
        work_.poll();
        add_chunk(find_chunk(i));
      }
    } else {
      ordered_pipeline(chunks, 4 * thread_count(), work_, find_chunk, add_chunk);
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
    struct Pending {
      std::array<std::uint32_t, 9> words;
      std::size_t size;
      std::uint64_t hash;
    };
    std::array<Pending, kAhead> group;
    for (std::size_t i = 0; i < links.size();) {
      work_.poll_seldom(places.size() / kAhead);
      std::size_t count = 0;
      for (; count < kAhead && i < links.size(); ++count) {
        Pending& node = group[count] = {{}, 1, 0};
        const std::uint32_t candidates = links[i++];
        for (std::uint32_t child = 0; child < 8; ++child) {
          if ((candidates >> child & 1) == 0) continue;
          const std::uint32_t place = below[links[i++]];
          if (place == kNoCell) continue;
          node.words[0] |= 1u << child;
          node.words[node.size++] = place;
        }
        node.hash = hash_words(node.words.data(), static_cast<int>(node.size));
        nodes.prefetch(node.hash);
      }
      for (std::size_t n = 0; n < count; ++n) nodes.prefetch_likely(group[n].hash);
      for (std::size_t n = 0; n < count; ++n) {
        const Pending& node = group[n];
        places.push_back(node.size == 1 ? kNoCell
                                        : nodes.add(node.words.data(), node.size, node.hash));
      }
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
