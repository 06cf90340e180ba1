#include "bench/build/bench_mesh.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/scenes/scenes.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

/// Splits "hairball:100" into name and size; without a size that is empty.
std::array<std::string, 2> split_scene(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

/// Reads a whole file, so that the next reader finds it in the disk cache.
void warm_up(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> part(1 << 20);
  while (file.read(part.data(), static_cast<std::streamsize>(part.size()))) {
  }
  if (!file.eof()) throw Error(path, "", "cannot be read");
}

}  // namespace

std::string this_program() { return fs::read_symlink("/proc/self/exe"); }

bool is_procedural(const std::string& mesh) {
  const std::string name = split_scene(mesh)[0];
  const auto scenes = scene_list();
  return !fs::exists(mesh) && std::any_of(scenes.begin(), scenes.end(),
                                          [&](const SceneInfo& s) { return s.name == name; });
}

fs::path prepare_mesh(const std::string& mesh, const fs::path& folder, Progress& progress) {
  fs::path path = fs::absolute(mesh);
  if (is_procedural(mesh)) {
    progress.report("making " + mesh, 0);
    path = folder / (mesh + ".ply");
    const auto [name, size] = split_scene(mesh);
    std::vector<std::string> command{this_program(), "scene", name, "-o", path};
    if (!size.empty()) command.insert(command.end(), {"--size", size});
    const ChildResult made = run_child(command, folder, 0, progress);
    if (made.status != 0) throw Error(mesh, "", failure_of(made, 0));
  }
  warm_up(path);
  return path;
}

}  // namespace voxdag
