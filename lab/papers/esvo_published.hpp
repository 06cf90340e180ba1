#pragma once
/// Published figures for comparison. Samuli Laine, Tero Karras, Efficient Sparse Voxel Octrees, I3D
/// 2010, Tables 1 and 2: megabytes and seconds of builds on four cores of a
/// Core2 Quad Q9300, and million primary rays per second on a Quadro FX 5800.
#include <array>
#include <cmath>
#include <string_view>

#include "lab/papers/paper_scenes.hpp"

namespace voxdag::lab::published {

inline constexpr std::string_view kEsvoSource =
    "Laine and Karras 2010, Tables 1 and 2 (builds: Core2 Quad Q9300, 4 cores; rays: Quadro FX "
    "5800)";
inline constexpr int kEsvoFirstLevels = 10;
/// Columns of Table 2: triangles, cubes, contours, contours with beams.
inline constexpr std::size_t kEsvoRates = 4;
inline constexpr std::array<std::array<int, 2>, 3> kEsvoSizes{
    {{512, 384}, {1024, 768}, {2048, 1536}}};

/// Figures of one scene. NaN: not in the paper.
struct EsvoScene {
  std::string_view name;
  std::array<double, 7> megabytes, seconds;  ///< From 10 levels on.
  double bytes_per_voxel;
  std::array<std::array<double, kEsvoRates>, 3> mrays;  ///< Million rays per second, by size.
};

inline constexpr double kNone = NAN;
inline constexpr std::array<EsvoScene, 6> kEsvoScenes{{
    {"City",
     {13, 39, 131, 432, 1368, kNone, kNone},
     {14, 23, 48, 115, 311, kNone, kNone},
     5.44,
     {{{46.7, 45.1, 79.9, 88.6}, {68.5, 54.3, 89.1, 106.0}, {77.1, 63.9, 97.4, 123.8}}}},
    {"Sibenik",
     {41, 141, 440, 1034, 1857, kNone, kNone},
     {10, 31, 90, 194, 336, kNone, kNone},
     5.68,
     {{{64.3, 38.7, 80.0, 82.5}, {94.1, 46.5, 94.1, 103.6}, {107.1, 55.1, 103.9, 122.0}}}},
    {"Sibenik-D",
     {79, 314, 1192, 2806, kNone, kNone, kNone},
     {70, 274, 1342, 2541, kNone, kNone, kNone},
     8.10,
     {{{kNone, 24.8, 32.6, 37.5}, {kNone, 30.2, 38.7, 48.3}, {kNone, 37.1, 43.6, 60.9}}}},
    {"Hairball",
     {442, 1552, kNone, kNone, kNone, kNone, kNone},
     {294, 628, kNone, kNone, kNone, kNone, kNone},
     7.48,
     {{{11.6, 22.4, 24.1, 24.1}, {20.5, 22.5, 27.9, 28.4}, {31.2, 29.2, 36.5, 38.2}}}},
    {"Fairy",
     {11, 35, 99, 239, 376, 639, 1109},
     {6, 15, 38, 86, 121, 178, 282},
     5.62,
     {{{63.9, 62.1, 128.2, 132.6}, {125.1, 69.4, 145.4, 150.9}, {155.8, 78.6, 160.4, 169.2}}}},
    {"Conference",
     {17, 40, 96, 220, 512, 1328, kNone},
     {7, 13, 24, 51, 115, 288, kNone},
     5.16,
     {{{69.1, 35.8, 97.9, 104.4}, {111.9, 43.8, 110.3, 124.3}, {134.0, 52.3, 120.2, 140.8}}}},
}};

/// Returns the figures of the paper's scene of that name, or null.
inline const EsvoScene* esvo_scene_named(std::string_view name) {
  for (const EsvoScene& scene : kEsvoScenes)
    if (scene.name == name) return &scene;
  return nullptr;
}

/// Returns the figures of the paper's scene, or null if none may stand beside measured ones.
inline const EsvoScene* esvo_scene(const PaperMatch& paper) {
  return paper.has_figures() ? esvo_scene_named(paper.scene->name) : nullptr;
}

/// Returns the levels of the octree whose rates Table 2 has: the largest that fitted into 4 GB.
inline int esvo_levels_of_rates(const EsvoScene& scene) {
  int levels = kEsvoFirstLevels - 1;
  for (const double megabytes : scene.megabytes) levels += std::isnan(megabytes) ? 0 : 1;
  return levels;
}

/// Returns the rates for an octree of so many levels at a size of kEsvoSizes; NaN: not in the
/// paper.
inline std::array<double, kEsvoRates> esvo_mrays(const EsvoScene* scene, int levels, int width,
                                                 int height) {
  if (scene != nullptr && levels == esvo_levels_of_rates(*scene))
    for (std::size_t i = 0; i < kEsvoSizes.size(); ++i)
      if (kEsvoSizes[i] == std::array<int, 2>{width, height}) return scene->mrays[i];
  return {kNone, kNone, kNone, kNone};
}

inline double esvo_of_levels(const std::array<double, 7>& values, int levels) {
  const int column = levels - kEsvoFirstLevels;
  return column < 0 || column >= 7 ? kNone : values[static_cast<std::size_t>(column)];
}

/// Returns the voxels per core and second; NaN if the paper has no such octree. Assumes megabytes
/// of 2^20 bytes, and for all octrees the bytes per voxel of the largest one.
inline double esvo_voxels_per_core_second(const EsvoScene* scene, int levels) {
  constexpr double kCores = 4;
  if (scene == nullptr) return kNone;
  return esvo_of_levels(scene->megabytes, levels) * 0x1p20 / scene->bytes_per_voxel /
         (esvo_of_levels(scene->seconds, levels) * kCores);
}

}  // namespace voxdag::lab::published
