#include "voxdag/builders/esvo/encode/pack_blocks.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "voxdag/builders/esvo/encode/contour_pool.hpp"
#include "voxdag/builders/esvo/encode/encode_pair.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Decides for each node whether its children begin a block of their own.
struct Cut {
  std::vector<std::uint32_t> slots;  ///< Slots below the node in the node's own block.
  std::vector<bool> is_cut;          ///< The node's children are in another block than the node.
};

/// Calls body(child node) for each inner child that is a node of the tree.
template <class Body>
void for_each_child(const EsvoTree& tree, std::uint32_t node, const Body& body) {
  const EsvoNode& n = tree.nodes[node];
  if (n.is_packed) return;
  for (std::uint32_t i = 0; i < n.inner_count(); ++i) body(n.first_child + i);
}

/// Returns the number of slots of one group of siblings: descriptors, their far pointers, a gap.
std::uint32_t group_slots(std::uint32_t descriptors, std::uint32_t far_pointers) {
  return (descriptors + far_pointers + 1) & ~1u;
}

Cut cut_blocks(const EsvoTree& tree, std::uint32_t max_slots) {
  Cut cut;
  cut.slots.resize(tree.nodes.size());
  cut.is_cut.resize(tree.nodes.size());
  for (auto node = static_cast<std::uint32_t>(tree.nodes.size()); node-- > 0;) {
    const EsvoNode& n = tree.nodes[node];
    cut.is_cut[node] = n.is_packed;
    if (n.is_packed || n.inner_count() == 0) continue;
    const auto sum = [&] {
      std::uint32_t far_pointers = 0, below = 0;
      for_each_child(tree, node, [&](std::uint32_t child) {
        far_pointers += cut.is_cut[child] ? 1 : 0;
        below += cut.slots[child];
      });
      return group_slots(n.inner_count(), far_pointers) + below;
    };
    while ((cut.slots[node] = sum()) > max_slots) {
      std::uint32_t heaviest = n.first_child;
      for_each_child(tree, node, [&](std::uint32_t child) {
        if (cut.slots[child] > cut.slots[heaviest]) heaviest = child;
      });
      if (cut.slots[heaviest] == 0) break;
      cut.is_cut[heaviest] = true;
      cut.slots[heaviest] = 0;
    }
  }
  return cut;
}

/// The slots of each node in its block, counted from the block's begin. 0 means none.
struct Placement {
  explicit Placement(std::size_t nodes) : children(nodes), far_pointer(nodes) {}
  std::vector<std::uint32_t> children;     ///< Slot of the node's first child.
  std::vector<std::uint32_t> far_pointer;  ///< Slot of the far pointer to the children.
};

/// Writes one block.
class BlockWriter {
 public:
  BlockWriter(const EsvoTree& tree, const Cut& cut, Placement& placement)
      : tree_(tree), cut_(cut), placement_(placement) {}

  /// Assigns slots to the children of `node` and to all below them in this block, depth first.
  void place(std::uint32_t node) {
    std::vector<std::uint32_t> stack{node};
    while (!stack.empty()) {
      const std::uint32_t top = stack.back();
      stack.pop_back();
      place_group(top);
      const EsvoNode& n = tree_.nodes[top];
      for (std::uint32_t i = n.inner_count(); i-- > 0;) {
        const std::uint32_t child = n.first_child + i;
        if (!cut_.is_cut[child] && tree_.nodes[child].inner_count() > 0) stack.push_back(child);
      }
    }
    resize((slots_.size() + 1) / 2 * 2);
  }

