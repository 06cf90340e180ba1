#pragma once
/// From a triangle mesh to an efficient sparse voxel octree.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.
///
/// The upper levels are decided breadth first, until a cell has about kTaskWeight voxels of surface
/// or less: a task. Tasks run in parallel and end in Morton order; what a task makes becomes blocks
/// at once, or, where it is little, part of the tree of the cell above, which becomes blocks when
/// it is large enough. So memory holds the mesh, the upper levels and what a few tasks make,
/// however large the octree is.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/displace/displaced_triangles.hpp"
#include "voxdag/esvo/build/cell_builder.hpp"
#include "voxdag/esvo/encode/pack_blocks.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct EsvoOptions {
  EsvoSettings settings;
  PackOptions pack;
};

/// Where blocks go as they are finished, one after the other.
class EsvoSink {
 public:
  virtual ~EsvoSink() = default;
  virtual void append(std::span<const std::uint64_t> slots) = 0;
};

/// Keeps them in memory.
class EsvoMemory : public EsvoSink {
 public:
  void append(std::span<const std::uint64_t> slots) override {
    slots_.insert(slots_.end(), slots.begin(), slots.end());
  }
  std::vector<std::uint64_t> take() { return std::move(slots_); }

 private:
  std::vector<std::uint64_t> slots_;
};

struct EsvoResult {
  std::uint64_t root = 0;                 ///< Slot of the root's descriptor.
  std::vector<EsvoBlockEntry> directory;  ///< In the order of the blocks.
  EsvoCounts counts;
};

/// Builds the octree of the mesh's surface in `grid`. `shading` is that of the mesh, or null;
/// `displaced` moves its surface, if it is not null.
/// An octree without voxels (a mesh outside of the grid, or cut away wholly) has no blocks. The
/// blocks depend on the arguments alone: not on threads or machine. Runs on the current TBB arena.
/// Throws Error if far pointers do not reach (16 GiB), Cancelled, and what the sink throws.
EsvoResult build_esvo(const Mesh& mesh, const Grid& grid, const EsvoOptions& options,
                      const SurfaceShading* shading, const DisplacedTriangles* displaced,
                      EsvoSink& sink, Progress* progress = nullptr);

/// The same, in memory.
Esvo build_esvo(const Mesh& mesh, const Grid& grid, const EsvoOptions& options = {},
                const SurfaceShading* shading = nullptr, Progress* progress = nullptr);

}  // namespace voxdag
