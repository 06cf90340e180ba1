#include "voxdag/builders/esvo/build/block_assembler.hpp"

#include <algorithm>

namespace voxdag {

bool needs_blocks(const EsvoTree& tree) {
  constexpr std::uint64_t kKeepSlots = 2048;
  return !tree.nodes.empty() && packed_slots(tree) > kKeepSlots;
}

void BlockAssembler::add(FinishedTask& task) {
  if (task.has_blocks) {
    keep_packed_root(task.voxel.tree, append(task.blocks));
    task.voxel.count_tree(memory_);
  }
  arrive(task.cell, std::move(task.voxel));
}

EsvoResult BlockAssembler::finish() {
  if (!root_.exists) return std::move(result_);
  result_.counts.voxels_per_level[0] = 1;
  add_super_root(root_.tree);
  const PackedBlocks blocks = pack_blocks(root_.tree, -1, {}, position_, options_.pack);
  result_.root = append(blocks);
  result_.directory.back().level = 0;
  return std::move(result_);
}

/// Appends blocks to the sink and the directory. Returns the slot of the first descriptor.
std::uint64_t BlockAssembler::append(const PackedBlocks& blocks) {
  const std::uint64_t position = position_;
  sink_.append(blocks.slots);
  position_ += blocks.slots.size();
  for (EsvoBlockEntry entry : blocks.blocks) {
    entry.begin += position;
    if (entry.parent != EsvoBlockEntry::kNoParent) entry.parent += position;
    result_.directory.push_back(entry);
  }
  for (const PackedLink& link : blocks.links) {
    const auto after = std::upper_bound(
        result_.directory.begin(), result_.directory.end(), link.child,
        [](std::uint64_t slot, const EsvoBlockEntry& entry) { return slot < entry.begin; });
    std::prev(after)->parent = position + link.parent;
  }
  result_.counts += blocks.counts;
  return position + blocks.first_child;
}

/// Gives a finished voxel to its parent. If it was the last child, finishes the parent too.
void BlockAssembler::arrive(std::size_t cell, BuiltVoxel&& voxel) {
  const TopCell* top = &cells_[cell];
  while (top->parent != TopCell::kNoParent) {
    TopCell& parent = cells_[top->parent];
    parent.built.resize(8);
    parent.built[static_cast<std::size_t>(top->child)] = std::move(voxel);
    if (--parent.children_left > 0) return;
    voxel = join_children(parent.decision, std::span<BuiltVoxel, 8>(parent.built),
                          options_.settings.attributes, memory_);
    parent.built = std::vector<BuiltVoxel>();
    top = &parent;
    if (voxel.exists && top->parent != TopCell::kNoParent && needs_blocks(voxel.tree)) {
      const PackedBlocks blocks =
          pack_blocks(voxel.tree, top->level, top->cell, position_, options_.pack);
      keep_packed_root(voxel.tree, append(blocks));
      voxel.count_tree(memory_);
    }
  }
  root_ = std::move(voxel);
}

}  // namespace voxdag
