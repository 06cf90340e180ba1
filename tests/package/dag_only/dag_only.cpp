// Builds the DAG of a cube in a grid of 16³ voxels and prints the number of voxels of its surface.
#include <cstdio>

#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

int main() {
  voxdag::Mesh cube;
  for (int i = 0; i < 8; ++i)
    cube.vertices.push_back({static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1),
                             static_cast<float>(i >> 2 & 1)});
  cube.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
  const voxdag::BuildResult built = voxdag::build_svdag(cube, voxdag::fit_grid(cube, 4));
  std::printf("%llu voxels\n",
              static_cast<unsigned long long>(voxdag::count_svdag(built.dag.view()).voxels));
}
