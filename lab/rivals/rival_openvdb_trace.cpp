/// OpenVDB's hierarchical DDA, for comparison with `voxdag bench trace`: makes a mask grid with the
/// voxels of a .vdag file, and finds the first active voxel of each ray. trace_program.hpp says how
/// to call it.
#include <openvdb/math/DDA.h>
#include <openvdb/math/Ray.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "lab/rivals/openvdb_mask.hpp"
#include "lab/rivals/trace_program.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

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

VdbRay to_index_space(const voxdag::Grid& grid, const voxdag::Ray& ray) {
  const auto [eye, way] = voxdag::lab::to_voxels(grid, ray);
  return {{eye.x, eye.y, eye.z}, {way.x, way.y, way.z}, double{ray.t_min}, double{ray.t_max}};
}

bool clip_to(const openvdb::math::CoordBBox& box, VdbRay& ray) {
  const openvdb::Vec3d lo = box.min().asVec3d(), hi = box.max().offsetBy(1).asVec3d();
  return ray.clip(openvdb::math::BBox<openvdb::Vec3d>(lo, hi));
}

double cast_all(const openvdb::MaskGrid& mask, const voxdag::Grid& grid,
                std::span<const voxdag::Ray> rays, std::span<char> hits) {
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

voxdag::lab::TraceProgram make_program(const voxdag::VdagFile& file, int threads) {
  openvdb::initialize();
  const auto limit = std::make_shared<tbb::global_control>(
      tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  const openvdb::MaskGrid::Ptr mask = voxdag::lab::openvdb_mask_of(file.view());
  return {
      [limit, grid = file.grid(), mask](std::span<const voxdag::Ray> rays, std::span<char> hits) {
        return cast_all(*mask, grid, rays, hits);
      },
      mask->memUsage()};
}

}  // namespace

int main(int argc, char** argv) {
  return voxdag::lab::run_trace_program(argc, argv, "rival_openvdb_trace", make_program);
}
