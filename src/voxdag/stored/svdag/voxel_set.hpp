#pragma once
/// The voxels of a DAG or an ESVO behind one type.
#include <variant>

#include "voxdag/stored/esvo/esvo_leaf_parts.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {

/// A view: points to the DAG or ESVO that it was made from, which must be valid.
class VoxelSet {
 public:
  VoxelSet(const SvdagView& dag) : view_(dag) {}   // NOLINT(google-explicit-constructor)
  VoxelSet(const EsvoView& esvo) : view_(esvo) {}  // NOLINT(google-explicit-constructor)

  const SvdagView* dag() const { return std::get_if<SvdagView>(&view_); }  ///< Or null.
  const EsvoView* esvo() const { return std::get_if<EsvoView>(&view_); }   ///< Or null.
  int levels() const {
    return std::visit([](const auto& view) { return view.levels; }, view_);
  }

  /// Calls the function of this name: for a DAG in for_each_voxel.hpp, for an ESVO in
  /// esvo_leaf_parts.hpp.
  template <class Fn>
  void for_each_leaf_block(const Box3i& window, const Fn& fn) const {
    std::visit([&](const auto& view) { voxdag::for_each_leaf_block(view, window, fn); }, view_);
  }
  template <class Fn>
  void for_each_voxel(const Box3i& window, const Fn& fn) const {
    std::visit([&](const auto& view) { voxdag::for_each_voxel(view, window, fn); }, view_);
  }
  /// Returns the mask of the 4³ voxels around `voxel`, in Morton order; 0 if there are none.
  std::uint64_t leaf_block_at(Vec3i voxel) const {
    if (dag() != nullptr) return voxdag::leaf_block_at(*dag(), voxel);
    std::uint64_t found = 0;
    const Vec3i lo{voxel.x & ~3, voxel.y & ~3, voxel.z & ~3};
    for_each_leaf_block({lo, lo + Vec3i{4, 4, 4}},
                        [&](Vec3i, std::uint64_t mask) { found = mask; });
    return found;
  }

 private:
  std::variant<SvdagView, EsvoView> view_;
};

}  // namespace voxdag
