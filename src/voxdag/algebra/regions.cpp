#include "voxdag/algebra/regions.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "voxdag/algebra/cell_neighbours.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

/// Sets of numbers that grow together.
class DisjointSets {
 public:
  void reset(std::size_t count) {
    parents_.resize(count);
    std::iota(parents_.begin(), parents_.end(), 0u);
  }
  /// Returns the least number of the set.
  std::uint32_t find(std::uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    if (a < b)
      parents_[b] = a;
    else
      parents_[a] = b;
  }

 private:
  std::vector<std::uint32_t> parents_;
};

template <class T>
void remove_copies(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

std::uint64_t cell_voxels(int levels, int level) {
  return std::uint64_t{1} << (3 * (levels - level));
}

}  // namespace

Regions::Regions(const SvdagView& dag, RegionKind kind, Neighbours neighbours, Work work)
    : source_(dag),
      levels_(dag.levels),
      kind_(kind),
      neighbours_(neighbours),
      work_(work),
      block_voxels_(work.memory) {
  for (int level = 0; level <= levels_ - 2; ++level) {
    nodes_.emplace_back(work.memory);
    regions_.emplace_back(work.memory);
    above_.emplace_back(work.memory);
    pairs_.emplace_back(work.memory);
  }
  if (dag.is_empty()) return;
  number_nodes(dag);
  find_blocks(dag);
  for (int level = levels_ - 3; level >= 0; --level) find_nodes(dag, level);
  pairs_.clear();
}

void Regions::number_nodes(const SvdagView& dag) {
  for (int level = 0; level < levels_ - 2; ++level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
    level_begin_.push_back(begin);
    CountedVector<std::uint32_t>& numbers = numbers_.emplace_back(end - begin, 0u, work_.memory);
    std::uint32_t number = 0;
    for (std::uint64_t word = begin; word < end;
         word += 1 + static_cast<std::uint64_t>(std::popcount(child_mask(dag.nodes + word))))
      numbers[word - begin] = number++;
  }
}

void Regions::add_node(int level, const std::vector<Region>& regions, std::uint64_t first_above,
                       bool has_closed_below) {
  const auto l = static_cast<std::size_t>(level);
  Node node{0, 0, has_closed_below, regions_[l].size(), first_above};
  for (const Region& region : regions) ++(region.sides != 0 ? node.open : node.closed);
  node.has_closed |= node.closed > 0;
  regions_[l].insert(regions_[l].end(), regions.begin(), regions.end());
  nodes_[l].push_back(node);
}

void Regions::find_blocks(const SvdagView& dag) {
  const VoxelNeighbours& near = voxel_neighbours(neighbours_);
  std::vector<Region> regions;
  std::vector<std::uint64_t> voxels;
  for (std::uint64_t block = 0; block < dag.leaf_block_count; ++block) {
    work_.poll_seldom(block);
    regions.clear();
    voxels.clear();
    std::size_t open = 0;
    const std::uint64_t set = dag.leaf_blocks[block];
    for (std::uint64_t left = kind_ == RegionKind::kVoxels ? set : ~set; left != 0;) {
      std::uint64_t region = 0, added = left & (~left + 1);
      while (added != 0) {
        region |= added;
        std::uint64_t reached = 0;
        for (std::uint64_t rest = added; rest != 0; rest &= rest - 1)
          reached |= near.within[std::countr_zero(rest)];
        added = reached & left & ~region;
      }
      left &= ~region;
      Region found{static_cast<std::uint64_t>(std::popcount(region)), 0};
      for (int side = 0; side < 6; ++side)
        if ((region & near.side[side]) != 0) found.sides |= static_cast<std::uint8_t>(1 << side);
      // Open regions come first.
      const std::size_t place = found.sides != 0 ? open++ : regions.size();
      regions.insert(regions.begin() + static_cast<std::ptrdiff_t>(place), found);
      voxels.insert(voxels.begin() + static_cast<std::ptrdiff_t>(place), region);
    }
    block_voxels_.insert(block_voxels_.end(), voxels.begin(), voxels.end());
    add_node(levels_ - 2, regions, 0, false);
  }
}

