#include "cli/device.hpp"

#include <fmt/core.h>

#include <charconv>
#include <stdexcept>

#include "voxdag/core/error.hpp"

namespace voxdag::cli {

DeviceChoice parse_device(const std::string& text) {
  using Kind = DeviceChoice::Kind;
  if (text == "cpu") return {Kind::kCpu, -1};
  if (text == "auto") return {Kind::kAuto, -1};
  if (text == "cuda") return {Kind::kCuda, -1};
  if (text.starts_with("cuda:")) {
    DeviceChoice choice{Kind::kCuda, -1};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + 5, end, choice.index);
    if (error == std::errc() && stop == end && choice.index >= 0) return choice;
  }
  throw std::invalid_argument(fmt::format("\"{}\" is not cpu, cuda, cuda:NUMBER or auto", text));
}

void add_device_option(const Command& command, DeviceChoice& choice) {
  command.parsed(
      "--device", choice, parse_device, "cpu|cuda|auto",
      "Device that casts the rays. cuda:1 is the second CUDA device; auto is a CUDA device if "
      "there is one with enough memory (default: cpu)");
}

std::optional<DeviceScene> load_on_chosen_device(const DeviceChoice& choice,
                                                 const VoxelSet& scene) {
  try {
    return load_on_device(choice, scene, DeviceScene::default_layout(scene));
  } catch (const Error& error) {
    throw Error("--device cuda", "", error.what());
  }
}

}  // namespace voxdag::cli
