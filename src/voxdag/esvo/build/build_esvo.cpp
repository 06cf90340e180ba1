#include "voxdag/esvo/build/build_esvo.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

#include "voxdag/esvo/build/open_edges.hpp"
#include "voxdag/esvo/build/top_cells.hpp"
#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// A tree of fewer slots than this is kept for the cell above.
constexpr std::uint64_t kKeepSlots = 2048;

/// What a task hands to the stage that puts blocks in order.
struct Finished {
  std::size_t task = 0;
  BuiltVoxel voxel;
  bool has_blocks = false;
  PackedBlocks blocks;  ///< Of all below the voxel, if has_blocks.
};

/// All below node 0 is in blocks; `first_child` is where.
void keep_node_0(EsvoTree& tree, std::uint64_t first_child) {
  EsvoNode node = tree.nodes[0];
  const auto count = [](std::uint32_t mask) {
    return static_cast<std::ptrdiff_t>(std::popcount(mask));
  };
  EsvoTree kept;
  const auto contours = tree.contours.begin() + node.first_contour;
  kept.contours.assign(contours, contours + count(node.contour_mask));
  if (tree.has_values()) {
    const auto values = tree.values.begin() + node.first_value;
    kept.values.assign(values, values + count(node.valid_mask));
  }
  node.first_contour = node.first_value = node.first_child = 0;
  node.is_packed = true;
  kept.packed = {first_child};
  kept.nodes = {node};
  tree = std::move(kept);
}

/// Appends `child` but its node 0, whose copy it returns, with everything renumbered.
EsvoNode append_tree(EsvoTree& tree, const EsvoTree& child) {
  const auto nodes = static_cast<std::uint32_t>(tree.nodes.size()) - 1;
  const auto contours = static_cast<std::uint32_t>(tree.contours.size());
  const auto values = static_cast<std::uint32_t>(tree.values.size());
  const auto packed = static_cast<std::uint32_t>(tree.packed.size());
  const auto moved = [&](EsvoNode node) {
    node.first_child += node.is_packed ? packed : nodes;
    node.first_contour += contours;
    node.first_value += values;
    return node;
  };
  for (std::size_t i = 1; i < child.nodes.size(); ++i) tree.nodes.push_back(moved(child.nodes[i]));
  tree.contours.insert(tree.contours.end(), child.contours.begin(), child.contours.end());
  tree.values.insert(tree.values.end(), child.values.begin(), child.values.end());
  tree.packed.insert(tree.packed.end(), child.packed.begin(), child.packed.end());
  return moved(child.nodes[0]);
}

/// A voxel from its eight children, in order.
BuiltVoxel join(const VoxelDecision& decision, std::vector<BuiltVoxel>& children, bool attributes) {
  BuiltVoxel built;
  built.contour = decision.contour;
  EsvoTree& tree = built.tree;
  EsvoNode node;
  for (std::size_t i = 0; i < 8; ++i) {
    const BuiltVoxel& child = children[i];
    if (!child.exists) continue;
    built.exists = true;
    built.sum.add(child.sum);
    const auto bit = static_cast<std::uint8_t>(1u << i);
    node.valid_mask |= bit;
    if (child.is_leaf) node.leaf_mask |= bit;
    if (child.contour) {
      node.contour_mask |= bit;
      tree.contours.push_back(*child.contour);
    }
    if (attributes) tree.values.push_back(voxel_value(child.sum));
  }
  if (!built.exists) return built;
  node.first_child = 1;
  tree.nodes.resize(1 + node.inner_count());
  tree.nodes[0] = node;
  std::size_t at = 1;
  for (BuiltVoxel& child : children) {
    if (!child.exists || child.is_leaf) continue;
    tree.nodes[at++] = append_tree(tree, child.tree);
    child = {};
  }
  return built;
}

/// Puts what the tasks make in order: blocks to the sink, small trees into that of the cell above.
class Assembler {
 public:
  Assembler(std::vector<TopCell>& cells, const EsvoOptions& options, EsvoSink& sink)
      : cells_(cells), options_(options), sink_(sink) {}

  /// In the order of the tasks.
  void finish(Finished& task) {
    if (task.has_blocks) keep_node_0(task.voxel.tree, append(task.blocks));
    arrive(task.task, std::move(task.voxel));
  }

