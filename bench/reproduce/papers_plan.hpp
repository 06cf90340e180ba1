#pragma once
/// What `voxdag bench papers` measures.
#include <cstdint>
#include <filesystem>
#include <vector>

namespace voxdag {

struct PapersPlan {
  std::filesystem::path scenes;   ///< Folder of meshes; empty: procedural stand-ins only.
  std::filesystem::path folder;   ///< Where the report and its results go.
  std::vector<std::string> only;  ///< Names of paper scenes; empty: all.
  std::vector<int> table1_levels{9, 10, 11, 12, 13};
  std::vector<int> table2_levels{11, 12, 13, 14, 15, 16};
  double cell_seconds = 600;       ///< Time limit of one run.
  std::uint64_t memory_bytes = 0;  ///< `--memory` of every build; 0: its default.
  int threads = 0;                 ///< 0: one per processor.
};

/// Makes the plan one that finishes within minutes: coarse grids and procedural stand-ins alone.
inline void make_quick(PapersPlan& plan) {
  plan.scenes.clear();
  plan.table1_levels = {9, 10, 11};
  plan.table2_levels = {9, 10, 11, 12};
}

}  // namespace voxdag
