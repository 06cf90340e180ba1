#pragma once
/// Builds the attributes of a DAG: numbers of its cells, filtered and compressed colours and
/// normals, and materials.
#include "voxdag/attributes/filter_cells.hpp"
#include "voxdag/attributes/value_encoder.hpp"
#include "voxdag/layout/stored_attributes.hpp"
#include "voxdag/layout/svdag_counts.hpp"

namespace voxdag {

/// Weights of red, green and blue in errors of colours.
inline constexpr std::array<int, 3> kColorWeights{2, 4, 1};
/// The smallest bound on errors of normals, in degrees: rounding a normal to 8 bits can turn it by
/// almost this angle.
inline constexpr double kLeastNormalBound = 0.4;

struct AttributeOptions {
  bool colors = false, normals = false, materials = false;  ///< At least one.
  int finest_level = 0;  ///< m: cells of levels 0 to m get attributes.
  /// The largest error of a stored colour, 0 to 1: the square root of the mean of the channels'
  /// squared differences, sRGB encoded, with the weights kColorWeights. 0: lossless.
  double color_bound = 0.05;
  /// The largest angle between a stored and a filtered normal, kLeastNormalBound to 180 degrees.
  double normal_bound_degrees = 5;
  MemoryBudget* memory = nullptr;  ///< Counts the builder's memory. Null: no limit.
};

/// Returns a metric that keeps the angle between stored normals and unit normals, which
/// pack_normal() rounds, within a bound of kLeastNormalBound to 180 degrees.
ValueMetric make_normal_metric(double degrees);

/// Attributes in memory. The view is valid while this object lives unchanged.
struct DagAttributes {
  CellIndex index;
  ValuePages colors, normals;
  MaterialIds materials;
  ValueErrors color_errors, normal_errors;

  DagAttributesView view() const {
    return {index.view(), colors.view(), normals.view(), materials.view()};
  }
  std::uint64_t bytes() const {
    return index.view().bytes() + colors.view().bytes() + normals.view().bytes() +
           materials.view().bytes();
  }
};

/// Builds the attributes of `dag`, the DAG of `mesh` in `grid`. `shading` is the shading of the
/// mesh; null: grey. For materials, the mesh must have a material for each triangle, and at most
/// kMostMaterials materials. The result depends on mesh, shading, grid and options alone, not on
/// the number of threads. The budget no longer counts the result when the function returns. Throws
/// OverMemory and Cancelled.
DagAttributes build_attributes(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                               const SurfaceShading* shading, const AttributeOptions& options,
                               Progress* progress = nullptr);

/// Returns the number of cells of levels 0 to `level`, 0 to L, of a DAG with these counts.
std::uint64_t count_cells(const SvdagCounts& counts, int level);

/// Returns the finest level whose attributes are expected to fit into `bytes`; 0 if none fits.
/// Expects 8 bits per cell for colours, 8 for normals and 1 for materials, where they are wanted.
int finest_level_within(const SvdagCounts& counts, const AttributeOptions& options,
                        std::uint64_t bytes);

}  // namespace voxdag
