#pragma once
/// The option --device: where rays are cast.
#include <optional>
#include <string>

#include "cli/session.hpp"
#include "voxdag/cuda/device_scene.hpp"

namespace voxdag {

struct DeviceChoice {
  enum class Kind { kCpu, kCuda, kAuto };

  Kind kind = Kind::kCpu;
  int index = -1;  ///< Of a CUDA device; -1: the first that will do.
};

/// "cpu", "cuda", "cuda:1" or "auto"; throws std::invalid_argument.
DeviceChoice parse_device(const std::string& text);

void add_device_option(CLI::App& command, DeviceChoice& choice);

/// The voxels in the memory of the CUDA device that was asked for; nothing where the CPU is to
/// work: with "auto" also where there is no device, or not enough memory on it. `scene` must
/// outlive it. Throws Error where CUDA was asked for and cannot be.
std::optional<DeviceScene> load_on_device(const DeviceChoice& choice, const VoxelSet& scene,
                                          DeviceLayout layout = DeviceLayout::kPaper);

/// "the CPU" or the device's name, for people.
std::string device_name(const std::optional<DeviceScene>& dag);

}  // namespace voxdag
