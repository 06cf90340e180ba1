#pragma once
/// `voxdag bench esvo`: the tables of Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010,
/// and the error at silhouettes, of cubes and of contours.
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/report/bench_child.hpp"
#include "voxdag/image/image_size.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// A scene of the command line.
struct EsvoBenchScene {
  std::string name;                  ///< That of the paper's, where it is the same scene.
  std::string mesh;                  ///< A file, or a procedural scene as NAME or NAME:SIZE.
  std::vector<std::string> options;  ///< More options of `build`.

  /// Whether triangles of the mesh itself are what is built.
  bool is_plain() const;
};

struct EsvoBenchPlan {
  std::vector<EsvoBenchScene> scenes;
  std::vector<int> levels;       ///< Ascending.
  std::vector<ImageSize> sizes;  ///< Of pictures whose rays are measured.
  int views = 4;
  int repeat = 3;  ///< The fastest of so many casts counts.
  int threads = 0;
  float lod_pixels = 1;
  bool silhouettes = true;
};

/// What is compared, in the order of the paper's Table 2; then contours on a coarser grid whose
/// silhouettes are as good as those of the cubes.
enum class EsvoForm {
  kTriangles,
  kCubes,
  kContours,
  kContoursBeams,
  kCoarseContours,
  kCoarseContoursBeams
};
inline constexpr std::array kEsvoForms{EsvoForm::kTriangles,      EsvoForm::kCubes,
                                       EsvoForm::kContours,       EsvoForm::kContoursBeams,
                                       EsvoForm::kCoarseContours, EsvoForm::kCoarseContoursBeams};
std::string name_of(EsvoForm form);  ///< "contours_beams".

/// One build, from the mesh's file to the octree's.
struct EsvoBuildRun {
  std::string scene;
  int levels = 0;
  bool with_contours = true;
  double load_before = 0;
  std::string failure;  ///< Why there are no figures, or empty.
  ProcessCost cost;
  double read_seconds = 0, build_seconds = 0;  ///< Textures count as reading.
  std::uint64_t voxels = 0, bytes = 0, contours = 0, far_pointers = 0;
  std::filesystem::path file;

  double megabytes() const { return static_cast<double>(bytes) / (1 << 20); }
  double bytes_per_voxel() const {
    return voxels == 0 ? 0 : static_cast<double>(bytes) / static_cast<double>(voxels);
  }
  double voxels_per_second() const { return static_cast<double>(voxels) / build_seconds; }
  /// Parsing and writing included.
  double voxels_per_cpu_second() const { return static_cast<double>(voxels) / cost.cpu_seconds(); }
};

/// Primary rays of all views of a scene at one size; NaN for a form that was not measured.
struct EsvoRateRow {
  std::string scene;
  int levels = 0;
  ImageSize size;
  std::uint64_t rays = 0;
  std::array<double, kEsvoForms.size()> mrays_per_second{};
  std::array<double, kEsvoForms.size()> agreement{};  ///< With triangles: part of the rays.
};

/// At one resolution: for which part of the rays to the finest voxels a form meets something where
/// the triangles are not, or nothing where they are.
struct SilhouetteRow {
  std::string scene;
  int levels = 0;
  double cubes = 0, contours = 0;
};

struct EsvoBenchResults {
  int threads = 0;
  std::vector<EsvoBuildRun> builds;  ///< By scene, then levels; contours before cubes.
  std::vector<EsvoRateRow> rates;    ///< By scene, then size: of the finest that was built.
  std::vector<SilhouetteRow> silhouettes;
};

/// "NAME=MESH", and options of `build` after it, each as a word. Throws std::invalid_argument.
EsvoBenchScene parse_esvo_scene(const std::string& text);

/// Builds both forms of every scene in child processes, then casts rays in this one. A build that
/// fails is recorded and greater resolutions of the scene are left out. Throws Error, Cancelled.
EsvoBenchResults bench_esvo(const EsvoBenchPlan& plan, Progress& progress);

/// Casts at what was built of a scene, and appends the rows. `mesh` is its file.
void bench_esvo_rays(const EsvoBenchPlan& plan, const EsvoBenchScene& scene,
                     const std::filesystem::path& mesh, Progress& progress,
                     EsvoBenchResults& results);

/// The coarsest grid of the scene on which the silhouettes of contours are as good as those of
/// cubes on the finest; 0 where none but the finest is.
int coarse_levels(const std::vector<SilhouetteRow>& rows, const std::string& scene);

/// How many levels of cubes the contours of a row are worth.
struct LevelsSaved {
  double levels = 0;
  bool at_least = false;  ///< No cubes that were measured are as good.
};

/// By the silhouettes of the same scene.
LevelsSaved levels_saved(const std::vector<SilhouetteRow>& rows, const SilhouetteRow& row);

/// bench/README.md lists the keys.
nlohmann::ordered_json esvo_bench_json(const EsvoBenchResults& results,
                                       const nlohmann::ordered_json& machine);
std::string esvo_bench_table(const EsvoBenchResults& results);
/// Megabytes, seconds and silhouettes over the levels, the paper's as dashes.
std::string esvo_bench_svg(const EsvoBenchResults& results);
/// Bars of rays per second, a diagram for each scene.
std::string esvo_rays_svg(const EsvoBenchResults& results);

}  // namespace voxdag
