// Hostile voxel files, camera paths, and names of files outside the input's folder.
#include <fstream>

#include "lab/untrusted/untrusted_case.hpp"
#include "voxdag/file/vdag_writer.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

/// Writes the DAG of a full grid of 2^20 voxels a side: 2^60 voxels in about 2 KB.
void write_full_dag(const fs::path& folder) {
  constexpr int kLevels = 20;
  Svdag dag;
  dag.levels = kLevels;
  for (int level = 0; level < kLevels - 2; ++level) {
    dag.level_begin[static_cast<std::size_t>(level)] = dag.nodes.size();
    const bool is_last = level == kLevels - 3;
    dag.nodes.push_back(0xFF);
    const auto child = is_last ? 0u : static_cast<std::uint32_t>(dag.nodes.size()) + 8;
    dag.nodes.insert(dag.nodes.end(), 8, child);
  }
  for (std::size_t i = kLevels - 2; i < dag.level_begin.size(); ++i)
    dag.level_begin[i] = dag.nodes.size();
  dag.leaf_blocks = {~std::uint64_t{0}};
  VdagMetadata metadata;
  metadata.grid.levels = kLevels;
  metadata.counts = count_svdag(dag.view());
  write_vdag(folder / "full.vdag", dag.view(), metadata);
}

void write_triangle(const fs::path& path, const std::string& first_line) {
  std::ofstream(path) << first_line << "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
}

void write_outside_mtl(const fs::path& folder) {
  write_triangle(folder / "outside.obj", "mtllib ../../../../../../etc/passwd\n");
}

void write_outside_buffer(const fs::path& folder) {
  std::ofstream(folder / "outside.gltf")
      << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
         R"("buffers":[{"uri":"%2e%2e/%2e%2e/%2e%2e/etc/passwd","byteLength":36}],)"
         R"("bufferViews":[{"buffer":0,"byteLength":36}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}]})";
}

}  // namespace

std::vector<UntrustedCase> untrusted_file_cases() {
  return {
      {"2^60 voxels, as an array",
       write_full_dag,
       {},
       {"export", "full.vdag", "-o", "x.npy"},
       0,
       1},
      {"2^60 voxels, as points", write_full_dag, {}, {"export", "full.vdag", "-o", "x.ply"}, 0, 1},
      {"an endless camera path",
       write_full_dag,
       {},
       {"render", "full.vdag", "--path", "/dev/zero", "-o", "x_%04d.png"},
       0,
       1},
      {"OBJ names /etc/passwd",
       write_outside_mtl,
       {},
       {"build", "outside.obj", "-r", "64", "-o", "x.esvo"},
       0,
       1},
      {"glTF names /etc/passwd",
       write_outside_buffer,
       {},
       {"build", "outside.gltf", "-r", "64", "-o", "x.vdag"},
       0,
       1},
  };
}

}  // namespace voxdag::lab
