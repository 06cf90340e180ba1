#pragma once
/// Builds models from files of voxels and points.
#include <string>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/file/model/dag_model.hpp"
#include "voxdag/formats/imports/import_voxels.hpp"
#include "voxdag/mesh/input_transform.hpp"

namespace voxdag {

struct ImportedModel {
  DagModel model;
  std::uint64_t read = 0;        ///< Points or voxels in the source.
  std::uint64_t outside = 0;     ///< Points outside of the bounds, which are left out.
  std::uint64_t unwanted = 0;    ///< Those that ImportOptions::labels leaves out.
  std::uint64_t not_finite = 0;  ///< Points that are not finite, which are left out.
  std::uint64_t too_large = 0;   ///< Splats that are too large, which are left out.
};

/// Throws Error, without a file, for options that the kind of source does not have, or needs.
void check_grid_options(const VoxelSource& source, const ImportOptions& options);

/// Imports a source with import_voxels(). The metadata call it `name` and have `transform`, which
/// moved it. Throws Error, OverMemory and Cancelled.
ImportedModel import_model(const VoxelSource& source, const ImportOptions& options,
                           const std::string& name, Work work = {},
                           const TransformRequest& transform = {});

}  // namespace voxdag
