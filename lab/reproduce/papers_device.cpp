#include "lab/reproduce/papers_device.hpp"

#include <fmt/core.h>

#include "lab/build/bench_mesh.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {
namespace {

std::string option_of(const DeviceChoice& choice) {
  if (choice.kind == DeviceChoice::Kind::kAuto) return "auto";
  return choice.index < 0 ? "cuda" : fmt::format("cuda:{}", choice.index);
}

}  // namespace

void PapersDevice::cast(Cell& cell) const {
  if (!is_cuda()) return;
  cell.device = name;
  cell.arguments.insert(cell.arguments.end(), {"--device", option});
}

PapersDevice find_device(const DeviceChoice& choice, const std::filesystem::path& scratch,
                         const Progress& progress) {
  if (choice.kind == DeviceChoice::Kind::kCpu) return {};
  const std::string option = option_of(choice);
  const ChildResult child =
      run_child({voxdag_program(), "bench", "esvo", "device=sponge:2", "-r", "8", "--size", "8x8",
                 "--views", "1", "--repeat", "1", "--no-silhouettes", "--json", "--device", option},
                scratch, 0, progress);
  const std::string failure = failure_of(child, 0);
  if (!failure.empty()) throw Error(failure);
  const auto rays = nlohmann::json::parse(child.out).at("rays").at(0);
  if (rays.at("device") != "cuda") return {};
  return {option, rays.at("device_name")};
}

}  // namespace voxdag::lab
