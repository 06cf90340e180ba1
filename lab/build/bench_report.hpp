#pragma once
/// Reports the results of `voxdag bench build` as tables, JSON and a chart.
#include <nlohmann/json.hpp>
#include <string>

#include "lab/build/bench_build.hpp"
#include "lab/report/charts.hpp"

namespace voxdag::lab {

/// Growth factors per level, from one measured resolution to the next higher one.
struct Growth {
  double wall = 0, cpu = 0, voxels = 0, dag_bytes = 0;
};

/// Returns the growth to `builds[index]`; zeros if no lower resolution of its series was measured.
Growth growth_to(const std::vector<BuildRun>& builds, std::size_t index);

/// Returns the JSON; bench/README.md lists the keys.
nlohmann::ordered_json bench_json(const BenchResults& results,
                                  const nlohmann::ordered_json& machine);

/// Returns tables: builds of each scene, their stages, sorting with the paper's figures, rivals.
std::string bench_table(const BenchResults& results);

/// Returns a chart of seconds and bytes over the resolution. Throws Error without any build.
Chart bench_chart(const BenchResults& results, const std::filesystem::path& file);

}  // namespace voxdag::lab
