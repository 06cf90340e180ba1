#include "voxdag/layout/validate_svdag.hpp"

#include <algorithm>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// Pointers have 32 bits.
constexpr std::uint64_t kMostWords = std::uint64_t{1} << 32;

[[noreturn]] void fail_at_word(int level, std::uint64_t word, const std::string& reason) {
  throw Error("", ErrorPlace::level(level) / ErrorPlace::word(word), reason);
}
[[noreturn]] void fail_at_leaf_block(std::uint64_t index, const std::string& reason) {
  throw Error("", ErrorPlace::leaf_block(index), reason);
}
[[noreturn]] void fail_level_table(const std::string& reason) {
  throw Error("", ErrorPlace::level_table(), reason);
}

void validate_level_table(const SvdagView& dag) {
  if (dag.levels < kMinLevels || dag.levels > kMaxLevels)
    fail_level_table(std::to_string(dag.levels) + " levels are not in the range " +
                     std::to_string(kMinLevels) + " to " + std::to_string(kMaxLevels));
  if (dag.level_begin[0] != 0) fail_level_table("level 0 does not begin at word 0");
  for (int level = 0; level < kMaxLevels; ++level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
    const std::string name = "level " + std::to_string(level);
    if (end < begin) fail_level_table(name + " ends before it begins");
    if (level >= dag.levels - 2 && end != begin)
      fail_level_table(name + " must have no node words");
    if (level < dag.levels - 2 && end == begin && !dag.is_empty())
      fail_level_table(name + " has no nodes");
  }
  if (dag.node_words() > kMostWords || dag.leaf_block_count > kMostWords)
    fail_level_table("there are more words than 32-bit pointers can address");
  if (dag.is_empty() && dag.node_words() != 0)
    fail_level_table("there are nodes, but no leaf blocks");
  if (dag.levels == 2 && dag.leaf_block_count > 1) fail_level_table("there is more than one root");
}

/// Checks the masks of one level and marks in `starts` (bit i: word level_begin + i) where its
/// nodes start.
void mark_nodes(const SvdagView& dag, int level, std::vector<std::uint64_t>& starts) {
  const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
  starts.assign((end - begin + 63) / 64, 0);
  for (std::uint64_t at = begin; at < end;) {
    const std::uint32_t mask = dag.nodes[at];
    if (mask == 0) fail_at_word(level, at, "node has no children");
    if (mask > 0xFF) fail_at_word(level, at, "child mask has more than eight bits");
    const std::uint64_t next = at + 1 + popcount(mask);
    if (next > end) fail_at_word(level, at, "node reaches past the end of its level");
    starts[(at - begin) / 64] |= std::uint64_t{1} << ((at - begin) % 64);
    at = next;
  }
}

/// Checks the pointers of a level above the leaf blocks' parents. mark_nodes() must have accepted
/// its nodes.
void check_pointers(const SvdagView& dag, int level, const std::vector<std::uint64_t>& starts) {
  const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
  const std::uint64_t below_words = dag.level_begin[level + 2] - end;
  for (std::uint64_t at = begin; at < end;) {
    const int children = popcount(dag.nodes[at]);
    for (int i = 1; i <= children; ++i) {
      const std::uint64_t offset = std::uint64_t{dag.nodes[at + i]} - end;  // wraps if below `end`
      if (offset >= below_words)
        fail_at_word(level, at + i, "pointer points outside the next level");
      if ((starts[offset / 64] >> (offset % 64) & 1) == 0)
        fail_at_word(level, at + i, "pointer does not point to the first word of a node");
    }
    at += 1 + children;
  }
}

void check_leaf_pointers(const SvdagView& dag, int level) {
  for (std::uint64_t at = dag.level_begin[level]; at < dag.level_begin[level + 1];) {
    const int children = popcount(dag.nodes[at]);
    for (int i = 1; i <= children; ++i)
      if (dag.nodes[at + i] >= dag.leaf_block_count)
        fail_at_word(level, at + i, "pointer is past the last leaf block");
    at += 1 + children;
  }
}

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9E3779B97F4A7C15ull;
  return hash ^ hash >> 32;
}

