#include "voxdag/builders/esvo/build/build_esvo.hpp"

#include "voxdag/builders/esvo/build/block_assembler.hpp"
#include "voxdag/builders/esvo/build/decide_cell.hpp"
#include "voxdag/builders/esvo/build/open_edges.hpp"
#include "voxdag/builders/esvo/build/subtree_builder.hpp"
#include "voxdag/builders/esvo/build/top_cells.hpp"
#include "voxdag/builders/pieces/duplicate_surfaces.hpp"
#include "voxdag/builders/pieces/load_pieces.hpp"
#include "voxdag/builders/pieces/memory_gate.hpp"
#include "voxdag/core/parallel/ordered_pipeline.hpp"
#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/core/parallel/thread_count.hpp"

namespace voxdag {
namespace {

/// Builds tasks. Several threads may build different tasks at the same time.
class TaskBuilder {
 public:
  TaskBuilder(const TriangleSource& source, const EsvoOptions& options,
              const SurfaceShading* shading, TopCells& cells, MemoryBudget* memory)
      : source_(source),
        options_(options),
        memory_(memory),
        appearance_(options.settings, shading),
        cells_(cells),
        gate_(memory),
        scratch_([this] { return CellScratch(options_.settings, appearance_, memory_); }) {}

  /// Builds a task and frees its triangles.
  FinishedTask build(std::size_t task) {
    FinishedTask finished;
    TopCell& cell = cells_[task];
    const MemoryGate::Pass pass(gate_, expected_bytes(cell));
    CellScratch& scratch = scratch_.local();
    load_pieces(scratch.pieces, appearance_.sampler(), source_, cell.level, cell.cell,
                cell.triangles);
    const StackedCell root = scratch.pieces.root();
    if (cell.is_displaced && cell.parent != TopCell::kNoParent && !root.is_empty()) {
      SurfaceSum sum;
      cell.decision = scratch.decider.decide(scratch.pieces.view(root),
                                             cells_[cell.parent].decision.is_near, cell.shape, sum);
    }
    cell.triangles = TriangleList(memory_);
    finished.cell = task;
    finished.voxel = SubtreeBuilder(options_.settings, appearance_, scratch.decider, scratch.pieces)
                         .build(cell.decision, cell.shape);
    scratch.pieces.finish();
    finished.voxel.count_tree(memory_);
    const EsvoTree& tree = finished.voxel.tree;
    finished.has_blocks = needs_blocks(tree);
    if (!finished.has_blocks) return finished;
    finished.block_memory = {memory_, packed_slots(tree) * kPackingBytesPerSlot};
    finished.blocks = pack_blocks(tree, cell.level, cell.cell, 0, options_.pack);
    finished.block_memory.resize(finished.blocks.slots.capacity() * sizeof(std::uint64_t));
    return finished;
  }

 private:
  /// Bytes of scratch memory and result for each packed slot.
  static constexpr std::uint64_t kPackingBytesPerSlot = 96;

  /// Returns the expected memory of a task, in bytes.
  std::uint64_t expected_bytes(const TopCell& cell) const {
    constexpr double kTreeBytesPerVoxel = 64;
    // Tessellation makes a few triangles per voxel.
    const double displaced = cell.is_displaced ? 4 * cell.weight : 0;
    return static_cast<std::uint64_t>((static_cast<double>(cell.triangles.size()) + displaced) *
                                          static_cast<double>(PieceStack::kBytesPerTriangle) +
                                      cell.weight * kTreeBytesPerVoxel);
  }

  const TriangleSource& source_;
  const EsvoOptions& options_;
  MemoryBudget* const memory_;
  const CellAppearance appearance_;
  TopCells& cells_;
  MemoryGate gate_;
  PerThread<CellScratch> scratch_;
};

}  // namespace

EsvoResult build_esvo(const Mesh& mesh, const Grid& grid, const EsvoOptions& options,
                      const SurfaceShading* shading, const DisplacedTriangles* displaced,
                      EsvoSink& sink, Work work) {
  MemoryBudget* const memory = work.memory;
  const std::uint64_t table_bytes =
      45 * std::uint64_t{mesh.triangles.size()} + 12 * std::uint64_t{mesh.vertices.size()};
  if (memory != nullptr && memory->left() < table_bytes)
    memory->throw_over_memory(memory->base() + memory->used() + table_bytes);
  const QuantizedMesh quantized(mesh, grid, work);
  const MemoryReservation tables(memory, 2 * quantized.triangle_count());
  const Appearance* const appearance = shading != nullptr     ? &shading->appearance()
                                       : displaced != nullptr ? &displaced->appearance()
                                                              : nullptr;
  const IndexSet duplicates = find_duplicate_surfaces(mesh, appearance, work);
  const std::vector<std::uint8_t> open_edges = find_open_edges(quantized, duplicates, work);
  const TriangleSource source{grid, quantized, open_edges, displaced, duplicates};
  TopCells cells = find_top_cells(source, options.settings, shading, work);
  const std::vector<std::size_t> tasks = task_order(cells);
  double total_weight = 0, weight_so_far = 0;
  for (const std::size_t task : tasks) total_weight += cells[task].weight;

  TaskBuilder builder(source, options, shading, cells, memory);
  BlockAssembler assembler(cells, options, sink, memory);
  ordered_pipeline(
      tasks.size(), 2 * thread_count(), work,
      [&](std::size_t i) { return builder.build(tasks[i]); },
      [&](FinishedTask& finished) {
        weight_so_far += cells[finished.cell].weight;
        assembler.add(finished);
        work.report(options.stage, weight_so_far / total_weight,
                    static_cast<std::uint64_t>(weight_so_far));
      });
  return assembler.finish();
}

Esvo build_esvo(const Mesh& mesh, const Grid& grid, const EsvoOptions& options,
                const SurfaceShading* shading, Work work) {
  EsvoMemory memory(work.memory);
  const EsvoResult result = build_esvo(mesh, grid, options, shading, nullptr, memory, work);
  return {memory.take(), result.root, grid.levels};
}

}  // namespace voxdag
