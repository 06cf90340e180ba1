#pragma once
/// What `voxdag bench build` found, for people, for programs, and as a picture.
#include <nlohmann/json.hpp>
#include <string>

#include "bench/build/bench_build.hpp"

namespace voxdag {

/// Factors from one resolution to the next greater one that was measured, per level between them.
struct Growth {
  double wall = 0, cpu = 0, voxels = 0, dag_bytes = 0;
};

/// Growth that led to `builds[index]`; zeros where no lesser resolution of the same was measured.
Growth growth_to(const std::vector<BuildRun>& builds, std::size_t index);

/// The keys are listed in bench/README.md.
nlohmann::ordered_json bench_json(const BenchResults& results,
                                  const nlohmann::ordered_json& machine);

/// Tables: builds of each scene, their stages, sorting beside the paper's, rivals beside ours.
std::string bench_table(const BenchResults& results);

/// An SVG of seconds and bytes against the resolution, with the growth of each DAG as dashes.
std::string bench_svg(const BenchResults& results);

}  // namespace voxdag
