#pragma once
/// Voxels in the memory of a CUDA device.
#include <cstdint>
#include <memory>
#include <utility>

#include "voxdag/cuda/device.hpp"
#include "voxdag/cuda/device_voxels.hpp"
#include "voxdag/stored/svdag/edit_changes.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// Copies share the device's memory; the last one frees it.
class DeviceScene {
 public:
  /// Copies the voxels to the device; `layout` is the layout for rays, and must be one for these
  /// voxels. The host's voxels must outlive this object. Throws Error if the device does not have
  /// enough free memory.
  DeviceScene(const CudaDevice& device, const VoxelSet& scene, DeviceLayout layout);
  /// Copies the voxels in their default layout: kPaper or kContours.
  DeviceScene(const CudaDevice& device, const VoxelSet& scene)
      : DeviceScene(device, scene, default_layout(scene)) {}

  /// Copies a DAG that is being edited (edit/editable_dag.hpp), in the layout kPaper: all of its
  /// words and leaf blocks, whose numbers are given, and room for as many again as an eighth of
  /// them.
  DeviceScene(const CudaDevice& device, const SvdagView& dag, std::uint64_t words,
              std::uint64_t blocks);
  /// Returns a later version of such a scene. Copies only `changes` to the device, but everything
  /// if the room is used up. Versions share the device's memory: an older one stays valid until
  /// edits write over nodes that they collected. Do not call it while the device uses the scene.
  DeviceScene updated(const SvdagView& dag, std::uint64_t words, std::uint64_t blocks,
                      const EditChanges& changes) const;

  static DeviceLayout default_layout(const VoxelSet& scene) {
    return scene.esvo() != nullptr ? DeviceLayout::kContours : DeviceLayout::kPaper;
  }

  const CudaDevice& device() const;
  const VoxelSet& host() const;      ///< The voxels in the host's memory.
  const DeviceVoxels& view() const;  ///< The voxels in the device's memory.
  void make_current() const;         ///< Selects the voxels' device for this thread.

 private:
  struct Memory;
  explicit DeviceScene(std::shared_ptr<const Memory> memory) : memory_(std::move(memory)) {}

  std::shared_ptr<const Memory> memory_;
};

}  // namespace voxdag
