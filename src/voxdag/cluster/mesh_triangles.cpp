#include "voxdag/cluster/mesh_triangles.hpp"

#include <algorithm>
#include <cstring>
#include <optional>
#include <tuple>

#include "voxdag/cluster/missing_files.hpp"
#include "voxdag/cluster/shared_mesh.hpp"
#include "voxdag/core/float_origin.hpp"

namespace voxdag {
namespace {

constexpr const char *kSegmentFolder = "triangles", *kFacts = "triangles/mesh";

/// Writes the segments that the folder lacks, shared among the ranks. Collective.
void write_segments(const MeshJob& job, const SharedMesh& mesh, const MeshFacts& facts) {
  const Work work = job.reading.work;
  make_missing(job.ranks, job.folder, {kSegmentCounter, facts.segments, segment_name, "triangles"},
               work, [&](std::uint64_t s) {
                 const std::uint64_t first = s * facts.triangles_per_segment;
                 write_segment(job.folder, s, mesh, facts.grid, first,
                               std::min(first + facts.triangles_per_segment, facts.triangles),
                               work);
                 mesh.release();
               });
}

bool has_facts(const MeshJob& job) {
  const std::uint64_t has = job.ranks.rank() == 0 && job.folder.open(kFacts, job.reading.work);
  return job.ranks.all_gather({&has, 1})[0] != 0;
}

/// Returns the grid for a mesh with these bounds. Collective; errors are those of rank 0.
Grid grid_of(const MeshJob& job, const Box3d& bounds) {
  std::vector<std::byte> bytes(sizeof(Grid));
  if (job.ranks.rank() == 0) {
    const Grid grid = grid_for(job.grid.bounds ? Box3d::empty() : bounds, job.grid);
    std::memcpy(bytes.data(), &grid, sizeof grid);
  }
  job.ranks.broadcast(bytes);
  Grid grid;
  std::memcpy(&grid, bytes.data(), sizeof grid);
  return grid;
}

MeshFacts stored_facts(const MeshJob& job) {
  return job.folder.open_seen(kFacts, job.reading.work).values<MeshFacts>()[0];
}

/// Returns whether a segment is missing or damaged. Collective.
bool lacks_segments(const MeshJob& job, std::uint64_t segments) {
  std::uint64_t lacks = 0;
  for (auto s = static_cast<std::uint64_t>(job.ranks.rank()); s < segments && lacks == 0;
       s += static_cast<std::uint64_t>(job.ranks.count()))
    lacks = job.folder.open(segment_name(s), job.reading.work) ? 0 : 1;
  const std::vector<std::uint64_t> all = job.ranks.all_gather({&lacks, 1});
  return std::find(all.begin(), all.end(), 1) != all.end();
}

}  // namespace

MeshFacts mesh_facts(const MeshJob& job) {
  if (has_facts(job)) return stored_facts(job);
  SharedMesh mesh(job.ranks, job.folder, job.mesh, job.reading, job.chunk_bytes);
  mesh.move(job.transform);
  MeshFacts facts;
  Box3d bounds = Box3d::empty();
  std::tie(bounds, facts.bad_triangles) = mesh.used_vertices();
  facts.rounding = float_rounding(bounds, mesh.origin());
  facts.grid = grid_of(job, bounds);
  facts.vertices = mesh.count_vertices();
  facts.triangles = mesh.triangles().size();
  const std::uint64_t per_segment = segment_triangles(*job.reading.work.memory);
  facts.triangles_per_segment = job.ranks.all_gather({&per_segment, 1})[0];
  facts.segments =
      (facts.triangles + facts.triangles_per_segment - 1) / facts.triangles_per_segment;
  // Segments of a job without facts may hold other ranges of triangles.
  if (job.ranks.rank() == 0) {
    job.folder.remove(kSegmentFolder);
    WorkFileWriter file = job.folder.create(kFacts);
    file.write_value(facts);
    file.commit();
  }
  job.ranks.barrier();
  write_segments(job, mesh, facts);
  return stored_facts(job);
}

std::vector<TriangleSegment> mesh_segments(const MeshJob& job, const MeshFacts& facts) {
  if (lacks_segments(job, facts.segments)) {
    SharedMesh mesh(job.ranks, job.folder, job.mesh, job.reading, job.chunk_bytes);
    mesh.move(job.transform);
    write_segments(job, mesh, facts);
  }
  if (job.ranks.rank() == 0) job.folder.remove(kMeshFolder);
  std::vector<TriangleSegment> segments;
  for (std::uint64_t s = 0; s < facts.segments; ++s)
    segments.emplace_back(job.folder.open_seen(segment_name(s), job.reading.work));
  return segments;
}

}  // namespace voxdag
