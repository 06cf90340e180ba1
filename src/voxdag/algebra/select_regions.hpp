#pragma once
/// Makes a DAG of selected regions (regions.hpp).
#include <map>
#include <vector>

#include "voxdag/algebra/regions.hpp"
#include "voxdag/algebra/rewrite.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Numbers different sets of regions. Set 0 is empty.
class RegionSets {
 public:
  RegionSets() : sets_{&numbers_.try_emplace({}, 0).first->first} {}
  RegionSets(const RegionSets&) = delete;
  RegionSets& operator=(const RegionSets&) = delete;

  /// Returns the number of the set of those i < count for which is_in(i) is true.
  template <class IsIn>
  std::uint32_t add(std::uint32_t count, const IsIn& is_in) {
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
  bool contains(std::uint32_t set, std::uint32_t i) const {
    const std::vector<bool>& bits = *sets_[set];
    return i < bits.size() && bits[i];
  }

 private:
  std::map<std::vector<bool>, std::uint32_t> numbers_;
  std::vector<const std::vector<bool>*> sets_;
};

/// Selects regions. A key is a node, which of its open regions are selected, as a set, and the
/// state of the selection there. A `Selection` has
///   kKeepsVoxels                             whether the result has the voxels of the source, too
///   is_open_selected(region)                 for the open regions of the root
///   is_closed_selected(level, node, region, state)
///   root_state(), state_below(state, child)  a number that selections may use; 0 if they do not
template <class Selection>
class SelectRule {
 public:
  static constexpr std::size_t kWords = 3;
  static constexpr bool kOneThread = true;  ///< children() numbers sets.
  using Key = std::array<std::uint32_t, kWords>;

  SelectRule(const Regions& regions, const Selection& selection)
      : regions_(regions), selection_(selection) {}

  Key root() const {
    const std::uint32_t root = regions_.source().root();
    if (root == kNoCell) return empty_key<kWords>();
    const std::uint32_t open = regions_.counts(0, root).open;
    return {root, sets_.add(open, [&](std::uint32_t i) { return selection_.is_open_selected(i); }),
            selection_.root_state()};
  }

  void children(int level, const Key& key, Key (&keys)[8]) const {
    if (key[0] == kWholeCell) {
      std::fill(std::begin(keys), std::end(keys), key);
      return;
    }
    const std::uint32_t open = regions_.counts(level, key[0]).open;
    for (int child = 0; child < 8; ++child) {
      const std::uint32_t node = regions_.source().child(level, key[0], child);
      const std::uint32_t set =
          sets_.add(regions_.counts(level + 1, node).open, [&](std::uint32_t i) {
            return is_selected(level, key, open, regions_.region_above(level, key[0], child, i));
          });
      if (node != kNoCell)
        keys[child] = {node, set, selection_.state_below(key[2], child)};
      else
        keys[child] = set != 0 ? Key{kWholeCell, 0, 0} : empty_key<kWords>();
    }
  }

  std::uint64_t block(const Key& key) const {
    if (key[0] == kWholeCell) return ~std::uint64_t{0};
    const int level = regions_.levels() - 2;
    const Regions::Counts counts = regions_.counts(level, key[0]);
    std::uint64_t voxels = Selection::kKeepsVoxels ? regions_.source().block(key[0]) : 0;
    for (std::uint32_t i = 0; i < counts.open + counts.closed; ++i)
      if (is_selected(level, key, counts.open, i)) voxels |= regions_.block_voxels(key[0], i);
    return voxels;
  }

 private:
  /// Stands in keys for a cell whose places are all selected.
  static constexpr std::uint32_t kWholeCell = kNoCell - 1;

  bool is_selected(int level, const Key& key, std::uint32_t open, std::uint32_t region) const {
    return region < open ? sets_.contains(key[1], region)
                         : selection_.is_closed_selected(level, key[0], region, key[2]);
  }

  const Regions& regions_;
  const Selection& selection_;
  mutable RegionSets sets_;
};

template <class Selection>
Svdag select_regions(const Regions& regions, const Selection& selection, Work work) {
  return rewrite(SelectRule<Selection>(regions, selection), regions.levels(), work);
}

}  // namespace voxdag
