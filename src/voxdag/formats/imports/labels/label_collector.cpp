#include "voxdag/formats/imports/labels/label_collector.hpp"

#include <algorithm>
#include <bit>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"

namespace voxdag {
namespace {

/// Takes the materials of voxels in Morton order, and finds those of all cells.
class CellMaterials {
 public:
  CellMaterials(int levels, std::uint32_t materials, MemoryBudget* memory)
      : levels_(levels),
        block_level_(std::max(levels - 3, 0)),
        kinds_{false, false, materials},
        memory_(memory),
        path_(static_cast<std::size_t>(levels) + 1, OpenCell{CellMean(kinds_), 0, 0}),
        runs_(memory) {}

  /// Codes ascend. Throws OverMemory.
  void add(std::uint64_t code, std::uint16_t material) {
    // The cells above this level are those of the last voxel, too.
    int level = 0;
    if (has_voxels_) {
      level = levels_ + 1 - (static_cast<int>(std::bit_width(code ^ code_)) + 2) / 3;
      for (int l = levels_; l >= level; --l) close(l);
    }
    for (; level <= levels_; ++level) open(level);
    code_ = code;
    has_voxels_ = true;
    path_.back().mean.add({{}, {}, material}, 1);
    path_.back().voxels = 1;
  }

  /// Call it last. Throws OverMemory.
  MaterialIds finish() {
    if (has_voxels_)
      for (int level = levels_; level >= 0; --level) close(level);
    MaterialEncoder encoder(kinds_.materials, memory_);
    for (const Run& run : runs_) encoder.add(run.material, run.cells);
    return encoder.finish();
  }

 private:
  /// A cell on the path to the last voxel.
  struct OpenCell {
    CellMean mean;
    std::uint64_t voxels;
    std::size_t place;  ///< In `block_`; of a cell above blocks in `runs_`.
  };
  /// Cells with consecutive numbers.
  struct Run {
    std::uint32_t material, cells;
  };

  void open(int level) {
    const auto at = static_cast<std::size_t>(level);
    path_[at] = {CellMean(kinds_), 0, 0};
    if (level < block_level_) {
      path_[at].place = runs_.size();
      runs_.push_back({0, 1});
      ends_with_block_ = false;
    } else {
      if (level == block_level_) block_.clear();
      path_[at].place = block_.size();
      block_.push_back(0);
    }
  }

  void close(int level) {
    const OpenCell& cell = path_[static_cast<std::size_t>(level)];
    const CellValues values = cell.mean.result();
    if (level > 0) {
      OpenCell& above = path_[static_cast<std::size_t>(level) - 1];
      above.mean.add(values, cell.voxels);
      above.voxels += cell.voxels;
    }
    if (level < block_level_) {
      runs_[cell.place].material = values.material;
      return;
    }
    block_[cell.place] = values.material;
    if (level == block_level_) append_block();
  }

  void append_block() {
    for (const std::uint16_t material : block_) {
      if (ends_with_block_ && runs_.back().material == material && runs_.back().cells != UINT32_MAX)
        ++runs_.back().cells;
      else
        runs_.push_back({material, 1});
      ends_with_block_ = true;
    }
  }

  int levels_;
  /// The cells of a subtree from this level on are collected in `block_`.
  int block_level_;
  ValueKinds kinds_;
  MemoryBudget* memory_;
  std::vector<OpenCell> path_;  ///< By level.
  std::vector<std::uint16_t> block_;
  CountedVector<Run> runs_;
  bool ends_with_block_ = false;  ///< Otherwise, runs_ ends with a cell above blocks.
  bool has_voxels_ = false;
  std::uint64_t code_ = 0;
};

}  // namespace

LabelCollector::LabelCollector(int levels, std::size_t most_labels,
                               const std::filesystem::path& folder, Work work, ColorRule rule)
    : work_(work), rule_(rule), records_(levels, most_labels, folder, work) {}

void LabelCollector::add(Vec3i voxel, Label label) {
  if (label != newest_ && labels_.insert(label).second && labels_.size() > kMaxMaterials)
    throw Error("", "", "has more than " + std::to_string(kMaxMaterials) + " labels");
  newest_ = label;
  if (rule_ == ColorRule::kLast && label >> kLastBits != 0)
    throw Error("", "",
                "has the label " + std::to_string(label) +
                    ", and labels of a palette are from 0 to 2097151");
  if (rule_ == ColorRule::kLast)
    records_.add(voxel, static_cast<Label>(added_++ << kLastBits) | label);
  else
    records_.add(voxel, label);
}

/// Calls visit(code, label) for each voxel, in the order of the codes.
template <class Visit>
void LabelCollector::visit_voxels(const Visit& visit) {
  std::optional<VoxelRecord<Label>> last;  // of the voxel that is being read
  Label best = 0;
  std::uint64_t count = 0, most = 0;
  const auto finish_voxel = [&] {
    if (!last) return;
    if (rule_ == ColorRule::kLast)
      best = last->value & ((Label{1} << kLastBits) - 1);
    else if (count > most)
      best = last->value;
    visit(last->code, best);
  };
  records_.visit_all([&](const VoxelRecord<Label>& record) {
    const bool is_same_voxel = last && last->code == record.code;
    if (!is_same_voxel) {
      finish_voxel();
      count = most = 0;
    } else if (record.value != last->value) {
      if (count > most) best = last->value, most = count;
      count = 0;
    }
    ++count;
    last = record;
  });
  finish_voxel();
}

LabelIds LabelCollector::encode() {
  LabelIds result;
  result.labels.assign(labels_.begin(), labels_.end());
  std::sort(result.labels.begin(), result.labels.end());
  if (result.labels.empty()) return result;
  CellMaterials cells(records_.levels(), static_cast<std::uint32_t>(result.labels.size()),
                      work_.memory);
  visit_voxels([&](std::uint64_t code, Label label) {
    const auto at = std::lower_bound(result.labels.begin(), result.labels.end(), label);
    cells.add(code, static_cast<std::uint16_t>(at - result.labels.begin()));
  });
  result.ids = cells.finish();
  return result;
}

}  // namespace voxdag
