#include "voxdag/stored/svdag/wide_svdag.hpp"

#include <array>
#include <limits>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// The children of a wide node, indexed by their bit in its mask.
struct WideNode {
  std::uint64_t mask = 0;
  std::array<std::uint32_t, 64> children{};

  void set(int cell, std::uint32_t child) {
    mask |= std::uint64_t{1} << cell;
    children[static_cast<std::size_t>(cell)] = child;
  }
};

std::uint64_t linear_mask(std::uint64_t morton) {
  std::uint64_t linear = 0;
  for (; morton != 0; morton &= morton - 1) {
    const int i = lowest_bit64(morton);
    linear |= std::uint64_t{1} << wide_cell(i >> 3, i & 7);
  }
  return linear;
}

class WideMaker {
 public:
  explicit WideMaker(const SvdagView& dag) : dag_(dag) {}

  WideSvdag make() {
    wide_.levels = dag_.levels;
    if (dag_.is_empty()) return std::move(wide_);
    wide_.words.reserve(count_words());
    for (std::uint64_t i = 0; i < dag_.leaf_block_count; ++i)
      put_mask(linear_mask(dag_.leaf_blocks[i]));
    int level = dag_.levels - 4;
    for (; level >= 0; level -= 2) put_level(level);
    if (level == -1) put_root_of_odd_levels();
    return std::move(wide_);
  }

 private:
  /// Returns the word index of the wide node or leaf block for a pointer in a node of level `level`
  /// - 1.
  std::uint32_t wide_pointer(int level, std::uint32_t pointer) const {
    if (level == dag_.levels - 2) return 2 * pointer;
    return below_[pointer - dag_.level_begin[level]];
  }

  std::uint64_t count_words() const {
    std::uint64_t words = 2 * dag_.leaf_block_count;
    for (int level = dag_.levels - 4; level >= -1; level -= 2) {
      if (level < 0) {
        words += 2 + 64;
        continue;
      }
      for_each_node(level, [&](const std::uint32_t* node) {
        words += 2;
        const int children = popcount8(child_mask(node));
        for (int i = 0; i < children; ++i)
          words += static_cast<std::uint64_t>(popcount8(child_mask(dag_.nodes + node[1 + i])));
      });
    }
    if (words > std::numeric_limits<std::uint32_t>::max())
      throw Error("the DAG is too large for the wide layout: it needs more than 2^32 words");
    return words;
  }

  template <class Visit>
  void for_each_node(int level, const Visit& visit) const {
    const std::uint32_t* node = dag_.nodes + dag_.level_begin[level];
    const std::uint32_t* const end = dag_.nodes + dag_.level_begin[level + 1];
    for (; node != end; node += 1 + popcount8(child_mask(node))) visit(node);
  }

  void put_mask(std::uint64_t mask) {
    wide_.words.push_back(static_cast<std::uint32_t>(mask));
    wide_.words.push_back(static_cast<std::uint32_t>(mask >> 32));
  }

  std::uint32_t put(const WideNode& node) {
    const auto at = static_cast<std::uint32_t>(wide_.words.size());
    put_mask(node.mask);
    for (std::uint64_t rest = node.mask; rest != 0; rest &= rest - 1)
      wide_.words.push_back(node.children[static_cast<std::size_t>(lowest_bit64(rest))]);
    return at;
  }

  void put_level(int level) {
    std::vector<std::uint32_t> here(dag_.level_begin[level + 1] - dag_.level_begin[level]);
    for_each_node(level, [&](const std::uint32_t* node) {
      WideNode wide;
      for (int outer = 0; outer < 8; ++outer) {
        if ((child_mask(node) >> outer & 1u) == 0) continue;
        const std::uint32_t* const child = dag_.nodes + child_pointer(node, outer);
        for (int inner = 0; inner < 8; ++inner)
          if ((child_mask(child) >> inner & 1u) != 0)
            wide.set(wide_cell(outer, inner), wide_pointer(level + 2, child_pointer(child, inner)));
      }
      here[static_cast<std::size_t>(node - (dag_.nodes + dag_.level_begin[level]))] = put(wide);
    });
    below_ = std::move(here);
    wide_.root = below_.empty() ? 0 : below_[0];
  }

  void put_root_of_odd_levels() {
    WideNode wide;
    for (int outer = 0; outer < 8; ++outer)
      for (int inner = 0; inner < 8; ++inner)
        if ((child_mask(dag_.nodes) >> inner & 1u) != 0)
          wide.set(wide_cell(outer, inner), wide_pointer(1, child_pointer(dag_.nodes, inner)));
    wide_.root = put(wide);
  }

  const SvdagView& dag_;
  WideSvdag wide_;
  std::vector<std::uint32_t> below_;  ///< The wide node of each word of the last finished level.
};

}  // namespace

WideSvdag make_wide_svdag(const SvdagView& dag) { return WideMaker(dag).make(); }

}  // namespace voxdag
