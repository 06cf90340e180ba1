#pragma once
/// The colours and normals of a picture's voxels, in the memory of the device that renders it.
#include <optional>

#include "cli/device.hpp"
#include "voxdag/cuda/device_attributes.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/stored/attributes/look.hpp"

namespace voxdag::cli {

/// Owns the copy on the device. Refers to the file if there is no device.
class LookOnDevice {
 public:
  /// Takes the colours and normals of `file`: the scene's file if `is_own`, otherwise that of
  /// --look. Copies them to the device of `scene`, if there is one. If that device lacks the
  /// memory, resets `scene` with --device auto, and throws Error otherwise. The view of an ESVO's
  /// own file is empty, because rays at an ESVO find its colours themselves.
  LookOnDevice(const DeviceChoice& device, const SceneModel& file, bool is_own,
               std::optional<DeviceScene>& scene);

  /// Returns a view for the scene's device; for the host if the scene has no device.
  const LookView& view() const { return view_; }

 private:
  std::optional<DeviceScene> voxels_;
  std::optional<DeviceAttributes> attributes_;
  LookView view_;
};

}  // namespace voxdag::cli
