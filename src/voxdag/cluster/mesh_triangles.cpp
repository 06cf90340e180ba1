#include "voxdag/cluster/mesh_triangles.hpp"

#include <algorithm>
#include <optional>

#include "voxdag/core/error.hpp"
#include "voxdag/io/mapped_arrays.hpp"
#include "voxdag/mesh/mesh_memory.hpp"
#include "voxdag/parallel/polled_for.hpp"
#include "voxdag/readers/read_mesh.hpp"

namespace voxdag {
namespace {

constexpr const char* kFacts = "triangles/mesh";

/// A mesh whose arrays lie in files of the work folder.
class HeldMesh {
 public:
  HeldMesh(const WorkFolder& folder, const std::filesystem::path& path, ReadOptions reading)
      : arrays_(folder.file(kFacts).parent_path()), budget_(reading.memory) {
    reading.arrays = &arrays_;
    mesh_ = read_mesh(path, reading);
    bytes_ = memory_bytes(mesh_);
  }
  ~HeldMesh() {
    if (budget_ != nullptr) budget_->release(bytes_);
  }
  HeldMesh(const HeldMesh&) = delete;
  HeldMesh& operator=(const HeldMesh&) = delete;

  const Mesh& get() const { return mesh_; }
  /// Drops the pages of the mesh from memory.
  void release() const { arrays_.release(); }

  /// Returns what referenced_bounds() returns, and drops the pages as it goes.
  Box3d bounds(const Progress* progress) const {
    constexpr std::size_t kStep = std::size_t{1} << 20;
    Box3f bounds = Box3f::empty();
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      if (i % kStep == 0) release();
      poll_seldom(progress, i);
      for (const std::uint32_t vertex : mesh_.triangles[i]) bounds.extend(mesh_.vertices[vertex]);
    }
    return {static_cast<Vec3d>(bounds.lo), static_cast<Vec3d>(bounds.hi)};
  }

 private:
  MappedArrays arrays_;
  Mesh mesh_;
  MemoryBudget* budget_;
  std::uint64_t bytes_ = 0;
};

/// Writes the segments that the folder lacks.
void write_segments(const WorkFolder& folder, const HeldMesh& mesh, const MeshFacts& facts,
                    const std::vector<bool>& is_missing, const ReadOptions& reading) {
  for (std::uint64_t s = 0; s < facts.segments; ++s) {
    poll(reading.progress);
    if (reading.progress != nullptr)
      reading.progress->report("triangles",
                               static_cast<double>(s) / static_cast<double>(facts.segments));
    if (!is_missing[s]) continue;
    const std::uint64_t first = s * facts.triangles_per_segment;
    write_segment(folder, s, mesh.get(), facts.grid, first,
                  std::min(first + facts.triangles_per_segment, facts.triangles), *reading.memory,
                  reading.progress);
    mesh.release();
  }
}

std::optional<MeshFacts> stored_facts(const WorkFolder& folder, const Progress* progress) {
  const std::optional<WorkFile> file = folder.open(kFacts, progress);
  if (!file || file->bytes().size() != sizeof(MeshFacts)) return std::nullopt;
  return file->values<MeshFacts>()[0];
}

/// Returns which segments are missing or damaged; removes the damaged ones.
std::vector<bool> missing_segments(Ranks& ranks, const WorkFolder& folder, std::uint64_t segments,
                                   const Progress* progress) {
  std::vector<std::uint64_t> mine(segments);
  for (auto s = static_cast<std::uint64_t>(ranks.rank()); s < segments;
       s += static_cast<std::uint64_t>(ranks.count())) {
    if (folder.open(segment_name(s), progress)) continue;
    folder.remove(segment_name(s));
    mine[s] = 1;
  }
  const std::vector<std::uint64_t> all = ranks.all_gather(mine);
  std::vector<bool> is_missing(segments);
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i] != 0) is_missing[i % segments] = true;
  return is_missing;
}

}  // namespace

MeshFacts mesh_facts(Ranks& ranks, const WorkFolder& folder, const std::filesystem::path& mesh,
                     const GridRequest& request, const ReadOptions& reading) {
  if (ranks.rank() == 0 && !stored_facts(folder, reading.progress)) {
    const HeldMesh held(folder, mesh, reading);
    MeshFacts facts;
    facts.grid = grid_for(request.bounds ? Box3d::empty() : held.bounds(reading.progress), request);
    facts.vertices = held.get().vertices.size();
    facts.triangles = held.get().triangles.size();
    facts.triangles_per_segment = segment_triangles(*reading.memory);
    facts.segments =
        (facts.triangles + facts.triangles_per_segment - 1) / facts.triangles_per_segment;
    write_segments(folder, held, facts, std::vector<bool>(facts.segments, true), reading);
    WorkFileWriter file = folder.create(kFacts);
    file.write_value(facts);
    file.commit();
  }
  ranks.barrier();
  const std::optional<MeshFacts> facts = stored_facts(folder, reading.progress);
  if (!facts)
    throw Error(folder.file(kFacts).string(), "",
                "this rank cannot see the file that rank 0 wrote: all ranks need the same folder");
  return *facts;
}

std::vector<TriangleSegment> mesh_segments(Ranks& ranks, const WorkFolder& folder,
                                           const std::filesystem::path& mesh,
                                           const MeshFacts& facts, const ReadOptions& reading) {
  const std::vector<bool> is_missing =
      missing_segments(ranks, folder, facts.segments, reading.progress);
  if (std::find(is_missing.begin(), is_missing.end(), true) != is_missing.end()) {
    if (ranks.rank() == 0) {
      const HeldMesh held(folder, mesh, reading);
      write_segments(folder, held, facts, is_missing, reading);
    }
    ranks.barrier();
  }
  std::vector<TriangleSegment> segments;
  for (std::uint64_t s = 0; s < facts.segments; ++s) {
    std::optional<WorkFile> file =
        folder.open(segment_name(s), reading.progress, WorkFile::Check::kHeader);
    if (!file) throw Error(folder.file(segment_name(s)).string(), "", "the file is gone");
    segments.emplace_back(std::move(*file));
  }
  return segments;
}

}  // namespace voxdag