  /// Fills in the descriptors and everything after them. For a node whose children are in another
  /// block, `target(node)` returns the slot of the first child, counted from this block's begin.
  template <class Target>
  std::vector<std::uint64_t> finish(const PackOptions& options, const Target& target) {
    EsvoBlockInfo info{};
    info.descriptor_slots = static_cast<std::uint32_t>(slots_.size());
    info.first_descriptor = first_;
    const bool with_values = tree_.has_values();
    const PlacedContours placed = place_contours();
    const std::vector<Contour>& contours = placed.pool.contours();
    info.contour_begin =
        info.descriptor_slots + static_cast<std::uint32_t>(sizeof(EsvoBlockInfo) / 8);
    info.contour_count = static_cast<std::uint32_t>(contours.size());
    std::uint32_t end = info.contour_begin + (info.contour_count + 1) / 2;
    const auto attach = [&](EsvoAttachmentKind kind, std::uint32_t slots_per_pair) {
      const std::uint32_t pairs = info.descriptor_slots / 2;
      info.attachments[info.attachment_count++] = {kind, end, slots_per_pair, pairs};
      end += pairs * slots_per_pair;
    };
    if (with_values && options.with_colors) attach(EsvoAttachmentKind::kColors, 1);
    if (with_values && options.with_normals) attach(EsvoAttachmentKind::kNormals, 2);
    info.slots = (end + kEsvoPageSlots - 1) / kEsvoPageSlots * kEsvoPageSlots;
    slots_.resize(info.slots);

    write_descriptors(info, placed.first, target);
    if (!contours.empty())
      std::memcpy(slots_.data() + info.contour_begin, contours.data(),
                  contours.size() * sizeof(Contour));
    for (std::uint32_t page = 0; page < info.descriptor_slots; page += kEsvoPageSlots)
      slots_[page] = info.descriptor_slots - page;
    for (std::uint32_t i = 0; i < info.attachment_count; ++i) write_attachment(info.attachments[i]);
    std::memcpy(slots_.data() + info.descriptor_slots, &info, sizeof info);
    return std::move(slots_);
  }

  std::uint32_t first_descriptor() const { return first_; }

  /// Calls body(node, slot of its descriptor) for each node whose children are in another block.
  template <class Body>
  void for_each_far(const Body& body) const {
    for (std::uint32_t slot = 0; slot < node_at_.size(); ++slot)
      if (node_at_[slot] != kNone && is_far(node_at_[slot])) body(node_at_[slot], slot);
  }

