#pragma once
/// The option --device: the processor that casts rays.
#include <optional>
#include <string>

#include "cli/session.hpp"
#include "voxdag/cuda/device_choice.hpp"

namespace voxdag {

/// Parses "cpu", "cuda", "cuda:1" or "auto"; throws std::invalid_argument.
DeviceChoice parse_device(const std::string& text);

void add_device_option(const Command& command, DeviceChoice& choice);

/// Calls load_on_device(). Errors name the option.
std::optional<DeviceScene> load_on_chosen_device(const DeviceChoice& choice, const VoxelSet& scene);

/// Returns "the CPU" or the device's name.
std::string device_name(const std::optional<DeviceScene>& scene);

}  // namespace voxdag
