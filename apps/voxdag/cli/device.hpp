#pragma once
/// The option --device: the processor that casts rays.
#include <optional>
#include <string>

#include "cli/session.hpp"
#include "voxdag/cuda/device_choice.hpp"

namespace voxdag::cli {

/// Parses "cpu", "cuda", "cuda:1" or "auto"; throws std::invalid_argument.
DeviceChoice parse_device(const std::string& text);

void add_device_option(const Command& command, DeviceChoice& choice);

/// Calls load_on_device(). Errors name the option.
std::optional<DeviceScene> load_on_chosen_device(const DeviceChoice& choice, const VoxelSet& scene);

/// Returns the name of the device of a DeviceScene or DeviceStream, or "the CPU".
template <class OnDevice>
std::string device_name(const std::optional<OnDevice>& on_device) {
  return on_device ? on_device->device().name : "the CPU";
}

}  // namespace voxdag::cli
