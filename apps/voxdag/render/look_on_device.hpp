#pragma once
/// The colours and normals of a picture's voxels, where the picture is rendered.
#include <optional>

#include "cli/device.hpp"
#include "cli/scene_input.hpp"
#include "voxdag/cuda/device_attributes.hpp"
#include "voxdag/layout/look.hpp"

namespace voxdag {

/// Holds what it copied to a device.
class LookOnDevice {
 public:
  /// Takes the look of `file`, which is the file of the scene or that of --look (`is_own` is
  /// false). Copies it to the device of `scene`, if there is one. Resets `scene` if the device of
  /// --device auto has no room for both. An ESVO needs no look of its own.
  LookOnDevice(const DeviceChoice& device, const SceneInput& file, bool is_own,
               std::optional<DeviceScene>& scene);

  /// Returns a view for the scene's device, or for the host if there is none.
  const LookView& view() const { return view_; }

 private:
  std::optional<DeviceScene> voxels_;
  std::optional<DeviceAttributes> attributes_;
  LookView view_;
};

}  // namespace voxdag
