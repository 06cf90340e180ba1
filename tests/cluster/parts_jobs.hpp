#pragma once
/// Scenes, and jobs that build them in parts.
#include <filesystem>
#include <optional>
#include <random>

#include "shared_folder.hpp"
#include "support/random_triangles.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/cluster/parts_job.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {

inline constexpr const char* kProgram = "a test";

struct Scene {
  const char* name;
  Mesh mesh;
  GridRequest grid;
};

inline GridRequest levels(int levels) { return {.resolution = std::int64_t{1} << levels}; }

/// Returns `count` triangles with random corners.
inline Mesh random_mesh(int count) {
  std::mt19937_64 random(7);
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const QuantizedTriangle t = random_triangle(random, 7);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back(static_cast<Vec3f>(t[corner]));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Writes the file of a plain build.
inline void build_plainly(const std::filesystem::path& mesh_file, const GridRequest& request,
                          const std::filesystem::path& output) {
  const Mesh mesh = read_mesh(mesh_file);
  VdagMetadata metadata;
  metadata.grid = grid_for(mesh, request);
  metadata.source = {mesh_file.filename().string(), mesh.vertices.size(), mesh.triangles.size()};
  metadata.program = kProgram;
  metadata.build = settings_of(request);
  const Svdag dag = build_svdag(mesh, metadata.grid).dag;
  metadata.counts = count_svdag(dag.view());
  write_vdag(output, dag.view(), metadata);
}

inline PartsJob job_of(const SharedFolder& folder, const Scene& scene, std::uint64_t parts) {
  return {folder / "scene.ply", folder / "work", folder / "parts.vdag", scene.grid, parts, {}};
}

}  // namespace voxdag