 private:
  void place_group(std::uint32_t node) {
    const EsvoNode& n = tree_.nodes[node];
    const std::uint32_t count = n.inner_count();
    auto at = static_cast<std::uint32_t>(slots_.size());
    // Both descriptors of a pair must have the same parent. Far pointers and page headers may share
    // a pair with any descriptor.
    if (at % 2 == 1 && node_at_.back() != kNone) ++at;
    if (at % kEsvoPageSlots == 0 || at / kEsvoPageSlots != (at + count - 1) / kEsvoPageSlots)
      at = (at + kEsvoPageSlots - 1) / kEsvoPageSlots * kEsvoPageSlots + 1;
    resize(at + count);
    if (first_ == 0) first_ = at;
    placement_.children[node] = at;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t child = n.first_child + i;
      node_at_[at + i] = child;
      if (!is_far(child)) continue;
      const std::size_t far = slots_.size() + (slots_.size() % kEsvoPageSlots == 0 ? 1 : 0);
      resize(far + 1);
      placement_.far_pointer[child] = static_cast<std::uint32_t>(far);
    }
  }

  void resize(std::size_t slots) {
    slots_.resize(slots);
    node_at_.resize(slots, kNone);
  }

  bool is_far(std::uint32_t node) const {
    return cut_.is_cut[node] && tree_.nodes[node].inner_count() > 0;
  }

  struct PlacedContours {
    ContourPool pool;
    std::vector<std::uint32_t> first;  ///< Index of the list of the descriptor in each slot.
  };

  PlacedContours place_contours() const {
    PlacedContours placed;
    placed.first.resize(node_at_.size());
    std::vector<std::uint32_t> by_count[9];
    for (std::uint32_t slot = 0; slot < node_at_.size(); ++slot)
      if (node_at_[slot] != kNone)
        by_count[std::popcount(std::uint32_t{tree_.nodes[node_at_[slot]].contour_mask})].push_back(
            slot);
    for (std::size_t count = 8; count > 0; --count)
      for (const std::uint32_t slot : by_count[count])
        placed.first[slot] = placed.pool.add(
            {tree_.contours.data() + tree_.nodes[node_at_[slot]].first_contour, count});
    return placed;
  }

  template <class Target>
  void write_descriptors(EsvoBlockInfo& info, const std::vector<std::uint32_t>& first_contour,
                         const Target& target) {
    for (std::uint32_t slot = 0; slot < info.descriptor_slots; ++slot) {
      const std::uint32_t node = node_at_[slot];
      if (node == kNone) continue;
      const EsvoNode& n = tree_.nodes[node];
      ++info.descriptors;
      ChildDescriptor descriptor = ChildDescriptor::make(n.valid_mask, n.leaf_mask, n.contour_mask);
      if (is_far(node)) {
        const std::int64_t distance = target(node) - std::int64_t{slot};
        if (distance != static_cast<std::int32_t>(distance))
          throw Error("", "",
                      "the octree is larger than 16 GiB, the most that far pointers can address");
        const std::uint32_t at = placement_.far_pointer[node];
        slots_[at] = static_cast<std::uint32_t>(static_cast<std::int32_t>(distance));
        descriptor.set_child_pointer(at - slot, true);
        ++info.far_pointers;
      } else if (n.inner_count() > 0) {
        descriptor.set_child_pointer(placement_.children[node] - slot, false);
      }
      if (n.contour_mask != 0)
        descriptor.set_contour_pointer(2 * info.contour_begin + first_contour[slot] - 2 * slot);
      slots_[slot] = descriptor.to_slot();
    }
  }

  void write_attachment(const EsvoAttachment& attachment) {
    for (std::uint32_t pair = 0; pair < attachment.count; ++pair) {
      PairValues values;
      for (std::uint32_t half = 0; half < 2; ++half) {
        const std::uint32_t node = node_at_[2 * pair + half];
        if (node == kNone) continue;
        const EsvoNode& n = tree_.nodes[node];
        const VoxelValue* value = tree_.values.data() + n.first_value;
        for (std::uint32_t left = n.valid_mask; left != 0; left &= left - 1) {
          const auto child = static_cast<std::uint32_t>(std::countr_zero(left));
          values.set(8 * half + child, *value++, (n.leaf_mask >> child & 1u) != 0);
        }
      }
      if (values.mask == 0) continue;
      std::uint64_t* const at = slots_.data() + attachment.begin + pair * attachment.slots_per_pair;
      if (attachment.kind == EsvoAttachmentKind::kColors)
        encode_pair_colors(values, at);
      else
        encode_pair_normals(values, at);
    }
  }

  const EsvoTree& tree_;
  const Cut& cut_;
  Placement& placement_;
  std::vector<std::uint64_t> slots_;
  std::vector<std::uint32_t> node_at_;  // node of the descriptor in each slot, or kNone
  std::uint32_t first_ = 0;
};

/// The cell of a node that begins a block, found from the path up to the root.
struct NodeCell {
  int level;
  Vec3i cell;
};

std::vector<std::uint32_t> find_parents(const EsvoTree& tree) {
  std::vector<std::uint32_t> parents(tree.nodes.size(), kNone);
  for (std::uint32_t node = 0; node < tree.nodes.size(); ++node)
    for_each_child(tree, node, [&](std::uint32_t child) { parents[child] = node; });
  return parents;
}

NodeCell cell_of(const EsvoTree& tree, const std::vector<std::uint32_t>& parents,
                 std::uint32_t node, NodeCell root) {
  std::vector<int> way;
  for (std::uint32_t at = node; parents[at] != kNone; at = parents[at]) {
    const EsvoNode& parent = tree.nodes[parents[at]];
    std::uint32_t left = parent.inner_mask();
    for (std::uint32_t i = parent.first_child; i < at; ++i) left &= left - 1;
    way.push_back(std::countr_zero(left));
  }
  for (std::size_t i = way.size(); i-- > 0;) {
    ++root.level;
    root.cell = root.cell * 2 + child_offset(way[i]);
  }
  return root;
}

