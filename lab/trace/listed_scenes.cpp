#include "lab/trace/listed_scenes.hpp"

#include <array>

#include "lab/report/scratch_folder.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/formats/scenes/scenes.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

/// A scene of the list: a mesh in the folder of scenes or below it, or a procedural scene.
struct ListedScene {
  const char* name;
  const char* file;  ///< Null: the procedural scene of that name.
};

constexpr std::array kScenes{ListedScene{"crytek_sponza", "sponza.obj"},
                             ListedScene{"sibenik", "sibenik.obj"},
                             ListedScene{"sanmiguel_core", "sanmiguel_core.ply"},
                             ListedScene{"lucy", "lucy.ply"}, ListedScene{"hairball", nullptr}};

Mesh mesh_of(const ListedScene& scene, const fs::path& folder, Progress& progress) {
  if (scene.file == nullptr) return make_scene(scene.name);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename() == scene.file) return read_mesh(entry.path(), {&progress});
  throw Error(folder, "", std::string("has no ") + scene.file);
}

/// Builds the scene and measures it.
void bench_listed(const ListedScene& listed, const Mesh& mesh, int levels, const TracePlan& plan,
                  Progress& progress, TraceResults& results) {
  MemoryBudget memory = command_budget(0);
  VdagMetadata metadata;
  metadata.grid = fit_grid(mesh, levels);
  const Svdag dag = build_svdag(mesh, metadata.grid, {}, {&memory, &progress}).dag;
  TraceScene scene{listed.name, metadata.grid, dag.view(), &mesh, {}};
  const ScratchFolder folder;
  if (plan.program_option() != nullptr) {
    metadata.counts = count_svdag(dag.view());
    scene.file = folder.path() / "scene.vdag";
    write_vdag(scene.file, dag.view(), metadata);
  }
  bench_trace(scene, plan, progress, results);
}

}  // namespace

TraceResults bench_listed_scenes(const fs::path& folder, const std::vector<int>& levels,
                                 const TracePlan& plan, Progress& progress) {
  TraceResults results;
  for (const ListedScene& listed : kScenes) {
    try {
      const Mesh mesh = mesh_of(listed, folder, progress);
      for (const int level : levels) bench_listed(listed, mesh, level, plan, progress, results);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      results.failures.push_back(std::string(listed.name) + ": " + error.what());
    }
  }
  return results;
}

}  // namespace voxdag::lab
