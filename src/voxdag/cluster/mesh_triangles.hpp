#pragma once
/// The first step of a job: the triangles of the mesh, in segments.
#include <filesystem>
#include <vector>

#include "voxdag/builders/voxelize/grid_request.hpp"
#include "voxdag/cluster/ranks.hpp"
#include "voxdag/cluster/triangle_segments.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/formats/readers/read_options.hpp"
#include "voxdag/mesh/input_transform.hpp"

namespace voxdag {

/// The mesh of a job, and where to put its triangles.
struct MeshJob {
  Ranks& ranks;
  const WorkFolder& folder;
  const std::filesystem::path& mesh;
  const GridRequest& grid;
  ReadOptions reading;            ///< Has the budget and the progress.
  std::size_t chunk_bytes;        ///< Of the mesh file; see SharedMesh.
  InputTransform transform = {};  ///< Moves the mesh before the grid is placed.
};

/// The grid of a mesh, its size, and the segments that it is stored in.
struct MeshFacts {
  Grid grid;
  std::uint64_t vertices = 0, triangles = 0;
  std::uint64_t bad_triangles = 0;  ///< Left out: they have a vertex that is not finite.
  double rounding = 0;              ///< Largest error of a vertex in float32: float_rounding().
  std::uint64_t segments = 0, triangles_per_segment = 0;
};

/// Returns the facts of the mesh. If the folder does not have them, the ranks read the mesh and
/// write them, and all segments. Collective. Throws the errors of read_mesh() and of grid_for(),
/// OverMemory and Cancelled.
MeshFacts mesh_facts(const MeshJob& job);

/// Returns all segments, mapped, and removes the mesh from the folder. If some are missing or
/// damaged, the ranks read the mesh again and write them. Collective. Throws as mesh_facts() does.
std::vector<TriangleSegment> mesh_segments(const MeshJob& job, const MeshFacts& facts);

}  // namespace voxdag
