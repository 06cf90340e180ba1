#include "voxdag/algebra/components.hpp"

#include <map>

#include "voxdag/algebra/regions.hpp"
#include "voxdag/algebra/rewrite.hpp"

namespace voxdag {
namespace {

/// Stands in keys for a cell whose places are all selected.
constexpr std::uint32_t kWholeCell = kNoCell - 1;

/// Selects regions of the grid. A key is a node, and which of its open regions are selected, as the
/// number of a set.
///
/// `Selection` has is_selected(region size, is open at the sides of the grid), and kKeepsVoxels:
/// whether the result has the voxels of the source, too.
template <class Selection>
class SelectRule {
 public:
  static constexpr std::size_t kWords = 2;
  using Key = std::array<std::uint32_t, kWords>;

  SelectRule(const Regions& regions, const Selection& selection)
      : regions_(regions), selection_(selection) {}

  Key root() const {
    const std::uint32_t root = regions_.source().root();
    if (root == kNoCell) return empty_key<kWords>();
    const std::uint32_t open = regions_.counts(0, root).open;
    return {root, set_of(open, [&](std::uint32_t i) {
              return selection_.is_selected(regions_.size(0, root, i), true);
            })};
  }

  void children(int level, const Key& key, Key (&keys)[8]) const {
    const SourceDag& source = regions_.source();
    const std::uint32_t open = key[0] == kWholeCell ? 0 : regions_.counts(level, key[0]).open;
    for (int child = 0; child < 8; ++child) {
      if (key[0] == kWholeCell) {
        keys[child] = key;
        continue;
      }
      const std::uint32_t node = source.child(level, key[0], child);
      const std::uint32_t set = set_of(regions_.counts(level + 1, node).open, [&](std::uint32_t i) {
        const std::uint32_t above = regions_.region_above(level, key[0], child, i);
        return above < open ? is_in(key[1], above)
                            : selection_.is_selected(regions_.size(level, key[0], above), false);
      });
      if (node != kNoCell)
        keys[child] = {node, set};
      else
        keys[child] = set != kNoSet ? Key{kWholeCell, 0} : empty_key<kWords>();
    }
  }

  std::uint64_t block(const Key& key) const {
    if (key[0] == kWholeCell) return ~std::uint64_t{0};
    const int level = regions_.levels() - 2;
    const Regions::Counts counts = regions_.counts(level, key[0]);
    std::uint64_t voxels = Selection::kKeepsVoxels ? regions_.source().block(key[0]) : 0;
    for (std::uint32_t i = 0; i < counts.open + counts.closed; ++i)
      if (i < counts.open ? is_in(key[1], i)
                          : selection_.is_selected(regions_.size(level, key[0], i), false))
        voxels |= regions_.block_voxels(key[0], i);
    return voxels;
  }

 private:
  static constexpr std::uint32_t kNoSet = 0;

  /// Returns the number of the set of those i < count for which is_in(i) is true.
  template <class IsIn>
  std::uint32_t set_of(std::uint32_t count, const IsIn& is_in) const {
    std::vector<bool> set;
    for (std::uint32_t i = 0; i < count; ++i)
      if (is_in(i)) {
        set.resize(i + 1);
        set[i] = true;
      }
    const auto added = numbers_.try_emplace(set, static_cast<std::uint32_t>(sets_.size()));
    if (added.second) sets_.push_back(&added.first->first);
    return added.first->second;
  }
  bool is_in(std::uint32_t set, std::uint32_t i) const {
    const std::vector<bool>& bits = *sets_[set];
    return i < bits.size() && bits[i];
  }

  const Regions& regions_;
  const Selection& selection_;
  // The different sets so far. The first one is empty.
  mutable std::map<std::vector<bool>, std::uint32_t> numbers_{{{}, kNoSet}};
  mutable std::vector<const std::vector<bool>*> sets_{&numbers_.begin()->first};
};

template <class Selection>
Svdag select(const Regions& regions, const Selection& selection, MemoryBudget* memory,
             Progress* progress) {
  return rewrite(SelectRule<Selection>(regions, selection), regions.levels(), memory, progress);
}

struct LargeComponents {
  static constexpr bool kKeepsVoxels = false;
  std::uint64_t least;

  bool is_selected(std::uint64_t size, bool) const { return size >= least; }
};

struct Cavities {
  static constexpr bool kKeepsVoxels = true;

  static bool is_selected(std::uint64_t, bool is_open) { return !is_open; }
};

}  // namespace

std::vector<ComponentSizes> component_sizes(const SvdagView& dag, Neighbours neighbours,
                                            MemoryBudget* memory, Progress* progress) {
  const Regions regions(dag, RegionKind::kVoxels, neighbours, memory, progress);
  std::map<std::uint64_t, std::uint64_t, std::greater<>> counts;
  if (dag.is_empty()) return {};
  const std::uint32_t root = regions.source().root();
  for (std::uint32_t i = 0; i < regions.counts(0, root).open; ++i)
    ++counts[regions.size(0, root, i)];
  // How often each node occurs, level after level.
  std::map<std::uint32_t, std::uint64_t> level_nodes{{root, 1}};
  for (int level = 0; level <= dag.levels - 2; ++level) {
    std::map<std::uint32_t, std::uint64_t> below;
    for (const auto& [node, times] : level_nodes) {
      const Regions::Counts of_node = regions.counts(level, node);
      for (std::uint32_t i = 0; i < of_node.closed; ++i)
        counts[regions.size(level, node, of_node.open + i)] += times;
      if (level == dag.levels - 2) continue;
      for (int child = 0; child < 8; ++child) {
        const std::uint32_t of_child = regions.source().child(level, node, child);
        if (of_child != kNoCell) below[of_child] += times;
      }
    }
    level_nodes = std::move(below);
  }
  std::vector<ComponentSizes> sizes;
  for (const auto& [voxels, count] : counts) sizes.push_back({voxels, count});
  return sizes;
}

Svdag keep_components(const SvdagView& dag, std::uint64_t least, Neighbours neighbours,
                      MemoryBudget* memory, Progress* progress) {
  const Regions regions(dag, RegionKind::kVoxels, neighbours, memory, progress);
  return select(regions, LargeComponents{least}, memory, progress);
}

Svdag fill_cavities(const SvdagView& dag, MemoryBudget* memory, Progress* progress) {
  const Regions regions(dag, RegionKind::kEmpty, Neighbours::k6, memory, progress);
  return select(regions, Cavities{}, memory, progress);
}

}  // namespace voxdag
