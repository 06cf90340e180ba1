#pragma once
/// Collects the labels of voxels, and finds those of a DAG's cells.
#include <filesystem>
#include <unordered_set>
#include <vector>

#include "voxdag/algebra/attributes/cell_mean.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/formats/imports/colors/colored_voxel_builder.hpp"
#include "voxdag/formats/imports/voxel_records.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"
#include "voxdag/stored/attributes/material_ids.hpp"

namespace voxdag {

/// The labels of a DAG's cells.
struct LabelIds {
  MaterialIds ids;            ///< The material i stands for labels[i].
  std::vector<Label> labels;  ///< All labels that were added, in ascending order.
};

/// Collects labels of voxels, in any order; a voxel may have many. It gets the label that it has
/// most often, the smallest of equally frequent ones; by ColorRule::kLast, that which was added
/// last. A cell above has the label of most of its children, each with the weight of its voxels
/// (algebra/attributes/cell_mean.hpp). Memory is bounded, but for some 8 bytes for each run of
/// equal labels in the order of the cells.
class LabelCollector {
 public:
  /// A grid of 2^levels voxels a side. Holds up to `most_labels` in memory, 16 bytes each; files
  /// lie in `folder`. Throws OverMemory.
  LabelCollector(int levels, std::size_t most_labels, const std::filesystem::path& folder,
                 Work work, ColorRule rule = ColorRule::kMean);

  /// Adds a label of a voxel. Throws Error if the voxel lies outside of the grid, for more than
  /// kMaxMaterials labels, by ColorRule::kLast for labels that are not from 0 to 2^21 - 1, or if a
  /// file cannot be written; OverMemory and Cancelled.
  void add(Vec3i voxel, Label label);

  /// Returns the DAG of all voxels. Throws as VoxelRecords::make_dag().
  Svdag make_dag() { return records_.make_dag(); }
  /// Returns the labels of all cells of that DAG. The budget no longer counts the result when the
  /// function returns. Throws Error if a file cannot be read; OverMemory and Cancelled.
  LabelIds encode();

 private:
  template <class Visit>
  void visit_voxels(const Visit& visit);

  static constexpr int kLastBits = 21;  ///< Of a label by ColorRule::kLast.

  Work work_;
  ColorRule rule_;
  std::uint64_t added_ = 0;
  std::unordered_set<Label> labels_;
  std::optional<Label> newest_;
  VoxelRecords<Label> records_;  ///< By ColorRule::kLast: the place in the file, then the label.
};

}  // namespace voxdag
