#pragma once
/// Builds of one mesh at ascending resolutions.
#include <map>
#include <string>
#include <vector>

#include "bench/reproduce/cells.hpp"
#include "bench/reproduce/papers_plan.hpp"

namespace voxdag {

enum class BuildKind {
  kPaper,  ///< The DAG, by the paper's method.
  kHash,   ///< The DAG, by voxdag's method.
  kEsvo,   ///< The ESVO with colours and normals, which must be uniform in a leaf.
  kShape,  ///< The ESVO's shape: no colours, no normals.
};

/// A build, or the reason why there is none.
struct SeriesBuild {
  int levels = 0;
  Cell cell;
  CellResult result;
};

/// Returns the build of `mesh` at 2^levels with the plan's memory and threads, and more options.
Cell build_cell(const PapersPlan& plan, const std::filesystem::path& mesh, int levels,
                const std::filesystem::path& output, const std::vector<std::string>& options);

/// Builds the mesh at each of the ascending `levels`. After a build that fails, or that predicts
/// that the next one exceeds the time limit, records the reason for the others.
std::vector<SeriesBuild> build_series(const PapersPlan& plan, BuildKind kind,
                                      const std::filesystem::path& mesh,
                                      const std::vector<int>& levels, CellStore& cells,
                                      Progress& progress);

/// Returns about the seconds that build_series() takes for a scene of some hundred thousand
/// triangles on two cores.
double typical_seconds(const PapersPlan& plan, BuildKind kind, const std::vector<int>& levels);

}  // namespace voxdag
