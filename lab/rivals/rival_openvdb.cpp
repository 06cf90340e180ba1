/// OpenVDB's mesh-to-volume conversion, for comparison with `voxdag build`. Uses voxdag's mesh
/// reader and grid. Computes an unsigned distance field and saves it as .vdb. Its band is the
/// narrowest that holds every voxel that the surface meets (centres within half a voxel's
/// diagonal). Differences from voxdag: the distance to its centre decides a voxel, each voxel
/// stores a float, and the tree shares no nodes.
///
///   rival_openvdb MESH RESOLUTION FILE.vdb
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>

#include <bit>
#include <cstdio>
#include <cstdlib>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace {

/// Half of a voxel's diagonal, rounded up.
constexpr float kBandVoxels = 0.87F;

/// The interface that OpenVDB requires of a mesh.
struct MeshInGrid {
  const voxdag::Mesh& mesh;
  const voxdag::Grid& grid;

  // NOLINTBEGIN(readability-identifier-naming): OpenVDB's names
  std::size_t polygonCount() const { return mesh.triangles.size(); }
  std::size_t pointCount() const { return mesh.vertices.size(); }
  std::size_t vertexCount(std::size_t) const { return 3; }
  void getIndexSpacePoint(std::size_t triangle, std::size_t corner,
                          openvdb::Vec3d& position) const {
    const voxdag::Vec3d p = grid.to_grid(mesh.position(mesh.triangles[triangle][corner]));
    // OpenVDB's voxels have their centres at whole numbers, ours have their lower corners there.
    position = {p.x - 0.5, p.y - 0.5, p.z - 0.5};
  }
  // NOLINTEND(readability-identifier-naming)
};

void convert(const char* mesh_file, unsigned resolution, const char* output) {
  openvdb::initialize();
  const voxdag::Mesh mesh = voxdag::read_mesh(mesh_file);
  const voxdag::Grid grid = voxdag::fit_grid(mesh, std::countr_zero(resolution));
  const auto transform = openvdb::math::Transform::createLinearTransform(grid.voxel_size);
  const auto volume = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      MeshInGrid{mesh, grid}, *transform, kBandVoxels, kBandVoxels,
      openvdb::tools::UNSIGNED_DISTANCE_FIELD);
  openvdb::io::File(output).write({volume});
  std::printf("{\"voxels\": %llu, \"memory_bytes\": %llu}\n",
              static_cast<unsigned long long>(volume->activeVoxelCount()),
              static_cast<unsigned long long>(volume->memUsage()));
}

}  // namespace

int main(int argc, char** argv) try {
  const unsigned resolution = argc == 4 ? static_cast<unsigned>(std::atoi(argv[2])) : 0;
  if (!std::has_single_bit(resolution)) {
    std::fputs("usage: rival_openvdb MESH RESOLUTION FILE.vdb\n", stderr);
    return 2;
  }
  convert(argv[1], resolution, argv[3]);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "rival_openvdb: %s\n", error.what());
  return 1;
}
