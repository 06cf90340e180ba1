#include "voxdag/algebra/attributes/material_voxels.hpp"

#include <algorithm>
#include <bit>

#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/attributes/numbered_cell.hpp"

namespace voxdag {
namespace {

/// Reads the materials of cells whose numbers ascend.
class AscendingMaterials {
 public:
  explicit AscendingMaterials(const MaterialIdsView& ids) : ids_(ids), id_bits_(ids.id_bits()) {}

  std::uint32_t material(std::uint64_t number) {
    if (number / kPageValues != page_) {
      page_ = number / kPageValues;
      at_ = ids_.page_begin(page_);
      end_ = page_ * kPageValues;
      next_run();
    }
    while (number >= end_) next_run();
    return id_;
  }

 private:
  void next_run() {
    const MaterialRun run = read_material_run(ids_, at_, id_bits_);
    id_ = run.id;
    at_ += static_cast<std::uint64_t>(run.bits);
    end_ = run.length == 0 ? UINT64_MAX : end_ + run.length;
  }

  MaterialIdsView ids_;
  int id_bits_;
  std::uint64_t page_ = UINT64_MAX, at_ = 0;
  std::uint64_t end_ = 0;  ///< The number after the run.
  std::uint32_t id_ = 0;
};

/// Calls use(code, material) for all voxels, in the order of their Morton codes.
template <class Use>
class MaterialWalk {
 public:
  MaterialWalk(const SvdagView& dag, const DagAttributesView& attributes, Work work, const Use& use)
      : dag_(dag), index_(attributes.index), reader_(attributes.materials), poll_(work), use_(use) {
    if (!dag.is_empty()) visit({}, 0, 0);
  }

 private:
  void visit(const NumberedCell& cell, std::uint64_t code, std::uint32_t material) {
    if (cell.level == index_.finest_level) material = reader_.material(cell.number);
    if (cell.level == dag_.levels) return use_(code, material);
    if (cell.level == dag_.levels - 2) poll_.poll_seldom(blocks_++);
    for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      visit(child_of(dag_, index_, cell, child), code << 3 | static_cast<std::uint64_t>(child),
            material);
    }
  }

  const SvdagView& dag_;
  const CellIndexView& index_;
  AscendingMaterials reader_;
  Work poll_;
  std::uint64_t blocks_ = 0;
  const Use& use_;
};

}  // namespace

std::vector<MaterialVoxels> material_voxels(const SvdagView& dag,
                                            const DagAttributesView& attributes, Work work) {
  std::vector<MaterialVoxels> all(attributes.materials.materials);
  const auto add = [&](std::uint64_t code, std::uint32_t material) {
    MaterialVoxels& of = all[material];
    const Vec3i voxel = morton_decode(code), end = voxel + Vec3i{1, 1, 1};
    of.bounds = of.voxels == 0 ? Box3i{voxel, end}
                               : Box3i{min(of.bounds.lo, voxel), max(of.bounds.hi, end)};
    ++of.voxels;
  };
  MaterialWalk(dag, attributes, work, add);
  return all;
}

Svdag keep_materials(const SvdagView& dag, const DagAttributesView& attributes,
                     const std::vector<bool>& keeps, Work work) {
  MortonBuilder builder(dag.levels, work.memory);
  MaterialWalk(dag, attributes, work, [&](std::uint64_t code, std::uint32_t material) {
    if (keeps[material]) builder.add(code);
  });
  return builder.finish();
}

}  // namespace voxdag
