#pragma once
/// Published figures, for comparison with measured ones. Viktor Kämpe, Erik Sintorn, Ulf Assarsson,
/// High Resolution Sparse Voxel DAGs, ACM Transactions on Graphics 32(4), SIGGRAPH 2013.
/// Table 1: seconds to reduce an SVO to a DAG, and the part of them spent in sorting, on an Intel
/// Core i7 3930K (six cores). Rows of Hairball and Lucy as corrected for an interleaving in the
/// print. Table 2: nodes and memory of DAG, ESVO and SVO.
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "lab/papers/paper_scenes.hpp"

namespace voxdag::lab::published {

inline constexpr std::string_view kSource =
    "Kämpe et al. 2013, Table 1 (Core i7-3930K of 2011, 6 cores)";
inline constexpr int kCores = 6;
inline constexpr int kFirstLevels = 9;  ///< The columns are 512³, 1024³, ... 8192³.

struct Reduction {
  std::string_view scene;
  std::array<double, 5> total_seconds, sorting_seconds;
};

inline constexpr std::array<Reduction, 5> kReductions{{
    {"Crysponza", {.0084, .033, .3, 1.0, 4.5}, {.0019, .0055, .05, .14, .6}},
    {"EpicCitadel", {.0015, .005, .05, .2, .8}, {.0007, .0012, .006, .024, .1}},
    {"SanMiguel", {.0026, .0083, .06, .23, .95}, {.0013, .0017, .008, .03, .14}},
    {"Hairball", {.043, .202, 2.19, 9.7, 40.6}, {.0051, .029, .23, 1.0, 4.5}},
    {"Lucy", {.0026, .0084, .08, .31, 1.3}, {.0007, .0016, .009, .04, .14}},
}};

struct ReductionSeconds {
  std::string_view scene;
  double total, sorting;
};

/// Returns the published figures of the paper's scene of that name at 2^levels, if there are any.
inline std::optional<ReductionSeconds> reduction_at(std::string_view scene, int levels) {
  const int column = levels - kFirstLevels;
  if (column < 0 || column >= 5) return {};
  for (const Reduction& row : kReductions)
    if (row.scene == scene)
      return ReductionSeconds{row.scene, row.total_seconds[static_cast<std::size_t>(column)],
                              row.sorting_seconds[static_cast<std::size_t>(column)]};
  return {};
}

/// Returns the published figures that may stand beside those of the mesh at 2^levels.
inline std::optional<ReductionSeconds> reduction_of(const PaperMatch& paper, int levels) {
  if (!paper.has_figures()) return {};
  return reduction_at(paper.scene->name, levels);
}

inline constexpr std::string_view kTable2Source = "Kämpe et al. 2013, Table 2";
inline constexpr int kTable2FirstLevels = 11;  ///< The columns are 2048³, 4096³, ... 65536³.

/// One structure's row of Table 2. NaN: not in the paper.
struct StructureSizes {
  std::array<double, 6> million_nodes, megabytes;  ///< Megabytes of 2^20 bytes.
};

struct SceneSizes {
  std::string_view scene;
  StructureSizes dag, esvo, svo;
};

inline constexpr double kNoFigure = NAN;
inline constexpr std::array<SceneSizes, 5> kSizes{{
    {"Crysponza",
     {{1, 1, 2, 4, 9, 23}, {4, 11, 27, 71, 184, 476}},
     {{5, 12, 32, 94, 226, 521}, {38, 88, 243, 715, 1721, 3970}},
     {{12, 51, 205, 822, 3290, 13169}, {12, 48, 195, 784, 3138, 12559}}},
    {"EpicCitadel",
     {{1, 1, 1, 3, 7, 18}, {3, 7, 19, 53, 142, 371}},
     {{1, 3, 7, 17, 38, 81}, {7, 20, 53, 124, 287, 613}},
     {{2, 6, 21, 85, 340, 1364}, {2, 5, 20, 81, 324, 1301}}},
    {"SanMiguel",
     {{1, 1, 2, 5, 13, 34}, {3, 10, 31, 93, 270, 742}},
     {{4, 14, 57, 229, 922, 3698}, {26, 107, 433, 1747, 7030, 28212}},
     {{4, 14, 56, 224, 903, 3628}, {4, 13, 53, 214, 861, 3460}}},
    {"Hairball",
     {{5, 15, 44, 115, kNoFigure, kNoFigure}, {117, 339, 996, 2629, kNoFigure, kNoFigure}},
     {{53, 224, 924, 3649, kNoFigure, kNoFigure}, {401, 1709, 7049, 27837, kNoFigure, kNoFigure}},
     {{45, 188, 781, 3191, kNoFigure, kNoFigure}, {43, 180, 745, 3044, kNoFigure, kNoFigure}}},
    {"Lucy",
     {{1, 1, 2, 6, 16, 46}, {3, 10, 32, 110, 348, 983}},
     {{2, 8, 26, 76, 160, 255}, {15, 56, 198, 576, 1219, 1941}},
     {{2, 7, 27, 108, 430, 1720}, {2, 7, 26, 103, 410, 1640}}},
}};

/// Returns the published sizes of the paper's scene of that name, or null.
inline const SceneSizes* sizes_of(std::string_view scene) {
  for (const SceneSizes& row : kSizes)
    if (row.scene == scene) return &row;
  return nullptr;
}

/// Bits per voxel at the highest resolution that the paper built.
struct BitsPerVoxel {
  std::string_view scene, resolution;
  double dag, svo;
};

inline constexpr std::array<BitsPerVoxel, 5> kBitsPerVoxel{{{"Crysponza", "64K³", 0.08, 2.07},
                                                            {"EpicCitadel", "64K³", 0.65, 2.29},
                                                            {"SanMiguel", "64K³", 0.45, 2.08},
                                                            {"Hairball", "16K³", 2.24, 2.59},
                                                            {"Lucy", "64K³", 1.54, 2.57}}};

/// Returns the bits per voxel of the paper's scene of that name, or null.
inline const BitsPerVoxel* bits_of(std::string_view scene) {
  for (const BitsPerVoxel& row : kBitsPerVoxel)
    if (row.scene == scene) return &row;
  return nullptr;
}

/// The scene and the rates of Figure 1.
struct Figure1 {
  std::string_view scene, device;
  int levels;
  double voxels, dag_megabytes, svo_megabytes;
  double shadow_rays_per_second, occlusion_rays_per_second;
};

inline constexpr Figure1 kFigure1{"EpicCitadel", "GTX680", 17, 19e9, 945, 5.1 * 1024, 240e6, 170e6};

/// Returns the value at 2^levels of a row of Table 2; NaN: not in the paper.
inline double at_levels(const std::array<double, 6>& values, int levels) {
  const int column = levels - kTable2FirstLevels;
  return column < 0 || column >= 6 ? kNoFigure : values[static_cast<std::size_t>(column)];
}

}  // namespace voxdag::lab::published
