#pragma once
/// Builds an efficient sparse voxel octree from a triangle mesh.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.
///
/// The upper levels are built breadth first, down to the tasks: cells whose surface has at most
/// about 65,000 voxels. Tasks are built in parallel and finish in Morton order. A large result
/// becomes blocks at once. A small one joins the tree of the parent cell, which becomes blocks when
/// it is large enough. So memory holds the mesh, the upper levels and the results of a few tasks,
/// however large the octree is.
#include <algorithm>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "voxdag/builders/esvo/build/esvo_settings.hpp"
#include "voxdag/builders/esvo/encode/pack_blocks.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/displace/displaced_triangles.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"

namespace voxdag {

struct EsvoOptions {
  EsvoSettings settings;
  PackOptions pack;
  std::string_view stage = "octree";  ///< The name of the work for Progress.
};

/// Receives finished blocks, one at a time, in order.
class EsvoSink {
 public:
  virtual ~EsvoSink() = default;
  /// Appends whole blocks; `slots` is valid during the call only.
  virtual void append(std::span<const std::uint64_t> slots) = 0;
};

/// A sink that keeps the blocks in memory.
class EsvoMemory : public EsvoSink {
 public:
  /// Counts the blocks in `budget`.
  explicit EsvoMemory(MemoryBudget* budget = nullptr) : memory_(budget, 0) {}

  void append(std::span<const std::uint64_t> slots) override {
    if (slots_.size() + slots.size() > slots_.capacity()) {
      // The old and the new array exist at the same time.
      const std::size_t capacity = std::max(2 * slots_.capacity(), slots_.size() + slots.size());
      memory_.resize((slots_.capacity() + capacity) * sizeof(std::uint64_t));
      slots_.reserve(capacity);
      memory_.resize(capacity * sizeof(std::uint64_t));
    }
    slots_.insert(slots_.end(), slots.begin(), slots.end());
  }
  /// Returns the blocks and stops counting them.
  std::vector<std::uint64_t> take() {
    memory_.resize(0);
    return std::move(slots_);
  }

 private:
  MemoryReservation memory_;
  std::vector<std::uint64_t> slots_;
};

struct EsvoResult {
  std::uint64_t root = 0;                 ///< Slot of the root's descriptor.
  std::vector<EsvoBlockEntry> directory;  ///< In the order of the blocks.
  EsvoCounts counts;
};

/// Builds the octree of the mesh's surface in `grid`. `shading` is the shading of this mesh, or
/// null for a grey surface. `displaced` displaces the surface, or is null. A mesh without visible
/// surface in the grid gives no blocks. The blocks depend on the arguments alone, not on the number
/// of threads, the memory limit or the machine. Runs on the current TBB arena. With a memory limit
/// fewer tasks are built at a time. Throws OverMemory before the work if even the tables of the
/// triangles do not fit (45 bytes a triangle and 12 a vertex), or during it. Throws Error if the
/// octree is too large for far pointers (16 GiB), Cancelled, and whatever the sink throws.
EsvoResult build_esvo(const Mesh& mesh, const Grid& grid, const EsvoOptions& options,
                      const SurfaceShading* shading, const DisplacedTriangles* displaced,
                      EsvoSink& sink, Work work = {});

/// Builds an octree in memory, without displacement.
Esvo build_esvo(const Mesh& mesh, const Grid& grid, const EsvoOptions& options = {},
                const SurfaceShading* shading = nullptr, Work work = {});

}  // namespace voxdag
