#pragma once
/// Builds one cell of the octree, depth first, from the triangles that meet it.
#include <cstdint>
#include <span>
#include <utility>

#include "voxdag/builders/dag/dag_sink.hpp"
#include "voxdag/builders/dag/sort_tree.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/builders/voxelize/triangle_setup.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// A cell of 2^log2_size voxels a side (at least 4) and the indices of the triangles that may meet
/// it.
struct SubvolumeJob {
  Vec3i origin;  ///< First voxel.
  int log2_size;
  std::span<const std::uint32_t> triangles;
};

/// The sink and the scratch memory of one thread, reused from job to job.
template <class Sink>
struct SubvolumeContext {
  struct Item {
    std::uint32_t triangle;    ///< Index in `setups`.
    std::uint32_t conditions;  ///< The conditions that can fail in the current cell.
  };
  struct Classified {
    std::uint32_t triangle, conditions;
    std::uint64_t met;  ///< Grandchildren that the triangle meets, in Morton order.
  };

  /// Refers to `mesh_in`. Throws OverMemory.
  SubvolumeContext(const QuantizedMesh& mesh_in, int levels_in, Sink sink_in, Work work_in)
      : mesh(&mesh_in),
        work(work_in),
        levels(levels_in),
        stack(work_in.memory, kStackBytes),
        sink(std::move(sink_in)),
        setups(work_in.memory),
        items(work_in.memory),
        classified(work_in.memory),
        triangles(work_in.memory) {}

  /// The most stack that the recursion touches in a thread, with the memory that malloc keeps for
  /// the thread.
  static constexpr std::uint64_t kStackBytes = std::uint64_t{256} << 10;

  const QuantizedMesh* mesh;
  Work work;
  int levels;
  MemoryReservation stack;
  Sink sink;
  PageVector<TriangleSetup> setups;
  // Stacks of lists.
  PageVector<Item> items;
  PageVector<Classified> classified;
  PageVector<std::uint32_t> triangles;  ///< Indices into the mesh.
};

/// Returns the id of the cell's node (of level L - log2_size), or kNoNode if the cell is empty.
/// Throws OverMemory and Cancelled. The context can then run other jobs, but the sink's contents
/// are incomplete.
NodeId build_subvolume(SubvolumeContext<DagSink>& context, const SubvolumeJob& job);
NodeId build_subvolume(SubvolumeContext<TreeSink>& context, const SubvolumeJob& job);

}  // namespace voxdag