EsvoCounts count_voxels(const EsvoTree& tree, const std::vector<std::uint32_t>& parents,
                        int level) {
  EsvoCounts counts;
  std::vector<std::int8_t> levels(tree.nodes.size(), static_cast<std::int8_t>(level));
  for (std::size_t node = 1; node < tree.nodes.size(); ++node) {
    levels[node] = static_cast<std::int8_t>(levels[parents[node]] + 1);
    const EsvoNode& n = tree.nodes[node];
    const auto below = static_cast<std::size_t>(levels[node] + 1);
    const auto count = [](std::uint32_t mask) {
      return static_cast<std::uint64_t>(std::popcount(mask));
    };
    counts.voxels_per_level[below] += count(n.valid_mask);
    counts.leaves_per_level[below] += count(n.leaf_mask);
    counts.contours += count(n.contour_mask);
    ++counts.descriptors;
  }
  return counts;
}

}  // namespace

std::uint64_t packed_slots(const EsvoTree& tree) {
  std::uint64_t slots = 0;
  for (const EsvoNode& n : tree.nodes) slots += group_slots(n.inner_count(), 0);
  return slots;
}

PackedBlocks pack_blocks(const EsvoTree& tree, int level, Vec3i cell, std::uint64_t position,
                         const PackOptions& options) {
  assert(!tree.nodes.empty() && !tree.nodes[0].is_packed && tree.nodes[0].inner_count() > 0);
  assert(options.max_slots <= 1u << 14);
  Cut cut = cut_blocks(tree, options.max_slots);
  cut.is_cut[0] = true;
  const std::vector<std::uint32_t> parents = find_parents(tree);

  PackedBlocks result;
  result.counts = count_voxels(tree, parents, level);
  Placement placement(tree.nodes.size());
  // For each node: the index of its first child in result.slots, and the block that begins there.
  std::vector<std::uint64_t> first_child(tree.nodes.size());
  std::vector<std::uint32_t> block_of(tree.nodes.size(), kNone);
  for (auto node = static_cast<std::uint32_t>(tree.nodes.size()); node-- > 0;) {
    const EsvoNode& n = tree.nodes[node];
    if (!cut.is_cut[node] || n.is_packed || n.inner_count() == 0) continue;
    BlockWriter writer(tree, cut, placement);
    writer.place(node);
    const std::uint64_t begin = result.slots.size();
    const auto target = [&](std::uint32_t to) {
      const EsvoNode& far = tree.nodes[to];
      return far.is_packed
                 ? static_cast<std::int64_t>(tree.packed[far.first_child]) -
                       static_cast<std::int64_t>(position + begin)
                 : static_cast<std::int64_t>(first_child[to]) - static_cast<std::int64_t>(begin);
    };
    const std::vector<std::uint64_t> slots = writer.finish(options, target);
    first_child[node] = begin + writer.first_descriptor();
    const NodeCell where = cell_of(tree, parents, node, {level, cell});
    EsvoBlockEntry entry;
    entry.begin = begin;
    entry.slots = static_cast<std::uint32_t>(slots.size());
    entry.level = where.level;
    entry.cell = where.cell;
    block_of[node] = static_cast<std::uint32_t>(result.blocks.size());
    writer.for_each_far([&](std::uint32_t to, std::uint32_t slot) {
      ++result.counts.far_pointers;
      if (tree.nodes[to].is_packed)
        result.links.push_back({tree.packed[tree.nodes[to].first_child], begin + slot});
      else
        result.blocks[block_of[to]].parent = begin + slot;
    });
    result.blocks.push_back(entry);
    result.slots.insert(result.slots.end(), slots.begin(), slots.end());
  }
  result.first_child = first_child[0];
  result.counts.blocks = result.blocks.size();
  return result;
}

void add_super_root(EsvoTree& tree) {
  for (EsvoNode& n : tree.nodes)
    if (!n.is_packed) ++n.first_child;
  EsvoNode top;
  top.valid_mask = 1;
  top.first_child = 1;
  // If the tree has values, the new node needs one too. No descriptor stores it.
  if (tree.has_values()) {
    top.first_value = static_cast<std::uint32_t>(tree.values.size());
    tree.values.emplace_back();
  }
  tree.nodes.insert(tree.nodes.begin(), top);
}

Esvo pack_octree(EsvoTree tree, int levels, const PackOptions& options) {
  add_super_root(tree);
  PackedBlocks blocks = pack_blocks(tree, -1, {}, 0, options);
  return {std::move(blocks.slots), blocks.first_child, levels};
}

}  // namespace voxdag
