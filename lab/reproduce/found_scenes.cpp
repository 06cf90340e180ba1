#include "lab/reproduce/found_scenes.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

#include "lab/build/bench_mesh.hpp"
#include "lab/papers/camera_paths.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {
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

/// Returns the options of `build` for the ESVO of a mesh.
std::vector<std::string> options_of(const MeshIdentity& mesh) {
  if (!mesh.is_displaced) return {};
  // Stones of about 1 m: Sibenik's unit is about 0.3 m, those of procedural scenes are metres.
  return {"--displace", mesh.is_procedural ? "stone:0.03:1.3" : "stone:0.15:4"};
}

/// Returns the size of a procedural scene of about half a million triangles.
double small_size_of(const std::string& name) {
  return name == "hairball" ? 300 : name == "city" ? 2 : name == "courtyard" ? 0.4 : 0;
}

/// Returns "sibenik.obj --displace stone:0.15:4".
std::string mesh_and_options(const FoundScene& scene) {
  return fmt::format("{}{}{}", scene.mesh.filename().string(), scene.options.empty() ? "" : " ",
                     fmt::join(scene.options, " "));
}

class SceneFinder {
 public:
  SceneFinder(Paper paper, bool small_stand_ins, const fs::path& made, CellStore& cells,
              Progress& progress)
      : paper_(paper),
        small_stand_ins_(small_stand_ins),
        made_(made),
        cells_(cells),
        progress_(progress) {}

  void look_at(const fs::path& file) {
    const PreparedMesh mesh = prepared(file);
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
      made_with_.size = small_stand_ins_ ? small_size_of(stand_in) : 0;
      prepared(made_with_.size > 0 ? fmt::format("{}:{}", stand_in, made_with_.size) : stand_in);
    }
    const auto found = found_.find(&scene);
    if (found != found_.end()) return found->second;
    FoundScene absent;
    absent.scene = &scene;
    return absent;
  }

 private:
  /// Prepares the mesh, and considers it as it is and displaced.
  PreparedMesh prepared(const std::string& file) {
    PreparedMesh mesh = prepare_mesh(file, made_, progress_);
    cells_.add_input(mesh.path, mesh.identity.file_check);
    consider(mesh);
    PreparedMesh displaced = mesh;
    displaced.identity.is_displaced = true;
    consider(displaced);
    return mesh;
  }

  void consider(const PreparedMesh& mesh) {
    PaperMatch match = match_paper_scene(paper_, mesh.identity);
    if (match.scene == nullptr) return;
    FoundScene& best = found_[match.scene];
    if (best.is_absent() || match.state < best.match.state)
      best = {match.scene, std::move(match), mesh.identity,
              mesh.path,   made_with_,       options_of(mesh.identity)};
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
  bool small_stand_ins_;
  SceneOptions made_with_;
  const fs::path& made_;
  CellStore& cells_;
  Progress& progress_;
  std::map<const PaperScene*, FoundScene> found_;
};

}  // namespace

std::string FoundScene::state() const {
  return is_absent() ? "absent" : std::string(name_of(match.state));
}

std::string FoundScene::title() const { return fmt::format("{} ({})", scene->name, state()); }

std::vector<FoundScene> find_scenes(Paper paper, const PapersPlan& plan, const fs::path& made,
                                    CellStore& cells, Progress& progress) {
  SceneFinder finder(paper, plan.small_stand_ins, made, cells, progress);
  for (const fs::path& file : mesh_files(plan.scenes)) finder.look_at(file);
  const std::vector<std::string>& only = plan.only;
  std::vector<FoundScene> scenes;
  for (const PaperScene& scene : paper_scenes())
    if (scene.paper == paper &&
        (only.empty() || std::find(only.begin(), only.end(), scene.name) != only.end()))
      scenes.push_back(finder.best_for(scene));
  return scenes;
}

std::optional<ScenePreset> preset_of(const FoundScene& scene) {
  if (scene.identity.is_procedural) return scene_preset(scene.identity.name, scene.made_with);
  const SceneFlight* flight = flight_of(scene.identity.file_check);
  if (flight == nullptr) return std::nullopt;
  return preset_of(*flight);
}

Section scenes_section(const std::vector<FoundScene>& scenes) {
  Section section{"The scenes", 2, {}};
  section.parts.emplace_back(Paragraph{
      "Published figures stand beside ours only if the mesh is the paper's scene (same) "
      "or another version of it (variant). A stand-in is another model of the same kind."});
  Table table{"Scenes of the paper", {"scene", "state", "mesh", "difference"}, {}, 4};
  for (const FoundScene& scene : scenes)
    table.rows.push_back({std::string(scene.scene->name), scene.state(),
                          scene.is_absent() ? "–" : mesh_and_options(scene),
                          scene.is_absent() ? "no such mesh was found" : scene.match.difference});
  section.parts.emplace_back(std::move(table));
  return section;
}

}  // namespace voxdag::lab
