#include "lab/build/bench_mesh.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <fstream>
#include <span>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/formats/scenes/scenes.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

/// Splits "hairball:100" into name and size; the size is empty if there is none.
std::array<std::string, 2> split_scene(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

/// Reads a whole file, so that the next reader finds it in the disk cache; returns its checksum.
std::uint64_t warm_up(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> part(1 << 20);
  Xxh3Stream check;
  do {
    file.read(part.data(), static_cast<std::streamsize>(part.size()));
    check.add(std::as_bytes(std::span(part.data(), static_cast<std::size_t>(file.gcount()))));
  } while (file);
  if (!file.eof()) throw Error(path, "", "cannot be read");
  return check.digest();
}

}  // namespace

std::string voxdag_program() {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "voxdag";
  if (!fs::exists(program)) throw Error(program.string(), "", "voxdag-lab needs voxdag beside it");
  return program;
}

bool is_procedural(const std::string& mesh) {
  const std::string name = split_scene(mesh)[0];
  const auto scenes = scene_list();
  return !fs::exists(mesh) && std::any_of(scenes.begin(), scenes.end(),
                                          [&](const SceneInfo& s) { return s.name == name; });
}

PreparedMesh prepare_mesh(const std::string& mesh, const fs::path& folder, Progress& progress) {
  PreparedMesh prepared;
  prepared.path = fs::absolute(mesh);
  prepared.identity.name = prepared.path.filename();
  if (is_procedural(mesh)) {
    progress.report("making " + mesh, 0);
    const auto [name, size] = split_scene(mesh);
    prepared.path = folder / (mesh + ".ply");
    prepared.identity.name = name;
    prepared.identity.is_procedural = true;
    std::vector<std::string> command{voxdag_program(), "scene", name, "-o", prepared.path};
    if (!size.empty()) command.insert(command.end(), {"--size", size});
    const ChildResult made = run_child(command, folder, 0, progress);
    if (made.status != 0) throw Error(mesh, "", failure_of(made, 0));
  }
  prepared.identity.file_check = warm_up(prepared.path);
  return prepared;
}

}  // namespace voxdag::lab
