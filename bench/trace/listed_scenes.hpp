#pragma once
/// The scenes that `voxdag bench trace` measures if it is given no file.
#include <filesystem>
#include <vector>

#include "bench/trace/bench_trace.hpp"

namespace voxdag {

/// Builds each scene of the list at each of `levels` in memory and measures it. `folder` holds the
/// meshes, in any folder below it. Scenes that fail are listed in the results. Throws Cancelled.
TraceResults bench_listed_scenes(const std::filesystem::path& folder,
                                 const std::vector<int>& levels, const TracePlan& plan,
                                 Progress& progress);

}  // namespace voxdag
