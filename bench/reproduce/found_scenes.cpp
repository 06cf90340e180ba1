#include "bench/reproduce/found_scenes.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "bench/build/bench_mesh.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

bool is_mesh_file(const fs::directory_entry& entry) {
  constexpr std::array kExtensions{".obj", ".ply", ".stl", ".off", ".gltf", ".glb"};
  const std::string extension = entry.path().extension();
  return entry.is_regular_file() &&
         std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

/// Returns the mesh files in the folder and below, sorted by path.
std::vector<fs::path> mesh_files(const fs::path& folder) {
  std::vector<fs::path> files;
  if (folder.empty()) return files;
  try {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
      if (is_mesh_file(entry)) files.push_back(fs::absolute(entry.path()));
  } catch (const fs::filesystem_error& error) {
    throw Error(folder, "", error.code().message());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class SceneFinder {
 public:
  SceneFinder(Paper paper, const fs::path& made, CellStore& cells, Progress& progress)
      : paper_(paper), made_(made), cells_(cells), progress_(progress) {}

  void look_at(const fs::path& file) {
    const PreparedMesh mesh = prepare_mesh(file, made_, progress_);
    cells_.add_input(mesh.path, mesh.identity.file_check);
    consider(mesh);
    // A mesh that is not known by its content may be a paper's by its name and triangle count.
    const auto scenes = paper_scenes();
    if (std::none_of(scenes.begin(), scenes.end(), [&](const PaperScene& scene) {
          return scene.paper == paper_ && scene.triangles != 0 &&
                 is_named_like(scene, mesh.identity.name);
        }))
      return;
    PreparedMesh counted = mesh;
    counted.identity.triangles = triangle_count(mesh.path);
    consider(counted);
  }

  FoundScene best_for(const PaperScene& scene) {
    const std::string stand_in(procedural_stand_in(scene));
    if (!found_.contains(&scene) && !stand_in.empty()) {
      const PreparedMesh mesh = prepare_mesh(stand_in, made_, progress_);
      cells_.add_input(mesh.path, mesh.identity.file_check);
      consider(mesh);
    }
    const auto found = found_.find(&scene);
    return found == found_.end() ? FoundScene{&scene, {}, {}, {}} : found->second;
  }

 private:
  void consider(const PreparedMesh& mesh) {
    PaperMatch match = match_paper_scene(paper_, mesh.identity);
    if (match.scene == nullptr) return;
    FoundScene& best = found_[match.scene];
    if (best.is_absent() || match.state < best.match.state)
      best = {match.scene, std::move(match), mesh.identity, mesh.path};
  }

  /// Returns 0 if the mesh cannot be read.
  std::uint64_t triangle_count(const fs::path& mesh) {
    Cell cell;
    cell.arguments = {"build", mesh, "-r", "4", "-o", "/dev/null", "--json"};
    cell.inputs = {mesh};
    const CellResult result = cells_.run(cell);
    return result.failure.empty() ? result.json.at("source").at("triangles").get<std::uint64_t>()
                                  : 0;
  }

  Paper paper_;
  const fs::path& made_;
  CellStore& cells_;
  Progress& progress_;
  std::map<const PaperScene*, FoundScene> found_;
};

}  // namespace

std::string FoundScene::state() const {
  return is_absent() ? "absent" : std::string(name_of(match.state));
}

std::vector<FoundScene> find_scenes(Paper paper, const fs::path& folder, const fs::path& made,
                                    const std::vector<std::string>& only, CellStore& cells,
                                    Progress& progress) {
  SceneFinder finder(paper, made, cells, progress);
  for (const fs::path& file : mesh_files(folder)) finder.look_at(file);
  std::vector<FoundScene> scenes;
  for (const PaperScene& scene : paper_scenes())
    if (scene.paper == paper &&
        (only.empty() || std::find(only.begin(), only.end(), scene.name) != only.end()))
      scenes.push_back(finder.best_for(scene));
  return scenes;
}

}  // namespace voxdag
