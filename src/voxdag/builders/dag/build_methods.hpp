#pragma once
/// The two builders behind build_svdag(), and their common types.
#include <cstdint>
#include <memory>
#include <vector>

#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/dag/sort_tree.hpp"
#include "voxdag/builders/dag/subvolume_bins.hpp"
#include "voxdag/builders/voxelize/cell_range.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// The input of a builder. Owns nothing.
struct BuildInput {
  const Mesh& mesh;
  Grid grid;
  BuildMethod method;
  int bin_level;  ///< The sub-volumes are the cells of this level.
  Work work;      ///< Has a budget, as every Work in this header.
};

/// Bytes that the stages of a build hold, without the mesh. Those marked * grow with the
/// resolution.
struct StageBytes {
  double prepare = 0;         ///< Quantized mesh and binning.
  double voxelize_fixed = 0;  ///< Quantized mesh, lists and the threads' scratch memory.
  double voxelize = 0;        ///< * Nodes of all sub-volumes, and their builders.
  double merge = 0;           ///< * By sorting: the final reduction.
  double number = 0;          ///< * Numbering in canonical order.
};

/// The triangles of a mesh on the grid, and for each sub-volume the list of triangles that meet it.
struct BinnedMesh {
  QuantizedMesh mesh;
  SubvolumeBins bins;
  double prepare_bytes;  ///< Most bytes held while this was built.
};

/// Quantises and bins the mesh; leaves out exact duplicates of triangles. Throws OverMemory and
/// Cancelled.
BinnedMesh bin_mesh(const BuildInput& input);

/// Returns the bytes of setups and lists that a thread needs for the sub-volume with the longest
/// list.
double list_scratch_bytes(const SubvolumeBins& bins);

/// The unique nodes of all sub-volumes and of the levels above them. `root` is kNoNode if there are
/// no voxels.
struct HashConsedNodes {
  std::vector<std::unique_ptr<NodeStore>> stores;  ///< Per level.
  NodeId root;
};
/// Returns the level whose cells are the sub-volumes of kHashConsed.
int hash_bin_level(int levels, std::size_t triangles);
/// Builds the unique nodes. Adds to `report` and `bytes`. Throws OverMemory and Cancelled.
HashConsedNodes voxelize_hash_consed(const BuildInput& input, BuildReport& report,
                                     StageBytes& bytes);
/// Builds the unique nodes of the sub-volumes that `binned` lists, in a grid of 2^levels voxels a
/// side. Adds to `report` and `bytes`. Throws OverMemory and Cancelled.
HashConsedNodes voxelize_binned(const BinnedMesh& binned, int levels, Work work,
                                BuildReport& report, StageBytes& bytes);
/// Converts the nodes to the canonical DAG of 2^levels voxels a side. Throws Error, OverMemory and
/// Cancelled.
Svdag number_nodes(HashConsedNodes nodes, int levels, Work work, BuildReport& report);

/// Returns the minimal DAG, in canonical order, of those voxels that lie in `range` and meet a
/// triangle. It is a DAG of the whole grid of 2^levels voxels a side, without voxels elsewhere.
/// `range` is of level `levels` - 2 or coarser. `triangles` are used up. `work` counts the memory
/// of the build, and not the result. Runs on the current TBB arena. Throws OverMemory, Error if the
/// DAG outgrows 32-bit pointers, and Cancelled.
Svdag build_range(CountedVector<QuantizedTriangle> triangles, int levels, const CellRange& range,
                  Work work = {});

/// Returns the level whose cells are the sub-volumes of kSort and kPaper.
int sort_bin_level(int levels);
/// Returns the reduced trees of all sub-volumes below a top tree; level 0 is empty if there are no
/// voxels. Adds to `report` and `bytes`. Throws OverMemory and Cancelled.
SortTree voxelize_by_sorting(const BuildInput& input, BuildReport& report, StageBytes& bytes);
/// Reduces the tree once more and converts it to the canonical DAG. Throws Error, OverMemory and
/// Cancelled.
Svdag merge_and_number(SortTree tree, const BuildInput& input, BuildReport& report);

}  // namespace voxdag
