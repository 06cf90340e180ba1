#include "render/look_on_device.hpp"

#include "cli/look_input.hpp"

namespace voxdag::cli {

LookOnDevice::LookOnDevice(const DeviceChoice& device, const SceneModel& file, bool is_own,
                           std::optional<DeviceScene>& scene) {
  if (is_own && file.voxels().esvo() != nullptr) return;
  view_ = look_of(file);
  if (!scene || view_.is_empty()) return;
  if (is_own) {
    voxels_ = scene;
  } else {
    voxels_ = load_on_chosen_device(device, file.voxels());
    if (!voxels_) scene.reset();
  }
  if (!scene) return;
  if (view_.dag.is_empty()) {
    view_ = voxels_->view().esvo;
    return;
  }
  try {
    attributes_.emplace(*voxels_, view_.dag.attributes);
    view_ = attributes_->view();
  } catch (const Error& error) {
    if (device.kind != DeviceChoice::Kind::kAuto) throw Error("--device cuda", "", error.what());
    voxels_.reset();
    scene.reset();
  }
}

}  // namespace voxdag::cli
