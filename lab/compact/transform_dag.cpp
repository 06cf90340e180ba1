#include "lab/compact/transform_dag.hpp"

#include <algorithm>

#include "lab/compact/merged_dag.hpp"
#include "lab/compact/symmetry.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag::lab {
namespace {

/// The nodes of one height that merge by symmetries and moves.
class HeightMerge {
 public:
  /// `image` is that of MergedDag for this level, `items` the needed nodes, ascending.
  HeightMerge(const DagNodes& dag, int height, const std::vector<MergedChild>& image,
              std::vector<std::uint32_t> items, const Progress& progress)
      : dag_(dag), height_(height), items_(std::move(items)) {
    find_classes(image);
    std::vector<CubeGrid> grids(firsts_.size());
    parallel_for(grids.size(), 256, [&](std::size_t i) { grids[i] = grid(firsts_[i]); });
    sources_ = find_sources(grids, progress);
    keep();
  }

  /// The nodes of the DAG that are kept, ascending.
  const std::vector<std::uint32_t>& kept() const { return kept_; }

  /// Returns for each node of the DAG the pointer to the kept node of which it is made; for nodes
  /// that are not needed, no node.
  std::vector<TransformedChild> pointers(std::size_t node_count, const Progress& progress) const {
    std::vector<TransformedChild> pointers(node_count);
    for (std::size_t i = 0; i < kept_.size(); ++i)
      pointers[kept_[i]].node = static_cast<std::uint32_t>(i);
    parallel_for(items_.size(), 64, [&](std::size_t i) {
      if (i % 64 == 0) progress.throw_if_cancelled();
      if (pointers[items_[i]].node != kNoNode) return;
      const std::uint32_t source = firsts_[sources_[classes_[i]]];
      const auto place = std::lower_bound(kept_.begin(), kept_.end(), source);
      pointers[items_[i]] = {static_cast<std::uint32_t>(place - kept_.begin()),
                             first_transform(grid(source), grid(items_[i]))};
    });
    return pointers;
  }

 private:
  CubeGrid grid(std::uint32_t node) const { return grid_of_node(dag_, height_, node); }

  /// Numbers the classes of items that are images of each other under symmetries.
  void find_classes(const std::vector<MergedChild>& image) {
    std::vector<std::uint32_t> class_of(image.size(), kNoNode);
    for (const std::uint32_t item : items_) {
      std::uint32_t& found = class_of[image[item].node];
      if (found == kNoNode) {
        found = static_cast<std::uint32_t>(firsts_.size());
        firsts_.push_back(item);
      }
      classes_.push_back(found);
    }
  }

  void keep() {
    for (const std::uint32_t source : sources_) kept_.push_back(firsts_[source]);
    std::sort(kept_.begin(), kept_.end());
    kept_.erase(std::unique(kept_.begin(), kept_.end()), kept_.end());
  }

  const DagNodes& dag_;
  int height_;
  std::vector<std::uint32_t> items_;
  std::vector<std::uint32_t> classes_;  ///< Of the items.
  std::vector<std::uint32_t> firsts_;   ///< The first item of each class.
  std::vector<std::uint32_t> sources_;  ///< For each class, the class of which it is made.
  std::vector<std::uint32_t> kept_;
};

/// Returns the nodes of the DAG that are representatives, in their order.
std::vector<std::uint32_t> representatives(const std::vector<MergedChild>& image) {
  std::vector<std::uint32_t> nodes;
  for (std::size_t i = 0; i < image.size(); ++i)
    if (image[i].node == nodes.size()) nodes.push_back(static_cast<std::uint32_t>(i));
  return nodes;
}

TransformedNode with_transforms(const MergedNode& node) {
  TransformedNode transformed;
  for (int i = 0; i < 8; ++i) transformed[i] = {node[i].node, {node[i].symmetry, {}}};
  return transformed;
}

}  // namespace

TransformDag merge_transformed(const DagNodes& dag, int move_height, const Progress& progress) {
  MergedDag merged = merge_nodes(dag, MergeRule::kSymmetries, progress);
  const int levels = static_cast<int>(dag.nodes.size()) + 2;
  TransformDag result;
  result.move_height = std::min(move_height, levels - 1);
  if (result.move_height < 2) result.move_height = 0;
  result.nodes.resize(dag.nodes.size());
  for (std::size_t level = 0; level < dag.nodes.size(); ++level)
    for (const MergedNode& node : merged.nodes[level])
      result.nodes[level].push_back(with_transforms(node));
  result.leaf_blocks = std::move(merged.leaf_blocks);
  if (result.move_height == 0) return result;

  // The nodes of the DAG of which the level above the moved ones now consists.
  int level = levels - result.move_height - 1;
  std::vector<std::uint32_t> above = representatives(merged.image[level]);
  for (int height = result.move_height; height >= 2; --height, ++level) {
    std::vector<std::uint32_t> items;
    std::vector<bool> is_needed(merged.image[level + 1].size());
    for (const std::uint32_t node : above)
      for (const std::uint32_t child : dag.nodes[level][node])
        if (child != kNoNode) is_needed[child] = true;
    for (std::size_t i = 0; i < is_needed.size(); ++i)
      if (is_needed[i]) items.push_back(static_cast<std::uint32_t>(i));
    const HeightMerge merge(dag, height, merged.image[level + 1], std::move(items), progress);
    const std::vector<TransformedChild> pointers = merge.pointers(is_needed.size(), progress);
    std::vector<TransformedNode>& nodes = result.nodes[level];
    nodes.assign(above.size(), {});
    for (std::size_t i = 0; i < above.size(); ++i)
      for (int octant = 0; octant < 8; ++octant)
        if (const std::uint32_t child = dag.nodes[level][above[i]][octant]; child != kNoNode)
          nodes[i][octant] = pointers[child];
    above = merge.kept();
  }
  result.leaf_blocks.clear();
  for (const std::uint32_t leaf : above) result.leaf_blocks.push_back(dag.leaf_blocks[leaf]);
  return result;
}

}  // namespace voxdag::lab
