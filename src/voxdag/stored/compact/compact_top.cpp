#include "voxdag/stored/compact/compact_top.hpp"

#include <limits>

#include "voxdag/stored/compact/compact_errors.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kNotPlaced = std::numeric_limits<std::uint32_t>::max();

/// Walks the compact DAG depth first, which meets the nodes of each level in canonical order.
class TopReader {
 public:
  TopReader(const CompactSvdagView& compact, Work work)
      : compact_(compact), work_(work), unit_level_(compact.coded_levels() - 4) {
    for (int level = 0; level < unit_level_; ++level) top_.levels.emplace_back(work.memory);
    for (int level = 0; level <= unit_level_; ++level)
      places_.emplace_back(compact.shared_nodes(level), kNotPlaced, work.memory);
    top_.units = CountedVector<CompactRange>(work.memory);
  }

  CompactTop read() {
    place_node(0, root_node(compact_));
    return std::move(top_);
  }

 private:
  static std::size_t at(int level) { return static_cast<std::size_t>(level); }

  /// Appends a node and what is below it, down to the units. Returns the node's first word in its
  /// level, or the unit's place.
  std::uint32_t place_node(int level, CompactRange range) {
    if (level == unit_level_) {
      if (top_.units.size() >= kNotPlaced) fail_too_large();
      top_.units.push_back(range);
      return static_cast<std::uint32_t>(top_.units.size() - 1);
    }
    CountedVector<std::uint32_t>& words = top_.levels[at(level)];
    work_.poll_seldom(++nodes_);
    CompactNode node;
    if (read_node(compact_, range, level, node) != CompactFault::kNone) fail_broken_stream();
    const std::size_t place = words.size();
    if (place > kNotPlaced - 16) fail_too_large();
    words.resize(place + static_cast<std::size_t>(1 + popcount8(node.mask)));
    words[place] = node.mask;
    std::size_t word = place + 1;
    for (int i = 0; i < 8; ++i) {
      if ((node.mask >> i & 1) == 0) continue;
      const bool is_shared = (node.inline_mask >> i & 1) == 0;
      const std::uint32_t child = is_shared ? place_shared(level + 1, node.shared[i])
                                            : place_node(level + 1, node.children[i]);
      words[word++] = child;
    }
    return static_cast<std::uint32_t>(place);
  }

  std::uint32_t place_shared(int level, std::uint32_t number) {
    if (places_[at(level)][number] == kNotPlaced) {
      const std::uint32_t place = place_node(level, shared_node(compact_, level, number));
      places_[at(level)][number] = place;
    }
    return places_[at(level)][number];
  }

  const CompactSvdagView& compact_;
  Work work_;
  int unit_level_;
  std::uint64_t nodes_ = 0;
  CompactTop top_;
  std::vector<CountedVector<std::uint32_t>> places_;  ///< Places of the shared nodes, by level.
};

}  // namespace

CompactTop expand_top(const CompactSvdagView& compact, Work work) {
  return TopReader(compact, work).read();
}

}  // namespace voxdag
