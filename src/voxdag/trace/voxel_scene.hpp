#pragma once
/// Voxels in any of the forms that files hold, for what works on all of them.
#include <variant>

#include "voxdag/trace/esvo_cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// A view of either: points to what it was made from. Host only.
class VoxelScene {
 public:
  VoxelScene(const SvdagView& dag) : view_(dag) {}   // NOLINT(google-explicit-constructor)
  VoxelScene(const EsvoView& esvo) : view_(esvo) {}  // NOLINT(google-explicit-constructor)

  const SvdagView* dag() const { return std::get_if<SvdagView>(&view_); }  ///< Or null.
  const EsvoView* esvo() const { return std::get_if<EsvoView>(&view_); }   ///< Or null.
  int levels() const {
    return std::visit([](const auto& view) { return view.levels; }, view_);
  }

  /// Returns body(nodes), nodes being the layout that rays are cast at: SvdagNodes or ContourNodes.
  template <class Body>
  auto visit_nodes(const Body& body) const {
    if (const EsvoView* octree = esvo()) return body(ContourNodes(*octree));
    return body(SvdagNodes(std::get<SvdagView>(view_)));
  }

 private:
  std::variant<SvdagView, EsvoView> view_;
};

}  // namespace voxdag
