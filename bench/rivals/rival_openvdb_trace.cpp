/// OpenVDB's hierarchical DDA, for comparison with `voxdag bench trace`: makes a mask grid with the
/// voxels of a .vdag file, and finds the first active voxel of each ray.
///
///   rival_openvdb_trace FILE.vdag THREADS REPEAT RAYS.npy...
///
/// RAYS.npy is a float32 array of shape (N, 8), as for `voxdag trace`. Writes RAYS.npy.hits, one
/// byte for each ray, and prints {"seconds": [...]}: the fastest of REPEAT casts of each file.
#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "voxdag/file/npy.hpp"
#include "voxdag/file/vdag_file.hpp"
#include "voxdag/layout/for_each_voxel.hpp"
#include "voxdag/parallel/parallel_for.hpp"
#include "voxdag/trace/ray.hpp"

namespace {

using MaskTree = openvdb::MaskTree;
using VdbRay = openvdb::math::Ray<double>;

/// The tester of LevelSetHDDA for occupancy: the walk ends at the first active voxel.
class FirstActiveVoxel {
 public:
  using RayT = VdbRay;

  FirstActiveVoxel(const openvdb::MaskGrid::ConstAccessor& accessor, const VdbRay& ray)
      : accessor_(accessor), ray_(ray) {}

  const VdbRay& ray() const { return ray_; }
  // NOLINTBEGIN(readability-identifier-naming): OpenVDB's names
  template <class Node>
  bool hasNode(const openvdb::Coord& at) {
    return accessor_.template probeConstNode<Node>(at) != nullptr;
  }
  void setRange(double t0, double t1) { ray_.setTimes(t0, t1); }
  // NOLINTEND(readability-identifier-naming)
  void init(double) {}
  bool operator()(const openvdb::Coord& at, double) { return accessor_.isValueOn(at); }

 private:
  openvdb::MaskGrid::ConstAccessor accessor_;
  VdbRay ray_;
};

/// Makes a mask grid of the DAG's voxels; Coord allows up to 2^30 voxels a side.
openvdb::MaskGrid::Ptr mask_of(const voxdag::SvdagView& dag) {
  auto grid = openvdb::MaskGrid::create();
  auto accessor = grid->getAccessor();
  const std::int32_t side = 1 << dag.levels;
  voxdag::for_each_voxel(dag, {{0, 0, 0}, {side, side, side}}, [&](voxdag::Vec3i v) {
    accessor.setValueOn({v.x, v.y, v.z});
  });
  return grid;
}

/// Returns the ray in units of voxels. Voxel (i,j,k) is the cube with its lower corner at (i,j,k),
/// as in voxdag.
VdbRay to_index_space(const voxdag::Grid& grid, const voxdag::Ray& ray) {
  const voxdag::Vec3d eye = grid.to_grid(static_cast<voxdag::Vec3d>(ray.origin));
  const voxdag::Vec3d way = static_cast<voxdag::Vec3d>(ray.direction) * (1 / grid.voxel_size);
  return {{eye.x, eye.y, eye.z}, {way.x, way.y, way.z}, double{ray.t_min}, double{ray.t_max}};
}

bool clip_to(const openvdb::math::CoordBBox& box, VdbRay& ray) {
  const openvdb::Vec3d lo = box.min().asVec3d(), hi = box.max().offsetBy(1).asVec3d();
  return ray.clip(openvdb::math::BBox<openvdb::Vec3d>(lo, hi));
}

std::vector<voxdag::Ray> read_rays(const char* path) {
  voxdag::NpyReader reader(path, "<f4", {8}, sizeof(float));
  std::vector<voxdag::Ray> rays(reader.rows());
  reader.read_rows(rays.data(), rays.size());
  return rays;
}

double cast_all(const openvdb::MaskGrid& mask, const voxdag::Grid& grid,
                const std::vector<voxdag::Ray>& rays, std::vector<char>& hits) {
  constexpr std::size_t kBlock = 2048;
  constexpr int kTopLevel = MaskTree::RootNodeType::ChildNodeType::LEVEL;
  const openvdb::math::CoordBBox box = mask.evalActiveVoxelBoundingBox();
  const auto start = std::chrono::steady_clock::now();
  voxdag::parallel_for((rays.size() + kBlock - 1) / kBlock, [&](std::size_t block) {
    const openvdb::MaskGrid::ConstAccessor accessor = mask.getConstAccessor();
    for (std::size_t i = block * kBlock; i < std::min((block + 1) * kBlock, rays.size()); ++i) {
      VdbRay ray = to_index_space(grid, rays[i]);
      hits[i] = 0;
      if (!clip_to(box, ray)) continue;
      FirstActiveVoxel first(accessor, ray);
      hits[i] = openvdb::math::LevelSetHDDA<MaskTree, kTopLevel>::test(first) ? 1 : 0;
    }
  });
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void trace(int argc, char** argv) {
  const tbb::global_control threads(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(std::max(std::atoi(argv[2]), 1)));
  const int repeat = std::max(std::atoi(argv[3]), 1);
  openvdb::initialize();
  const voxdag::VdagFile file(argv[1]);
  const openvdb::MaskGrid::Ptr mask = mask_of(file.view());
  std::string seconds;
  for (int i = 4; i < argc; ++i) {
    const std::vector<voxdag::Ray> rays = read_rays(argv[i]);
    std::vector<char> hits(rays.size());
    double best = HUGE_VAL;
    for (int turn = 0; turn <= repeat; ++turn) {  // the first turn warms up
      const double took = cast_all(*mask, file.grid(), rays, hits);
      if (turn > 0) best = std::min(best, took);
    }
    std::ofstream out(std::string(argv[i]) + ".hits", std::ios::binary);
    out.write(hits.data(), static_cast<std::streamsize>(hits.size()));
    seconds += (seconds.empty() ? "" : ", ") + std::to_string(best);
  }
  std::printf("{\"seconds\": [%s]}\n", seconds.c_str());
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 5) {
    std::fputs("usage: rival_openvdb_trace FILE.vdag THREADS REPEAT RAYS.npy...\n", stderr);
    return 2;
  }
  trace(argc, argv);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "rival_openvdb_trace: %s\n", error.what());
  return 1;
}
