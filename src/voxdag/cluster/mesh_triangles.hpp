#pragma once
/// The first step of a job: the triangles of the mesh, in segments.
#include <filesystem>
#include <vector>

#include "voxdag/cluster/ranks.hpp"
#include "voxdag/cluster/triangle_segments.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/readers/read_options.hpp"
#include "voxdag/voxelize/grid_request.hpp"

namespace voxdag {

/// The grid of a mesh, its size, and the segments that it is stored in.
struct MeshFacts {
  Grid grid;
  std::uint64_t vertices = 0, triangles = 0;
  std::uint64_t segments = 0, triangles_per_segment = 0;
};

/// Returns the facts of the mesh. If the folder does not have them, rank 0 reads the mesh and
/// writes them, and all segments. Collective. `reading` has the budget and the progress. Throws the
/// errors of read_mesh() and of grid_for(), OverMemory and Cancelled.
MeshFacts mesh_facts(Ranks& ranks, const WorkFolder& folder, const std::filesystem::path& mesh,
                     const GridRequest& request, const ReadOptions& reading);

/// Returns all segments, mapped. Rank 0 reads the mesh again and writes those that are missing or
/// damaged. Collective. Throws as mesh_facts() does.
std::vector<TriangleSegment> mesh_segments(Ranks& ranks, const WorkFolder& folder,
                                           const std::filesystem::path& mesh,
                                           const MeshFacts& facts, const ReadOptions& reading);

}  // namespace voxdag
