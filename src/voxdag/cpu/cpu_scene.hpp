#pragma once
/// Voxels with the structures that the CPU's casters need, made once for many pictures or batches.
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/trace/visit_nodes.hpp"

namespace voxdag {

/// Points to the voxels, which must outlive it. Construction from a DAG takes time and memory: see
/// BoundedDag.
class CpuScene {
 public:
  // NOLINTBEGIN(google-explicit-constructor): every kind of voxels can be rendered.
  CpuScene(const SvdagView& dag) : CpuScene(VoxelSet(dag)) {}
  CpuScene(const EsvoView& esvo) : CpuScene(VoxelSet(esvo)) {}
  /// `rays` is an upper bound on the number of rays that will be cast. For few rays the packets'
  /// structure would cost more time than it saves, so it is not built. 0 never builds it: rays then
  /// only walk from the root of a DAG (SvdagView::root).
  CpuScene(const VoxelSet& voxels, std::uint64_t rays = std::numeric_limits<std::uint64_t>::max())
      : voxels_(voxels) {
    constexpr std::uint64_t kWordsPerRay = 16;
    if (const SvdagView* dag = voxels.dag();
        dag != nullptr && rays != 0 && dag->node_words() / kWordsPerRay <= rays)
      packets_.emplace(BoundedDag(SvdagNodes(*dag)));
  }
  // NOLINTEND

  const VoxelSet& voxels() const { return voxels_; }

  /// Calls body(nodes, caster) with the fastest caster for these nodes and returns its result.
  template <class Body>
  auto visit(const Body& body) const {
    return visit_nodes(voxels_, [&](const auto& nodes) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(nodes)>, SvdagNodes>)
        return packets_ ? body(nodes, *packets_) : body(nodes, ScalarCaster<SvdagNodes>(nodes));
      else
        return body(nodes, PacketCaster(nodes));
    });
  }

 private:
  VoxelSet voxels_;
  std::optional<PacketCaster<BoundedDag>> packets_;
};

}  // namespace voxdag
