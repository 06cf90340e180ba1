#pragma once
/// Implements `voxdag bench esvo-rays`: primary rays at ESVOs, as in Table 2 of Laine and Karras,
/// "Efficient Sparse Voxel Octrees", I3D 2010, and the silhouette errors of cubes and contours.
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lab/esvo/picture_cost.hpp"
#include "voxdag/core/parallel/progress.hpp"
#include "voxdag/cuda/device_choice.hpp"
#include "voxdag/image/image_size.hpp"

namespace voxdag::lab {

/// The files of both forms of a scene at one resolution.
struct EsvoPair {
  int levels = 0;
  std::filesystem::path contours, cubes;
};

struct EsvoRaysPlan {
  std::vector<EsvoPair> pairs;  ///< Ascending by levels; at least one.
  std::filesystem::path mesh;   ///< Of the ESVOs, for rays at triangles; empty: there are none.
  std::vector<ImageSize> sizes{{512, 384}, {1024, 768}, {2048, 1536}};  ///< Of the pictures.
  int views = 4;
  int repeat = 3;  ///< Number of casts; the fastest counts.
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

/// Primary rays of all views at one size, at the finest grid; NaN for a form that was not measured.
struct EsvoRateRow {
  ImageSize size;
  std::uint64_t rays = 0;
  std::array<double, kEsvoForms.size()> mrays_per_second{};
  std::array<double, kEsvoForms.size()> agreement{};  ///< Fraction that agrees with the triangles.
  PictureCost seconds;                                ///< Of whole pictures of the contours.

  /// Whether a CUDA device cast at the octrees. If so, the CPU cast the same rays: its rates, and
  /// the fraction of the rays for which both hit something or both miss, which must be 1. Else NaN.
  bool on_cuda = false;
  std::array<double, kEsvoForms.size()> cpu_mrays_per_second{};
  std::array<double, kEsvoForms.size()> agreement_with_cpu{};
};

/// The silhouette errors at one resolution: the fraction of the rays to the finest voxels for which
/// a form and the triangles disagree on whether there is a hit.
struct SilhouetteRow {
  int levels = 0;
  double cubes = 0, contours = 0;
};

struct EsvoRays {
  int levels = 0;                  ///< Of the finest grid.
  std::string cuda_device;         ///< Device of the rows with on_cuda; empty: all are on the CPU.
  std::vector<EsvoRateRow> rates;  ///< By size.
  std::vector<SilhouetteRow> silhouettes;  ///< By levels.
};

/// Casts rays at the octrees. Throws Error, also if the device that was asked for is missing, and
/// Cancelled.
EsvoRays measure_esvo_rays(const EsvoRaysPlan& plan, Progress& progress);

/// Returns the levels of the coarsest grid on which the silhouettes of contours are as good as
/// those of cubes on the finest grid. Returns 0 if no grid but the finest is good enough.
int coarse_levels(const std::vector<SilhouetteRow>& rows);

/// Returns the arrays "rays" and "silhouettes"; lab/README.md lists the keys. `processor`: name of
/// the CPU.
nlohmann::ordered_json esvo_rays_json(const EsvoRays& results, const std::string& processor);

}  // namespace voxdag::lab
