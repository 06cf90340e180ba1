#include "cli/device.hpp"

#include <fmt/core.h>

#include <charconv>
#include <stdexcept>

#include "voxdag/core/error.hpp"

namespace voxdag {

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
  throw std::invalid_argument(
      fmt::format("\"{}\" is none of cpu, cuda, cuda:NUMBER and auto", text));
}

void add_device_option(CLI::App& command, DeviceChoice& choice) {
  add_parsed_option(command, "--device", choice, parse_device, "cpu|cuda|auto",
                    "Where rays are cast; auto: on a CUDA device where there is one (default cpu)");
}

std::optional<DeviceScene> load_on_device(const DeviceChoice& choice, const VoxelSet& scene,
                                          DeviceLayout layout) {
  if (choice.kind == DeviceChoice::Kind::kCpu) return std::nullopt;
  try {
    return DeviceScene(choose_cuda_device(choice.index), scene, layout);
  } catch (const Error& error) {
    if (choice.kind == DeviceChoice::Kind::kAuto) return std::nullopt;
    throw Error("--device cuda", "", error.what());
  }
}

std::string device_name(const std::optional<DeviceScene>& dag) {
  return dag ? dag->device().name : "the CPU";
}

}  // namespace voxdag
