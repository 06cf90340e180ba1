#pragma once
/// Builds the attributes of a DAG: numbers of its cells, filtered and compressed colours and
/// normals, materials, and the channels `metallic` and `roughness`.
#include <string_view>

#include "voxdag/builders/attributes/filter_cells.hpp"
#include "voxdag/builders/attributes/filter_materials.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/attributes/dag_attributes.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {

struct AttributeOptions {
  bool colors = false, normals = false, materials = false;
  /// Channels of the kind u8: 255 stands for 1. The shading must have these numbers. With the
  /// members above, at least one is set.
  bool metallic = false, roughness = false;
  bool has_channels() const { return metallic || roughness; }
  /// Adds the channel "metallic" or "roughness". Throws std::invalid_argument for another name.
  void add_channel(std::string_view name);
  TriangleIds ids;       ///< Stored instead of materials, if there are some.
  int finest_level = 0;  ///< m: cells of levels 0 to m get attributes.
  /// The largest error of a stored colour, 0 to 1: the square root of the mean of the channels'
  /// squared differences, sRGB encoded, with the weights kColorWeights. 0: lossless.
  double color_bound = 0.05;
  /// The largest angle between a stored and a filtered normal, kMinNormalBound to 180 degrees.
  double normal_bound_degrees = 5;
};

/// Builds the attributes of `dag`, the DAG of `mesh` in `grid`. `shading` is the shading of the
/// mesh; null: grey. For materials without ids, the mesh must have a material for each triangle,
/// and at most kMaxMaterials materials. The result depends on mesh, shading, grid and options
/// alone, not on the number of threads. The budget no longer counts the result when the function
/// returns. Throws OverMemory and Cancelled.
DagAttributes build_attributes(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                               const SurfaceShading* shading, const AttributeOptions& options,
                               Work work = {});

/// Returns the number of cells of levels 0 to `level`, 0 to L, of a DAG with these counts.
std::uint64_t count_cells(const SvdagCounts& counts, int level);

/// Returns the finest level whose attributes are expected to fit into `bytes`; 0 if none fits.
/// Expects 8 bits per cell for colours, 8 for normals, 1 for materials and 16 for each channel (8
/// of them during the build alone), where they are wanted.
int finest_level_within(const SvdagCounts& counts, const AttributeOptions& options,
                        std::uint64_t bytes);

}  // namespace voxdag
