#include "lab/compact/merged_dag.hpp"

#include <algorithm>
#include <bit>

#include "lab/compact/symmetry.hpp"

namespace voxdag::lab {
namespace {

/// A set of symmetries: bit s stands for symmetry s.
using SymmetrySet = std::uint64_t;

/// A node as a row of numbers: 1 + 64 * representative + symmetry for each child, 0 without child.
using Key = std::array<std::uint64_t, 8>;

/// Finds the class of a key, with linear probing.
class KeyTable {
 public:
  KeyTable() : slots_(1 << 10, kNoNode) {}

  /// Returns the class of `key`, which is new if it is the number of classes before the call.
  std::uint32_t find_or_add(const Key& key) {
    if (keys_.size() * 2 > slots_.size()) grow();
    std::uint32_t& slot = slot_of(key);
    if (slot == kNoNode) {
      slot = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(key);
    }
    return slot;
  }

 private:
  std::uint32_t& slot_of(const Key& key) {
    std::uint64_t hash = 0;
    for (const std::uint64_t part : key) {
      hash = (hash ^ part) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
    std::size_t at = hash & (slots_.size() - 1);
    while (slots_[at] != kNoNode && keys_[slots_[at]] != key) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }

  void grow() {
    slots_.assign(slots_.size() * 2, kNoNode);
    for (std::size_t i = 0; i < keys_.size(); ++i)
      slot_of(keys_[i]) = static_cast<std::uint32_t>(i);
  }

  std::vector<std::uint32_t> slots_;
  std::vector<Key> keys_;
};

/// Returns the first symmetry that differs from `symmetry` by an invariance: symmetry * invariance.
std::uint8_t first_equal(std::uint8_t symmetry, SymmetrySet invariances) {
  if (invariances == 1) return symmetry;
  const auto& products = symmetry_group().product[symmetry];
  std::uint8_t first = symmetry;
  for (SymmetrySet rest = invariances; rest != 0; rest &= rest - 1)
    first = std::min(first, products[std::countr_zero(rest)]);
  return first;
}

/// Returns the mirrors that combine mirrors of single axes of the set.
SymmetrySet made_of_single_axes(SymmetrySet set) {
  SymmetrySet made = 0;
  for (int mirror = 0; mirror < kMirrors; ++mirror) {
    bool is_made = true;
    for (int axis = 0; axis < 3; ++axis)
      if (((mirror >> axis) & 1) != 0) is_made = is_made && ((set >> (1 << axis)) & 1) != 0;
    if (is_made) made |= SymmetrySet{1} << mirror;
  }
  return made;
}

/// Merges the nodes of one level.
class LevelMerge {
 public:
  /// `below` has the invariances of the representatives of the level below.
  LevelMerge(MergeRule rule, const std::vector<SymmetrySet>& below)
      : symmetries_(rule == MergeRule::kSymmetries ? kSymmetries : kMirrors), below_(below) {}

  /// Returns the image that a node is.
  MergedChild add(const MergedNode& node) {
    const SymmetryGroup& group = symmetry_group();
    SymmetrySet to_canonical = 0;
    const Key canonical = smallest_image(node, to_canonical);
    const auto first = static_cast<std::uint8_t>(std::countr_zero(to_canonical));
    const std::uint8_t back = group.inverse[first];
    const std::uint32_t found = table_.find_or_add(canonical);
    if (found == invariances.size()) {
      to_canonical_.push_back(first);
      SymmetrySet same = 0;
      for (SymmetrySet rest = to_canonical; rest != 0; rest &= rest - 1)
        same |= SymmetrySet{1} << group.product[back][std::countr_zero(rest)];
      invariances.push_back(same);
    }
    return {found, first_equal(group.product[back][to_canonical_[found]], invariances[found])};
  }

  std::vector<SymmetrySet> invariances;  ///< Of the representatives so far.

