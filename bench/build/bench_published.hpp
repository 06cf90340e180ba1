#pragma once
/// Published figures, for comparison with measured ones. Viktor Kämpe, Erik Sintorn, Ulf Assarsson,
/// High Resolution Sparse Voxel DAGs, ACM Transactions on Graphics 32(4), SIGGRAPH 2013, Table 1:
/// seconds to reduce an SVO to a DAG, and the part of them spent in sorting, on an Intel Core i7
/// 3930K (six cores). Rows of Hairball and Lucy as corrected for an interleaving in the print.
#include <array>
#include <optional>
#include <string_view>

#include "bench/papers/paper_scenes.hpp"

namespace voxdag::published {

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

/// Returns the published figures of the scene at 2^levels, if there are any.
inline std::optional<ReductionSeconds> reduction_of(const PaperMatch& paper, int levels) {
  const int column = levels - kFirstLevels;
  if (!paper.has_figures() || column < 0 || column >= 5) return {};
  for (const Reduction& row : kReductions)
    if (row.scene == paper.scene->name)
      return ReductionSeconds{row.scene, row.total_seconds[static_cast<std::size_t>(column)],
                              row.sorting_seconds[static_cast<std::size_t>(column)]};
  return {};
}

}  // namespace voxdag::published
