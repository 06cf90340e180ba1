#pragma once
/// Implements `voxdag bench esvo`: the tables of Laine and Karras, "Efficient Sparse Voxel
/// Octrees", I3D 2010, and the silhouette errors of cubes and contours.
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/esvo/picture_cost.hpp"
#include "lab/papers/paper_scenes.hpp"
#include "lab/report/bench_child.hpp"
#include "lab/report/charts.hpp"
#include "voxdag/core/parallel/progress.hpp"
#include "voxdag/cuda/device_choice.hpp"
#include "voxdag/image/image_size.hpp"

namespace voxdag::lab {

/// A scene from the command line.
struct EsvoBenchScene {
  std::string name;                  ///< As the tables name it.
  std::string mesh;                  ///< A file, or a procedural scene as NAME or NAME:SIZE.
  std::vector<std::string> options;  ///< More options of `build`.

  /// Returns whether the built surface is the mesh itself, without displacement.
  bool is_plain() const;
};

struct EsvoBenchPlan {
  std::vector<EsvoBenchScene> scenes;
  std::vector<int> levels;       ///< Ascending.
  std::vector<ImageSize> sizes;  ///< Sizes of the pictures whose rays are measured.
  int views = 4;
  int repeat = 3;  ///< Number of casts; the fastest counts.
  int threads = 0;
  float lod_pixels = 1;
  bool silhouettes = true;
  DeviceChoice device;  ///< Casts the rays of EsvoRateRow at octrees.
};

/// The compared forms: first those of the paper's Table 2, in its order; then contours on the
/// coarsest grid whose silhouettes are as good as those of the cubes.
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

/// One build, from the mesh file to the octree file.
struct EsvoBuildRun {
  std::string scene;
  PaperMatch paper;  ///< The scene of the paper that this one stands for.
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
  /// Returns the voxels per second of CPU time, with parsing and writing.
  double voxels_per_cpu_second() const { return static_cast<double>(voxels) / cost.cpu_seconds(); }
};

/// Primary rays of all views of a scene at one size; NaN for a form that was not measured.
struct EsvoRateRow {
  std::string scene;
  PaperMatch paper;  ///< As in EsvoBuildRun.
  int levels = 0;
  ImageSize size;
  std::uint64_t rays = 0;
  std::array<double, kEsvoForms.size()> mrays_per_second{};
  std::array<double, kEsvoForms.size()> agreement{};  ///< Fraction that agrees with the triangles.
  PictureCost seconds;                                ///< Of whole pictures of the contours.

  /// Returns the seconds of the casts at contours with beams.
  double cast_seconds() const {
    return static_cast<double>(rays) * 1e-6 /
           mrays_per_second[static_cast<std::size_t>(EsvoForm::kContoursBeams)];
  }

  /// Whether a CUDA device cast at the octrees. If so, the CPU cast the same rays: its rates, and
  /// the fraction of the rays for which both hit something or both miss, which must be 1. Else NaN.
  bool on_cuda = false;
  std::array<double, kEsvoForms.size()> cpu_mrays_per_second{};
  std::array<double, kEsvoForms.size()> agreement_with_cpu{};

  /// Returns the least agreement of all forms; 1 on the CPU.
  double least_agreement_with_cpu() const;
};

/// The silhouette errors at one resolution: the fraction of the rays to the finest voxels for which
/// a form and the triangles disagree on whether there is a hit.
struct SilhouetteRow {
  std::string scene;
  int levels = 0;
  double cubes = 0, contours = 0;
};

struct EsvoBenchResults {
  int threads = 0;
  std::string cuda_device;     ///< Device of the rates with on_cuda; empty: all are on the CPU.
  std::string device_failure;  ///< Why the plan's device could not cast rays, or empty.
  std::vector<EsvoBuildRun> builds;  ///< By scene, then levels; contours before cubes.
  std::vector<EsvoRateRow> rates;    ///< By scene, then size; at the finest grid that was built.
  std::vector<SilhouetteRow> silhouettes;
};

/// Parses "NAME=MESH", which may be followed by options of `build`, separated by spaces. Throws
/// std::invalid_argument.
EsvoBenchScene parse_esvo_scene(const std::string& text);

/// Builds both forms of every scene in child processes, then casts rays in this process. Records a
/// build that fails, and skips higher resolutions of its scene. Casts no rays if the device that
/// was asked for is missing. Throws Error, Cancelled.
EsvoBenchResults bench_esvo(const EsvoBenchPlan& plan, Progress& progress);

/// Casts rays at the octrees of a scene, and appends the rows. `mesh` is its file.
void bench_esvo_rays(const EsvoBenchPlan& plan, const EsvoBenchScene& scene,
                     const std::filesystem::path& mesh, Progress& progress,
                     EsvoBenchResults& results);

/// Returns the levels of the coarsest grid on which the silhouettes of contours are as good as
/// those of cubes on the finest grid. Returns 0 if no grid but the finest is good enough.
int coarse_levels(const std::vector<SilhouetteRow>& rows, const std::string& scene);

/// The number of levels by which cubes must be finer to be as good as the contours of a row.
struct LevelsSaved {
  double levels = 0;
  bool at_least = false;  ///< No measured cubes are as good: this is a lower bound.
};

/// Returns the saved levels, from the silhouettes of the scene: of cubes of the row's grid and
/// finer ones, or of coarser ones if contours are worse than cubes. Without wrong rays of the row's
/// cubes there is nothing to save: at least 0.
LevelsSaved levels_saved(const std::vector<SilhouetteRow>& rows, const SilhouetteRow& row);

/// Returns the results as JSON; bench/README.md lists the keys.
nlohmann::ordered_json esvo_bench_json(const EsvoBenchResults& results,
                                       const nlohmann::ordered_json& machine);
std::string esvo_bench_table(const EsvoBenchResults& results);
/// Returns a chart of megabytes, seconds and silhouettes over the resolution, beside the paper's
/// figures. Throws Error without any build.
Chart esvo_bench_chart(const EsvoBenchResults& results, const std::filesystem::path& file);
/// Returns a chart of rays per second as bars, a panel per scene. Throws Error without any rays.
Chart esvo_rays_chart(const EsvoBenchResults& results, const std::filesystem::path& file);

}  // namespace voxdag::lab