 private:
  /// Returns the smallest key of all images of the node, and all symmetries that give it.
  Key smallest_image(const MergedNode& node, SymmetrySet& symmetries) const {
    const SymmetryGroup& group = symmetry_group();
    std::uint8_t mask = 0;
    for (int i = 0; i < 8; ++i)
      if (node[i].node != kNoNode) mask = static_cast<std::uint8_t>(mask | 1 << i);
    std::uint8_t first_mask = 255;
    for (int s = 0; s < symmetries_; ++s) first_mask = std::min(first_mask, image_of_mask(s, mask));
    Key smallest{};
    symmetries = 0;
    for (int s = 0; s < symmetries_; ++s) {
      if (image_of_mask(s, mask) != first_mask) continue;
      Key key{};
      for (int i = 0; i < 8; ++i) {
        if (node[i].node == kNoNode) continue;
        const std::uint8_t symmetry =
            first_equal(group.product[s][node[i].symmetry], below_[node[i].node]);
        key[group.octant[s][i]] = 1 + 64 * std::uint64_t{node[i].node} + symmetry;
      }
      if (symmetries == 0 || key < smallest) {
        smallest = key;
        symmetries = 0;
      }
      if (key == smallest) symmetries |= SymmetrySet{1} << s;
    }
    return smallest;
  }

  int symmetries_;
  const std::vector<SymmetrySet>& below_;
  KeyTable table_;
  std::vector<std::uint8_t> to_canonical_;  ///< Of a representative, to the smallest image.
};

/// The merged 2³ masks: an octant of a leaf block is the image of one.
struct MergedMasks {
  std::array<MergedChild, 256> image;
  std::vector<SymmetrySet> invariances;
};

MergedMasks merge_masks(MergeRule rule) {
  // A mask is a node whose children are all alike.
  const std::vector<SymmetrySet> alike{rule == MergeRule::kSymmetries
                                           ? (SymmetrySet{1} << kSymmetries) - 1
                                           : (SymmetrySet{1} << kMirrors) - 1};
  LevelMerge merge(rule, alike);
  MergedMasks masks;
  for (int mask = 1; mask < 256; ++mask) {
    MergedNode node;
    for (int i = 0; i < 8; ++i)
      if (((mask >> i) & 1) != 0) node[i] = {0, 0};
    masks.image[mask] = merge.add(node);
  }
  masks.invariances = std::move(merge.invariances);
  return masks;
}

/// Restricts the invariances to those that the rule compares.
void restrict_to_rule(MergeRule rule, std::vector<SymmetrySet>& invariances) {
  if (rule != MergeRule::kPublishedMirrors) return;
  for (SymmetrySet& set : invariances) set = made_of_single_axes(set);
}

void throw_if_cancelled(const Progress& progress, std::size_t node) {
  if (node % 65536 == 0) progress.throw_if_cancelled();
}

}  // namespace

MergedDag merge_nodes(const DagNodes& dag, MergeRule rule, const Progress& progress) {
  MergedDag merged;
  const std::size_t inner_levels = dag.nodes.size();
  merged.nodes.resize(inner_levels);
  merged.image.resize(inner_levels + 1);

  MergedMasks masks = merge_masks(rule);
  restrict_to_rule(rule, masks.invariances);
  LevelMerge leaves(rule, masks.invariances);
  for (std::size_t i = 0; i < dag.leaf_blocks.size(); ++i) {
    throw_if_cancelled(progress, i);
    MergedNode node;
    for (int octant = 0; octant < 8; ++octant)
      node[octant] = masks.image[(dag.leaf_blocks[i] >> (8 * octant)) & 0xFF];
    merged.image[inner_levels].push_back(leaves.add(node));
    if (leaves.invariances.size() > merged.leaf_blocks.size())
      merged.leaf_blocks.push_back(dag.leaf_blocks[i]);
  }

  std::vector<SymmetrySet> below = std::move(leaves.invariances);
  for (std::size_t level = inner_levels; level-- > 0;) {
    restrict_to_rule(rule, below);
    LevelMerge merge(rule, below);
    for (std::size_t i = 0; i < dag.nodes[level].size(); ++i) {
      throw_if_cancelled(progress, i);
      MergedNode node;
      for (int octant = 0; octant < 8; ++octant)
        if (const std::uint32_t child = dag.nodes[level][i][octant]; child != kNoNode)
          node[octant] = merged.image[level + 1][child];
      merged.image[level].push_back(merge.add(node));
      if (merge.invariances.size() > merged.nodes[level].size())
        merged.nodes[level].push_back(node);
    }
    below = std::move(merge.invariances);
  }
  return merged;
}

}  // namespace voxdag::lab