void Regions::find_nodes(const SvdagView& dag, int level) {
  const ChildPairs& tables = child_pairs(neighbours_);
  const auto l = static_cast<std::size_t>(level);
  DisjointSets sets;
  std::vector<Touch> touches;
  std::vector<Region> members, regions;
  std::vector<std::uint32_t> numbers;
  std::uint64_t polled = 0;
  for (std::uint64_t word = dag.level_begin[level]; word < dag.level_begin[level + 1];
       word += 1 + static_cast<std::uint64_t>(std::popcount(child_mask(dag.nodes + word)))) {
    work_.poll_seldom(polled++);
    const auto node = static_cast<std::uint32_t>(word);
    std::uint32_t children[8], begin[9];
    members.clear();
    bool has_closed_below = false;
    for (int child = 0; child < 8; ++child) {
      children[child] = source_.child(level, node, child);
      has_closed_below |= has_closed(level + 1, children[child]);
      begin[child] = static_cast<std::uint32_t>(members.size());
      const int outer = (child & 1 ? 2 : 1) | (child & 2 ? 8 : 4) | (child & 4 ? 32 : 16);
      if (is_whole(children[child])) {
        members.push_back({cell_voxels(levels_, level + 1), static_cast<std::uint8_t>(outer)});
      } else if (children[child] != kNoCell) {
        const Node& below = record(level + 1, children[child]);
        for (std::uint32_t i = 0; i < below.open; ++i) {
          Region region = regions_[l + 1][below.first_region + i];
          region.sides &= static_cast<std::uint8_t>(outer);
          members.push_back(region);
        }
      }
    }
    begin[8] = static_cast<std::uint32_t>(members.size());
    sets.reset(members.size());
    // Returns whether nothing is left to join: no regions, or regions of one set.
    const auto are_joined = [&](int a, int b) {
      if (begin[a] == begin[a + 1] || begin[b] == begin[b + 1]) return true;
      const std::uint32_t set = sets.find(begin[a]);
      for (const int child : {a, b})
        for (std::uint32_t i = begin[child]; i < begin[child + 1]; ++i)
          if (sets.find(i) != set) return false;
      return true;
    };
    for (const ChildPair& pair : tables.within) {
      if (are_joined(pair.a, pair.b)) continue;
      touches.clear();
      const int first = pair.is_swapped ? pair.b : pair.a,
                second = pair.is_swapped ? pair.a : pair.b;
      add_touches(level + 1, children[first], children[second], pair.direction, touches);
      for (const Touch& touch : touches)
        sets.join(begin[first] + touch.first, begin[second] + touch.second);
    }
    // The first member of a set collects its size and sides.
    for (std::uint32_t i = 0; i < members.size(); ++i) {
      const std::uint32_t first = sets.find(i);
      if (first == i) continue;
      members[first].size += members[i].size;
      members[first].sides |= members[i].sides;
    }
    regions.clear();
    numbers.assign(members.size(), 0);
    for (const bool is_open : {true, false})
      for (std::uint32_t i = 0; i < members.size(); ++i) {
        if (sets.find(i) != i || (members[i].sides != 0) != is_open) continue;
        numbers[i] = static_cast<std::uint32_t>(regions.size());
        regions.push_back(members[i]);
      }
    const std::uint64_t first_above = above_[l].size();
    above_[l].insert(above_[l].end(), std::begin(begin), std::end(begin));
    for (std::uint32_t i = 0; i < members.size(); ++i) above_[l].push_back(numbers[sets.find(i)]);
    add_node(level, regions, first_above, has_closed_below);
  }
}

const Regions::Node& Regions::record(int level, std::uint32_t node) const {
  const auto l = static_cast<std::size_t>(level);
  return nodes_[l][level == levels_ - 2 ? node : numbers_[l][node - level_begin_[l]]];
}

Regions::Counts Regions::counts(int level, std::uint32_t node) const {
  if (is_whole(node)) return {1, 0};
  if (node == kNoCell) return {};
  const Node& of_node = record(level, node);
  return {of_node.open, of_node.closed};
}

std::uint64_t Regions::size(int level, std::uint32_t node, std::uint32_t region) const {
  if (is_whole(node)) return cell_voxels(levels_, level);
  return regions_[static_cast<std::size_t>(level)][record(level, node).first_region + region].size;
}

std::uint32_t Regions::region_above(int level, std::uint32_t node, int child,
                                    std::uint32_t region) const {
  return node == kNoCell ? 0 : regions_above(level, node).of(child, region);
}

Regions::RegionsAbove Regions::regions_above(int level, std::uint32_t node) const {
  return {above_[static_cast<std::size_t>(level)].data() + record(level, node).first_above};
}

Vec3i Regions::place_in(int level, std::uint32_t node, std::uint32_t region) const {
  Vec3i at;
  while (node != kNoCell && level < levels_ - 2) {
    const std::int32_t half = std::int32_t{1} << (levels_ - level - 1);
    bool is_found = false;
    for (int child = 0; child < 8 && !is_found; ++child) {
      const std::uint32_t below = source_.child(level, node, child);
      const std::uint32_t open = counts(level + 1, below).open;
      for (std::uint32_t i = 0; i < open && !is_found; ++i) {
        if (region_above(level, node, child, i) != region) continue;
        at = at + child_offset(child) * half;
        node = below;
        region = i;
        is_found = true;
      }
    }
    ++level;
  }
  if (node == kNoCell) return at;
  return at + voxel_at(std::countr_zero(block_voxels(node, region)));
}

