// Carves a ball and a tunnel into a DAG, takes the tunnel back, and writes the result.
#include <cstdio>

#include "voxdag/edit/editable_dag.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/file/vdag_writer.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

int main(int argc, char** argv) try {
  if (argc != 3) return std::fprintf(stderr, "usage: %s IN.vdag OUT.vdag\n", argv[0]), 2;
  const voxdag::VdagFile file(argv[1]);
  const voxdag::Grid& grid = file.grid();
  const voxdag::Vec3d corner = grid.origin,
                      middle = grid.origin + (grid.bounds().hi - corner) * 0.5;

  voxdag::EditableDag dag(file.view());
  dag.remove(voxdag::make_ball(grid, middle, grid.side() / 4));
  const voxdag::EditSnapshot carved = dag.snapshot();  // stays as it is
  dag.remove(voxdag::make_capsule(grid, corner, middle, grid.side() / 16));
  dag.undo();

  const voxdag::Svdag result = dag.snapshot().svdag();  // the bytes depend on the voxels alone
  voxdag::VdagMetadata about = file.metadata();
  about.attributes = {};
  about.counts = voxdag::count_svdag(result.view());
  voxdag::write_vdag(argv[2], result.view(), about);
  std::printf("%llu of %llu voxels are left; undo gave the snapshot: %s\n",
              static_cast<unsigned long long>(about.counts.voxels),
              static_cast<unsigned long long>(file.metadata().counts.voxels),
              result == carved.svdag() ? "yes" : "no");
} catch (const voxdag::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
