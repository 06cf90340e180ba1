#pragma once
/// The scenes that `voxdag bench trace` measures if no file is given.
#include <filesystem>
#include <vector>

#include "lab/trace/bench_trace.hpp"

namespace voxdag::lab {

/// Builds each scene of the list in memory, at each of `levels`, and measures it. The meshes are in
/// `folder` or in any folder below it. The results list scenes that fail. Throws Cancelled.
TraceResults bench_listed_scenes(const std::filesystem::path& folder,
                                 const std::vector<int>& levels, const TracePlan& plan,
                                 Progress& progress);

}  // namespace voxdag::lab
