#include "lab/runs/scene_mesh.hpp"

#include <algorithm>
#include <vector>

#include "lab/runs/child.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/formats/scenes/scenes.hpp"

namespace voxdag::lab {

namespace fs = std::filesystem;

std::string voxdag_program() {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "voxdag";
  if (!fs::exists(program)) throw Error(program.string(), "", "voxdag-lab needs voxdag beside it");
  return program;
}

SceneMesh prepare_mesh(const std::string& mesh, const fs::path& folder, Progress& progress) {
  const fs::path path = fs::absolute(mesh);
  const std::string name = mesh.substr(0, mesh.find(':')), size = mesh.substr(name.size());
  const auto scenes = scene_list();
  if (fs::exists(mesh) || std::none_of(scenes.begin(), scenes.end(),
                                       [&](const SceneInfo& scene) { return scene.name == name; }))
    return {path.filename(), path};
  progress.report("making " + mesh, 0);
  const SceneMesh made{name, folder / (mesh + ".ply")};
  std::vector<std::string> command{voxdag_program(), "scene", name, "-o", made.path};
  if (!size.empty()) command.insert(command.end(), {"--size", size.substr(1)});
  const ChildResult result = run_child(command, folder, 0, progress);
  if (result.status != 0) throw Error(mesh, "", failure_of(result, 0));
  return made;
}

}  // namespace voxdag::lab
