#include "lab/compact/tsvdag.hpp"

#include <bit>
#include <unordered_map>

#include "lab/compact/code_lengths.hpp"
#include "lab/compact/reference_order.hpp"
#include "lab/compact/symmetry.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {
namespace {

constexpr int kLongestCode = 16;
constexpr std::uint64_t kTableEntryWords = 4;

int words_of_bits(int bits) { return (bits + 15) / 16; }

int moved_axes(const Transform& transform) {
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (transform.move[axis] != 0) axes |= 1 << axis;
  return axes;
}

/// A pointer to a node as one number, for finding equal ones.
std::uint64_t key_of(const TransformedChild& child) {
  std::uint64_t key = child.node;
  key = key * 64 + child.transform.symmetry;
  for (int axis = 0; axis < 3; ++axis)
    key = key * 32 + static_cast<std::uint64_t>(child.transform.move[axis] + 16);
  return key;
}

struct Pointer {
  TransformedChild child;
  std::uint64_t count = 0;  ///< Of children that have it.
  int words = 0;
};

/// The pointers from one level to the next.
class LevelPointers {
 public:
  /// `height`: the children have 2^height voxels a side. Moves have types of their own if
  /// `has_moves` is true for any level, as in the authors' program.
  LevelPointers(const std::vector<TransformedNode>& nodes, int height, bool has_moves,
                const std::vector<std::uint64_t>& places) {
    for (const TransformedNode& node : nodes)
      for (const TransformedChild& child : node) {
        if (child.node == kNoNode) continue;
        const auto [found, is_new] = index_.try_emplace(key_of(child), pointers_.size());
        if (is_new) pointers_.push_back({child});
        ++pointers_[found->second].count;
      }
    const std::vector<int> code = make_code(has_moves);
    std::vector<std::size_t> order(pointers_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return pointers_[a].count > pointers_[b].count;
    });
    for (const std::size_t i : order) {
      Pointer& pointer = pointers_[i];
      const int type = type_of(pointer.child.transform, has_moves);
      const int bits = bits_after_place(pointer.child.transform, height) + code[type];
      choose_words(places[pointer.child.node], bits, pointer);
    }
  }

  int words_of(const TransformedChild& child) const {
    return pointers_[index_.at(key_of(child))].words;
  }
  std::uint64_t table_entries() const { return table_entries_; }

 private:
  static int type_of(const Transform& transform, bool has_moves) {
    return has_moves ? transform.symmetry * 8 + moved_axes(transform) : transform.symmetry;
  }

  /// Returns the length of the code word of each type.
  std::vector<int> make_code(bool has_moves) const {
    std::vector<std::uint64_t> frequencies(kSymmetries * (has_moves ? 8 : 1), 0);
    for (const Pointer& pointer : pointers_)
      ++frequencies[type_of(pointer.child.transform, has_moves)];
    return code_lengths(frequencies, kLongestCode);
  }

  static int bits_after_place(const Transform& transform, int height) {
    return std::popcount(static_cast<unsigned>(moved_axes(transform))) * (height + 1);
  }

  /// Decides whether the pointer enters the table. `bits` are those after the place.
  void choose_words(std::uint64_t place, int bits, Pointer& pointer) {
    // The place is in the highest bits. If it is 0, the bits after it may begin with zeros, which
    // the authors' program does not store; it is the place of one node, so they are counted here.
    const int encoded_bits = static_cast<int>(std::bit_width(place)) + bits;
    if (encoded_bits > 64) throw Error("a level is too large for a TSVDAG");
    const int in_place = std::max(2, words_of_bits(encoded_bits + 1));
    const int number = table_entries_ <= 0xFFFF
                           ? 1
                           : words_of_bits(static_cast<int>(std::bit_width(table_entries_)));
    const std::uint64_t table_cost = pointer.count * number + kTableEntryWords;
    const bool in_table = in_place > 3 || table_cost < pointer.count * in_place;
    pointer.words = in_table ? number : in_place;
    if (in_table) ++table_entries_;
  }

  std::unordered_map<std::uint64_t, std::size_t> index_;
  std::vector<Pointer> pointers_;
  std::uint64_t table_entries_ = 0;
};

}  // namespace

SizeInParts tsvdag_size(const TransformDag& dag) {
  if (dag.leaf_blocks.empty()) return {};
  std::uint64_t table_entries = 0;
  std::array<std::uint64_t, 4> words{};  // by words a pointer
  const std::uint64_t tag_words = place_levels(
      dag.nodes, dag.leaf_blocks.size(),
      [&](std::size_t level, const std::vector<std::uint64_t>& places) {
        LevelPointers pointers(dag.nodes[level], static_cast<int>(dag.nodes.size() - level) + 1,
                               dag.move_height > 0, places);
        table_entries += pointers.table_entries();
        return [&words, pointers = std::move(pointers)](const TransformedChild& child) {
          const auto size = static_cast<std::uint64_t>(pointers.words_of(child));
          words[size] += size;
          return size;
        };
      });
  return {{{"tags", 2 * tag_words},
           {"16-bit pointers", 2 * words[1]},
           {"32-bit pointers", 2 * words[2]},
           {"48-bit pointers", 2 * words[3]},
           {"pointer tables", 2 * kTableEntryWords * table_entries},
           {"leaves", 8 * dag.leaf_blocks.size()}}};
}

SizeInParts tsvdag_size(const SvdagView& dag, int move_height, const Progress& progress) {
  if (dag.is_empty()) return {};
  return tsvdag_size(merge_transformed(list_nodes(dag), move_height, progress));
}

}  // namespace voxdag::lab