  EsvoResult result() {
    if (!root_.exists) return std::move(result_);
    result_.counts.voxels_per_level[0] = 1;
    add_super_root(root_.tree);
    const PackedBlocks blocks = pack_blocks(root_.tree, -1, {}, position_, options_.pack);
    result_.root = append(blocks);
    result_.directory.back().level = 0;
    return std::move(result_);
  }

 private:
  /// Returns the slot of the first descriptor.
  std::uint64_t append(const PackedBlocks& blocks) {
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

  void arrive(std::size_t cell, BuiltVoxel&& voxel) {
    const TopCell* top = &cells_[cell];
    while (top->parent != TopCell::kNoParent) {
      TopCell& parent = cells_[top->parent];
      parent.built.resize(8);
      parent.built[static_cast<std::size_t>(top->child)] = std::move(voxel);
      if (--parent.children_left > 0) return;
      voxel = join(parent.decision, parent.built, options_.settings.attributes);
      parent.built = {};
      top = &parent;
      if (voxel.exists && top->parent != TopCell::kNoParent &&
          packed_slots(voxel.tree) > kKeepSlots) {
        const PackedBlocks blocks =
            pack_blocks(voxel.tree, top->level, top->cell, position_, options_.pack);
        keep_node_0(voxel.tree, append(blocks));
      }
    }
    root_ = std::move(voxel);
  }

  std::vector<TopCell>& cells_;
  const EsvoOptions& options_;
  EsvoSink& sink_;
  std::uint64_t position_ = 0;
  EsvoResult result_;
  BuiltVoxel root_;
};

}  // namespace

EsvoResult build_esvo(const Mesh& mesh, const Grid& grid, const EsvoOptions& options,
                      const SurfaceShading* shading, const DisplacedTriangles* displaced,
                      EsvoSink& sink, Progress* progress) {
  const QuantizedMesh quantized(mesh, grid);
  const std::vector<std::uint8_t> open_edges = find_open_edges(quantized);
  const TriangleSource source{grid, quantized, open_edges, displaced};
  std::vector<TopCell> cells = find_top_cells(source, options.settings, shading, progress);
  const std::vector<std::size_t> tasks = task_order(cells);
  double total_weight = 0, weight_so_far = 0;
  for (const std::size_t task : tasks) total_weight += cells[task].weight;

  Assembler assembler(cells, options, sink);
  tbb::enumerable_thread_specific<CellBuilder> builders(
      [&] { return CellBuilder(options.settings, shading); });
  const auto build = [&](std::size_t task) {
    auto finished = std::make_unique<Finished>();
    TopCell& cell = cells[task];
    CellBuilder& builder = builders.local();
    load(builder, source, cell);
    if (cell.is_displaced && cell.parent != TopCell::kNoParent && builder.weight() > 0)
      cell.decision = builder.decide(cells[cell.parent].decision);
    cell.triangles = {};
    finished->task = task;
    finished->voxel = builder.build(cell.decision);
    const EsvoTree& tree = finished->voxel.tree;
    if (tree.nodes.empty() || packed_slots(tree) <= kKeepSlots) return finished;
    finished->has_blocks = true;
    finished->blocks = pack_blocks(tree, cell.level, cell.cell, 0, options.pack);
    return finished;
  };

  std::size_t next = 0;
  tbb::parallel_pipeline(
      2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()),
      tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                          [&](tbb::flow_control& flow) {
                                            if (next == tasks.size() ||
                                                (progress != nullptr && progress->cancelled())) {
                                              flow.stop();
                                              return std::size_t{0};
                                            }
                                            return tasks[next++];
                                          }) &
          tbb::make_filter<std::size_t, Finished*>(
              tbb::filter_mode::parallel, [&](std::size_t task) { return build(task).release(); }) &
          tbb::make_filter<Finished*, void>(
              tbb::filter_mode::serial_in_order, [&](Finished* result) {
                const std::unique_ptr<Finished> finished(result);
                weight_so_far += cells[finished->task].weight;
                assembler.finish(*finished);
                if (progress != nullptr)
                  progress->report("octree", weight_so_far / total_weight,
                                   static_cast<std::uint64_t>(weight_so_far));
              }));
  if (progress != nullptr) progress->throw_if_cancelled();
  return assembler.result();
}

Esvo build_esvo(const Mesh& mesh, const Grid& grid, const EsvoOptions& options,
                const SurfaceShading* shading, Progress* progress) {
  EsvoMemory memory;
  const EsvoResult result = build_esvo(mesh, grid, options, shading, nullptr, memory, progress);
  return {memory.take(), result.root, grid.levels};
}

}  // namespace voxdag
