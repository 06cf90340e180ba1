#pragma once
/// The attributes of a DAG in the memory of a CUDA device.
#include <memory>

#include "voxdag/cuda/device_scene.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"

namespace voxdag {

/// Owns memory of the device. Copies share it; the last one frees it.
class DeviceAttributes {
 public:
  /// Copies `attributes`, those of the DAG in `scene`, to the scene's device. Throws Error if the
  /// device does not have enough free memory.
  DeviceAttributes(const DeviceScene& scene, const DagAttributesView& attributes);

  /// Returns the DAG and its attributes in the device's memory.
  const ColoredDagView& view() const;

 private:
  struct Memory;
  std::shared_ptr<const Memory> memory_;
};

}  // namespace voxdag