/// A hash set of 32-bit positions in a level, compared by the nodes at these positions.
class PositionSet {
 public:
  explicit PositionSet(std::uint64_t count) {
    std::size_t slots = 16;
    while (slots < 2 * count) slots *= 2;
    slots_.assign(slots, kFree);
  }
  /// Returns true if `equals(other)` for some position in the set; else adds `position`.
  template <class Equals>
  bool has_or_add(std::uint64_t position, std::uint64_t hash, const Equals& equals) {
    for (std::size_t slot = hash & (slots_.size() - 1);; slot = (slot + 1) & (slots_.size() - 1)) {
      if (slots_[slot] == kFree) {
        slots_[slot] = static_cast<std::uint32_t>(position);
        return false;
      }
      if (equals(slots_[slot])) return true;
    }
  }

 private:
  /// Marks a free slot. It is not a valid position, because no node starts at a level's last word
  /// and a level has at most 2^32 words.
  static constexpr std::uint32_t kFree = 0xFFFFFFFF;
  std::vector<std::uint32_t> slots_;
};

void check_minimal_level(const SvdagView& dag, int level) {
  const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
  std::uint64_t count = 0;
  for (std::uint64_t at = begin; at < end; at += 1 + popcount(dag.nodes[at])) ++count;
  PositionSet seen(count);
  for (std::uint64_t at = begin; at < end;) {
    const std::uint32_t* node = dag.nodes + at;
    const int words = 1 + popcount(node[0]);
    std::uint64_t hash = 0;
    for (int i = 0; i < words; ++i) hash = mix(hash, node[i]);
    const auto equals = [&](std::uint32_t other) {
      return std::equal(node, node + words, dag.nodes + begin + other);
    };
    if (seen.has_or_add(at - begin, hash, equals))
      fail_at_word(level, at, "node equals an earlier node of its level");
    at += words;
  }
}

void check_minimal_leaf_blocks(const SvdagView& dag) {
  PositionSet seen(dag.leaf_block_count);
  for (std::uint64_t i = 0; i < dag.leaf_block_count; ++i) {
    const std::uint64_t block = dag.leaf_blocks[i];
    const auto equals = [&](std::uint32_t other) { return dag.leaf_blocks[other] == block; };
    if (seen.has_or_add(i, mix(0, block), equals))
      fail_at_leaf_block(i, "leaf block equals an earlier leaf block");
  }
}

}  // namespace

void validate_svdag(const SvdagView& dag) {
  validate_level_table(dag);
  if (dag.is_empty()) return;
  std::vector<std::uint64_t> starts;
  for (int level = 0; level < dag.levels - 2; ++level) {
    if (level == 0) mark_nodes(dag, 0, starts);
    if (level == 0 && dag.level_begin[1] != 1u + static_cast<unsigned>(popcount(dag.nodes[0])))
      fail_at_word(0, 0, "level 0 must be exactly one node");
    if (level + 1 == dag.levels - 2) {
      check_leaf_pointers(dag, level);
    } else {
      mark_nodes(dag, level + 1, starts);
      check_pointers(dag, level, starts);
    }
  }
  for (std::uint64_t i = 0; i < dag.leaf_block_count; ++i)
    if (dag.leaf_blocks[i] == 0) fail_at_leaf_block(i, "leaf block has no voxels");
}

void check_canonical(const SvdagView& dag) {
  for (int level = 0; level < dag.levels - 2; ++level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
    const bool above_leaf_blocks = level + 1 == dag.levels - 2;
    // The first node of the next level that the scan of this level has not met. The next new child
    // must be this node.
    std::uint64_t next = above_leaf_blocks ? 0 : end;
    const std::uint64_t below_end =
        above_leaf_blocks ? dag.leaf_block_count : dag.level_begin[level + 2];
    for (std::uint64_t at = begin; at < end;) {
      const int children = popcount(dag.nodes[at]);
      for (int i = 1; i <= children; ++i) {
        const std::uint64_t child = dag.nodes[at + i];
        if (child > next) fail_at_word(level, at + i, "child is not the next in depth-first order");
        if (child == next) next += above_leaf_blocks ? 1 : 1 + popcount(dag.nodes[child]);
      }
      at += 1 + children;
    }
    if (next == below_end) continue;
    if (above_leaf_blocks) fail_at_leaf_block(next, "leaf block has no parent");
    fail_at_word(level + 1, next, "node has no parent");
  }
}

void check_minimal(const SvdagView& dag) {
  for (int level = 0; level < dag.levels - 2; ++level) check_minimal_level(dag, level);
  check_minimal_leaf_blocks(dag);
}

}  // namespace voxdag