std::uint64_t Regions::block_voxels(std::uint32_t block, std::uint32_t region) const {
  if (block == kNoCell) return ~std::uint64_t{0};
  return block_voxels_[record(levels_ - 2, block).first_region + region];
}

void Regions::add_touches(int level, std::uint32_t a, std::uint32_t b, int direction,
                          std::vector<Touch>& touches) {
  if (is_whole(a) && is_whole(b)) {
    touches.push_back({0, 0});
  } else if (counts(level, a).open == 0 || counts(level, b).open == 0) {
    return;
  } else if ((is_whole(a) || is_whole(b)) && is_face(kSteps[static_cast<std::size_t>(direction)])) {
    // A whole cell touches all regions at the common side.
    const bool is_a_whole = is_whole(a);
    const Node& node = record(level, is_a_whole ? b : a);
    const int axis = step_axis(kSteps[static_cast<std::size_t>(direction)]);
    const int side = 1 << (2 * axis + (is_a_whole ? 0 : 1));
    for (std::uint32_t i = 0; i < node.open; ++i)
      if ((regions_[static_cast<std::size_t>(level)][node.first_region + i].sides & side) != 0)
        touches.push_back(is_a_whole ? Touch{0, i} : Touch{i, 0});
  } else if (level == levels_ - 2) {
    add_touches_of_blocks(a, b, direction, touches);
  } else {
    const List list = touches_of_nodes(level, a, b, direction);
    const CountedVector<Touch>& known = pairs_[static_cast<std::size_t>(level)].touches;
    const auto first = known.begin() + static_cast<std::ptrdiff_t>(list.begin);
    touches.insert(touches.end(), first, first + list.count);
  }
}

Regions::List Regions::touches_of_nodes(int level, std::uint32_t a, std::uint32_t b,
                                        int direction) {
  Pairs& pairs = pairs_[static_cast<std::size_t>(level)];
  const std::uint32_t number = pairs.keys.add({a, b, static_cast<std::uint32_t>(direction)});
  if (number < pairs.lists.size()) return pairs.lists[number];
  pairs.lists.push_back({});
  // A whole cell has one region, of which each child is a part.
  static constexpr std::uint32_t kWhole[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 0, 0, 0, 0, 0};
  const RegionsAbove above_a = a == kNoCell ? RegionsAbove{kWhole} : regions_above(level, a);
  const RegionsAbove above_b = b == kNoCell ? RegionsAbove{kWhole} : regions_above(level, b);
  std::vector<Touch> below, touches;
  const std::uint64_t most = std::uint64_t{counts(level, a).open} * counts(level, b).open;
  for (const ChildPair& pair :
       child_pairs(neighbours_).across[static_cast<std::size_t>(direction)]) {
    const std::uint32_t child_a = source_.child(level, a, pair.a),
                        child_b = source_.child(level, b, pair.b);
    const auto touch_above = [&](Touch touch) {
      return Touch{above_a.of(pair.a, touch.first), above_b.of(pair.b, touch.second)};
    };
    const std::uint64_t pairs_below = std::uint64_t{above_a.count(pair.a)} * above_b.count(pair.b);
    if (pairs_below == 0) continue;
    if (pairs_below == 1 &&
        std::find(touches.begin(), touches.end(), touch_above({0, 0})) != touches.end())
      continue;
    below.clear();
    if (pair.is_swapped)
      add_touches(level + 1, child_b, child_a, pair.direction, below);
    else
      add_touches(level + 1, child_a, child_b, pair.direction, below);
    for (Touch touch : below) {
      if (pair.is_swapped) std::swap(touch.first, touch.second);
      touches.push_back(touch_above(touch));
    }
    if (touches.size() < most) continue;
    remove_copies(touches);
    if (touches.size() == most) break;
  }
  remove_copies(touches);
  const List list{pairs.touches.size(), static_cast<std::uint32_t>(touches.size())};
  pairs.touches.insert(pairs.touches.end(), touches.begin(), touches.end());
  return pairs.lists[number] = list;
}

void Regions::add_touches_of_blocks(std::uint32_t a, std::uint32_t b, int direction,
                                    std::vector<Touch>& touches) const {
  const auto& across = voxel_neighbours(neighbours_).across[direction];
  const std::uint32_t open_a = counts(levels_ - 2, a).open, open_b = counts(levels_ - 2, b).open;
  for (std::uint32_t i = 0; i < open_a; ++i) {
    std::uint64_t reached = 0;
    for (std::uint64_t rest = block_voxels(a, i); rest != 0; rest &= rest - 1)
      reached |= across[std::countr_zero(rest)];
    for (std::uint32_t k = 0; k < open_b && reached != 0; ++k)
      if ((reached & block_voxels(b, k)) != 0) touches.push_back({i, k});
  }
}

}  // namespace voxdag
