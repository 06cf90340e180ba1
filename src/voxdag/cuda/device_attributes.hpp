#pragma once
/// The attributes of a DAG in the memory of a CUDA device.
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"

namespace voxdag {

/// Owns memory of the device. Copies share it; the last one frees it.
class DeviceAttributes {
 public:
  /// Copies `attributes`, those of the DAG in `scene`, to the scene's device. Throws Error if the
  /// device does not have enough free memory.
  DeviceAttributes(const DeviceScene& scene, const DagAttributesView& attributes);

  /// Returns the attributes of a later version of a DAG that is being edited. This object has those
  /// of the DAG as it was read. `scene` is the version; `overlays` are its overlays in the host's
  /// memory, whose array has `words` words, of which `changes` were written since the last version.
  /// Copies only these to the device, but all if the room for them is used up. Do not call it while
  /// the device uses the attributes.
  DeviceAttributes updated(const DeviceScene& scene, const ValueOverlays& overlays,
                           std::uint64_t words, const std::vector<EditRun>& changes) const;

  /// Returns the DAG and its attributes in the device's memory.
  const ColoredDagView& view() const;

 private:
  struct Memory;
  explicit DeviceAttributes(std::shared_ptr<const Memory> memory) : memory_(std::move(memory)) {}

  std::shared_ptr<const Memory> memory_;
};

}  // namespace voxdag
