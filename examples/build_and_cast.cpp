// Builds the DAG of a mesh, writes it, opens the file again and casts a ray at it.
#include <cstdio>
#include <limits>

#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

int main(int argc, char** argv) try {
  if (argc != 3) return std::fprintf(stderr, "usage: %s MESH OUT.vdag\n", argv[0]), 2;
  const voxdag::Mesh mesh = voxdag::read_mesh(argv[1]);
  voxdag::VdagMetadata about;
  about.grid = voxdag::fit_grid(mesh, 10);  // 2^10 = 1024 voxels a side
  const voxdag::BuildResult built = voxdag::build_svdag(mesh, about.grid);
  about.counts = voxdag::count_svdag(built.dag.view());
  voxdag::write_vdag(argv[2], built.dag.view(), about);

  const voxdag::VdagFile file(argv[2]);  // read and checked
  const voxdag::Vec3d centre = file.grid().to_world({512, 512, 512});
  voxdag::Ray ray;
  ray.origin = static_cast<voxdag::Vec3f>(centre);
  ray.direction = {0, -1, 0};
  ray.t_max = std::numeric_limits<float>::infinity();
  const voxdag::Hit hit = voxdag::closest_hit(voxdag::SvdagNodes(file.view()), file.grid(), ray);
  std::printf("%llu voxels in %llu bytes\n", static_cast<unsigned long long>(about.counts.voxels),
              static_cast<unsigned long long>(file.view().bytes()));
  if (hit.hit)
    std::printf("voxel %d %d %d at t = %g\n", hit.voxel.x, hit.voxel.y, hit.voxel.z, hit.t);
} catch (const voxdag::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
