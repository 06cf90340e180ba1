#pragma once
/// Voxels with what the CPU's casters need of them, made once for many pictures or batches.
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/trace/voxel_scene.hpp"

namespace voxdag {

/// Points to the voxels. Made from a DAG it takes time and memory: see BoundedDag.
class CpuScene {
 public:
  CpuScene(const SvdagView& dag)
      : CpuScene(VoxelScene(dag)) {}  // NOLINT(google-explicit-constructor)
  CpuScene(const EsvoView& esvo)
      : CpuScene(VoxelScene(esvo)) {}  // NOLINT(google-explicit-constructor)
  /// Where no more than `rays` will be cast and that is too few to be worth it, nothing is made.
  CpuScene(const VoxelScene& voxels,  // NOLINT(google-explicit-constructor)
           std::uint64_t rays = std::numeric_limits<std::uint64_t>::max())
      : voxels_(voxels) {
    constexpr std::uint64_t kWordsPerRay = 16;
    if (const SvdagView* dag = voxels.dag();
        dag != nullptr && dag->node_words() / kWordsPerRay <= rays)
      packets_.emplace(BoundedDag(SvdagNodes(*dag)));
  }

  const VoxelScene& voxels() const { return voxels_; }

  /// Returns body(nodes, caster), the caster being the fastest for these nodes.
  template <class Body>
  auto visit(const Body& body) const {
    return voxels_.visit_nodes([&](const auto& nodes) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(nodes)>, SvdagNodes>)
        return packets_ ? body(nodes, *packets_) : body(nodes, ScalarCaster<SvdagNodes>(nodes));
      else
        return body(nodes, PacketCaster(nodes));
    });
  }

 private:
  VoxelScene voxels_;
  std::optional<PacketCaster<BoundedDag>> packets_;
};

}  // namespace voxdag
