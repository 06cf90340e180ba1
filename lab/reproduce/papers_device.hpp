#pragma once
/// The device that casts the rays of a report and renders its pictures.
#include <filesystem>
#include <string>

#include "lab/reproduce/cells.hpp"
#include "voxdag/cuda/device_choice.hpp"

namespace voxdag::lab {

struct PapersDevice {
  std::string option;  ///< --device of the commands: "cuda:0"; empty: the CPU.
  std::string name;    ///< Name of the CUDA device; empty: the CPU.

  bool is_cuda() const { return !name.empty(); }
  /// Makes the cell run on the device. Its result counts only for this device.
  void cast(Cell& cell) const;
};

/// Returns the chosen device. A run of voxdag looks for it in `scratch`, because the driver in this
/// process would count as memory of all later runs. Throws Error if the choice is kCuda and there
/// is no such device, and Cancelled.
PapersDevice find_device(const DeviceChoice& choice, const std::filesystem::path& scratch,
                         const Progress& progress);

}  // namespace voxdag::lab
