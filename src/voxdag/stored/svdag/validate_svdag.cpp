#include "voxdag/stored/svdag/validate_svdag.hpp"

#include <algorithm>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

[[noreturn]] void fail_at_word(int level, std::uint64_t word, const std::string& reason) {
  throw Error("", ErrorPlace::level(level) / ErrorPlace::word(word), reason);
}
[[noreturn]] void fail_at_leaf_block(std::uint64_t index, const std::string& reason) {
  throw Error("", ErrorPlace::leaf_block(index), reason);
}
[[noreturn]] void fail_level_table(const std::string& reason) {
  throw Error("", ErrorPlace::level_table(), reason);
}

template <class Dag>
void validate_level_table(const Dag& dag) {
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
  if (!fits_pointers(dag)) fail_level_table("there are more words than pointers can address");
  if (dag.is_empty() && dag.node_words() != 0)
    fail_level_table("there are nodes, but no leaf blocks");
  if (dag.levels == 2 && dag.leaf_block_count > 1) fail_level_table("there is more than one root");
}

/// Checks the masks of one level and marks in `starts` (bit i: word level_begin + i) where its
/// nodes start.
template <class Dag>
void mark_nodes(const Dag& dag, int level, std::vector<std::uint64_t>& starts) {
  const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
  starts.assign((end - begin + 63) / 64, 0);
  for (std::uint64_t at = begin; at < end;) {
    const std::uint32_t mask = dag.nodes[at];
    if ((mask & 0xFF) == 0) fail_at_word(level, at, "node has no children");
    if ((mask & ~allowed_mask_bits(dag, mask & 0xFF)) != 0)
      fail_at_word(level, at, mask_fault(dag));
    const std::uint64_t next = at + 1 + popcount(mask & 0xFF);
    if (next > end) fail_at_word(level, at, "node reaches past the end of its level");
    starts[(at - begin) / 64] |= std::uint64_t{1} << ((at - begin) % 64);
    at = next;
  }
}

/// Checks the pointers of a level above the leaf blocks' parents. mark_nodes() must have accepted
/// its nodes.
template <class Dag>
void check_pointers(const Dag& dag, int level, const std::vector<std::uint64_t>& starts) {
  const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
  const std::uint64_t below_words = dag.level_begin[level + 2] - end;
  for (std::uint64_t at = begin; at < end; at += 1 + popcount(dag.nodes[at] & 0xFF))
    for_each_child_place(dag, level, at, [&](std::uint64_t word, std::uint64_t place) {
      if (place >= below_words) fail_at_word(level, word, "pointer points outside the next level");
      if ((starts[place / 64] >> (place % 64) & 1) == 0)
        fail_at_word(level, word, "pointer does not point to the first word of a node");
    });
}

template <class Dag>
void check_leaf_pointers(const Dag& dag, int level) {
  const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
  for (std::uint64_t at = begin; at < end; at += 1 + popcount(dag.nodes[at] & 0xFF))
    for_each_child_place(dag, level, at, [&](std::uint64_t word, std::uint64_t place) {
      if (place >= dag.leaf_block_count)
        fail_at_word(level, word, "pointer is past the last leaf block");
    });
}

std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9E3779B97F4A7C15ull;
  return hash ^ hash >> 32;
}

/// A hash set of positions in a level, compared by the nodes at these positions.
template <class Position>
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
        slots_[slot] = static_cast<Position>(position);
        return false;
      }
      if (equals(slots_[slot])) return true;
    }
  }

 private:
  /// Marks a free slot. It is not a valid position, because no node starts at a level's last word
  /// and a level of the plain layout has at most 2^32 words.
  static constexpr Position kFree = static_cast<Position>(~Position{0});
  std::vector<Position> slots_;
};

template <class Position, class Dag>
void check_minimal_level(const Dag& dag, int level) {
  const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
  std::uint64_t count = 0;
  for (std::uint64_t at = begin; at < end; at += 1 + popcount(dag.nodes[at] & 0xFF)) ++count;
  PositionSet<Position> seen(count);
  for (std::uint64_t at = begin; at < end;) {
    const std::uint32_t* node = dag.nodes + at;
    const int words = 1 + popcount(node[0] & 0xFF);
    std::uint64_t hash = 0;
    for (int i = 0; i < words; ++i) hash = mix(hash, node[i]);
    const auto equals = [&](std::uint64_t other) {
      return std::equal(node, node + words, dag.nodes + begin + other);
    };
    if (seen.has_or_add(at - begin, hash, equals))
      fail_at_word(level, at, "node equals an earlier node of its level");
    at += words;
  }
}

template <class Position, class Dag>
void check_minimal_leaf_blocks(const Dag& dag) {
  PositionSet<Position> seen(dag.leaf_block_count);
  for (std::uint64_t i = 0; i < dag.leaf_block_count; ++i) {
    const std::uint64_t block = dag.leaf_blocks[i];
    const auto equals = [&](std::uint64_t other) { return dag.leaf_blocks[other] == block; };
    if (seen.has_or_add(i, mix(0, block), equals))
      fail_at_leaf_block(i, "leaf block equals an earlier leaf block");
  }
}

template <class Dag>
void validate(const Dag& dag) {
  validate_level_table(dag);
  if (dag.is_empty()) return;
  std::vector<std::uint64_t> starts;
  for (int level = 0; level < dag.levels - 2; ++level) {
    if (level == 0) mark_nodes(dag, 0, starts);
    if (level == 0 &&
        dag.level_begin[1] != 1u + static_cast<unsigned>(popcount(dag.nodes[0] & 0xFF)))
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

template <class Dag>
void check_order(const Dag& dag) {
  for (int level = 0; level < dag.levels - 2; ++level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
    const bool above_leaf_blocks = level + 1 == dag.levels - 2;
    const std::uint64_t below_count =
        above_leaf_blocks ? dag.leaf_block_count : dag.level_begin[level + 2] - end;
    // The place of the first child that the scan of this level has not met. The next new child must
    // be there.
    std::uint64_t next = 0;
    for (std::uint64_t at = begin; at < end; at += 1 + popcount(dag.nodes[at] & 0xFF))
      for_each_child_place(dag, level, at, [&](std::uint64_t word, std::uint64_t place) {
        if (place > next) fail_at_word(level, word, "child is not the next in depth-first order");
        if (place == next)
          next += above_leaf_blocks ? 1 : 1 + popcount(dag.nodes[end + place] & 0xFF);
      });
    if (next == below_count) continue;
    if (above_leaf_blocks) fail_at_leaf_block(next, "leaf block has no parent");
    fail_at_word(level + 1, end + next, "node has no parent");
  }
}

template <class Position, class Dag>
void check_all_differ(const Dag& dag) {
  for (int level = 0; level < dag.levels - 2; ++level) check_minimal_level<Position>(dag, level);
  check_minimal_leaf_blocks<Position>(dag);
}

}  // namespace

void validate_svdag(const SvdagView& dag) { validate(dag); }
void validate_svdag(const LongSvdagView& dag) { validate(dag); }

void check_canonical(const SvdagView& dag) { check_order(dag); }
void check_canonical(const LongSvdagView& dag) { check_order(dag); }

void check_minimal(const SvdagView& dag) { check_all_differ<std::uint32_t>(dag); }
void check_minimal(const LongSvdagView& dag) { check_all_differ<std::uint64_t>(dag); }

}  // namespace voxdag
