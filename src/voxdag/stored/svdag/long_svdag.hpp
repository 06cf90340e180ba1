#pragma once
/// The SVDAG with long pointers, for DAGs with more than kMaxPlainWords node words.
///
/// The layout of svdag.hpp, but for pointers: they have 35 bits, and count from the first word of
/// the next level.
///
///   node         | mask word | pointer word | ... |            1 + popcount(child mask) words
///   mask word    | upper bits of pointers 7 | ... | 1 | 0 | child mask |
///                  3 bits each, zero for children that are missing; 8 bits
///   pointer      upper bits << 32 | pointer word; of level L-3: index in `leaf_blocks`
///
/// A level can have 2^35 words, which are 128 GiB. Canonical order is that of svdag.hpp.
#include <bit>
#include <cstdint>
#include <vector>

#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// The most node words of a file with 32-bit pointers: 2^32 - 257.
inline constexpr std::uint64_t kMaxPlainWords = 0xFFFFFFFFull - 256;

/// A view like SvdagView; its members have the meanings that they have there.
struct LongSvdagView {
  const std::uint32_t* nodes = nullptr;
  const std::uint64_t* leaf_blocks = nullptr;
  std::uint64_t leaf_block_count = 0;
  std::uint64_t level_begin[kMaxLevels + 1] = {};
  int levels = kMinLevels;

  std::uint64_t node_words() const { return level_begin[levels - 2]; }
  bool is_empty() const { return leaf_block_count == 0; }
};

inline constexpr int kUpperPointerBits = 3;
inline constexpr std::uint64_t kMaxLongWords = std::uint64_t{1} << (32 + kUpperPointerBits);

/// Returns the bits that child `child` of a node adds to the mask word, for a pointer.
constexpr std::uint32_t upper_bits_of(std::uint64_t pointer, int child) {
  return static_cast<std::uint32_t>(pointer >> 32) << (8 + kUpperPointerBits * child);
}

// Overloads for both layouts, so that checks are written once.

/// Returns what a pointer word of `level` counts from, as a word of the next level.
inline std::uint64_t pointer_base(const SvdagView& dag, int level) {
  return level + 1 == dag.levels - 2 ? 0 : dag.level_begin[level + 1];
}
inline std::uint64_t pointer_base(const LongSvdagView&, int) { return 0; }

/// Returns the upper bits of the pointer to child `child`, in their place in the pointer.
inline std::uint64_t upper_pointer_bits(const SvdagView&, std::uint32_t, int) { return 0; }
inline std::uint64_t upper_pointer_bits(const LongSvdagView&, std::uint32_t mask_word, int child) {
  const std::uint32_t bits = mask_word >> (8 + kUpperPointerBits * child);
  return std::uint64_t{bits & ((1u << kUpperPointerBits) - 1)} << 32;
}

/// Returns the bits that a mask word with this child mask may have.
inline std::uint32_t allowed_mask_bits(const SvdagView&, std::uint32_t) { return 0xFF; }
inline std::uint32_t allowed_mask_bits(const LongSvdagView&, std::uint32_t child_mask) {
  std::uint32_t allowed = 0xFF;
  for (std::uint32_t left = child_mask; left != 0; left &= left - 1)
    allowed |= ((1u << kUpperPointerBits) - 1) << (8 + kUpperPointerBits * std::countr_zero(left));
  return allowed;
}

/// Returns whether the pointers of a layout can address all words and leaf blocks.
inline bool fits_pointers(const SvdagView& dag) {
  constexpr std::uint64_t kMax = std::uint64_t{1} << 32;
  return dag.node_words() <= kMax && dag.leaf_block_count <= kMax;
}
inline bool fits_pointers(const LongSvdagView& dag) {
  for (int level = 0; level < dag.levels - 2; ++level)
    if (dag.level_begin[level + 1] - dag.level_begin[level] > kMaxLongWords) return false;
  return dag.leaf_block_count <= kMaxLongWords;
}

/// Returns the reason why a mask word with other bits than allowed_mask_bits() is malformed.
inline const char* mask_fault(const SvdagView&) { return "child mask has more than eight bits"; }
inline const char* mask_fault(const LongSvdagView&) {
  return "mask word has pointer bits of a child that is missing";
}

/// Calls body(word, place) for each child of the node that begins at word `at` of `level`: the word
/// of its pointer, and where it is: the word of the next level, counted from the level's first, or
/// the leaf block. A malformed pointer gives a place beyond the level.
template <class Dag, class Body>
void for_each_child_place(const Dag& dag, int level, std::uint64_t at, const Body& body) {
  const std::uint32_t mask_word = dag.nodes[at];
  const std::uint64_t base = pointer_base(dag, level);
  std::uint64_t word = at;
  for (std::uint32_t left = mask_word & 0xFF; left != 0; left &= left - 1) {
    ++word;
    body(word,
         (dag.nodes[word] | upper_pointer_bits(dag, mask_word, std::countr_zero(left))) - base);
  }
}

/// Returns child `child` of the node at word `place` of `level`, as for_each_child_place() does;
/// the child must be present.
inline std::uint64_t child_place(const LongSvdagView& dag, int level, std::uint64_t place,
                                 int child) {
  const std::uint32_t* const node = dag.nodes + dag.level_begin[level] + place;
  return child_pointer(node, child) | upper_pointer_bits(dag, node[0], child);
}

}  // namespace voxdag
