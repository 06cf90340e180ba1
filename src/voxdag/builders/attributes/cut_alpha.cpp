#include "voxdag/builders/attributes/cut_alpha.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "voxdag/algebra/combine.hpp"
#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/builders/attributes/filter_tasks.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"

namespace voxdag {
namespace {

/// Finds the voxels without visible surface in tasks, one at a time. Each thread has its own.
class MaskedVoxels {
 public:
  /// Refers to the arguments. The cells of `index` end at the voxels.
  MaskedVoxels(const SvdagView& dag, const CellIndexView& index, const TriangleSource& source,
               const SurfaceShading& shading, MemoryBudget* memory)
      : dag_(dag),
        index_(index),
        source_(source),
        shading_(shading),
        pieces_(dag, index, source, PieceSampler(&shading, false), memory) {}

  /// The bytes that find() needs for each cell in the subtree. The caller counts them.
  static constexpr std::uint64_t kBytesPerCell = sizeof(char) + sizeof(std::uint64_t);

  /// Returns the Morton codes of the voxels, in increasing order. Throws OverMemory.
  std::vector<std::uint64_t> find(const CellTask& task) {
    codes_.clear();
    if (std::none_of(task.triangles.begin(), task.triangles.end(), [this](std::uint32_t t) {
          return shading_.may_be_alpha_masked(source_.mesh.source(t));
        }))
      return {};
    is_seen_.assign(cells_in(dag_, index_, task.cell), 0);
    pieces_.for_each_finest_cell(task, [&](const NumberedCell& cell, const Cell& pieces) {
      char& is_seen = is_seen_[cell.number - task.cell.number];
      for (std::size_t i = 0; is_seen == 0 && i < pieces.pieces.size(); ++i)
        is_seen = is_visible(pieces, pieces.pieces[i]) ? 1 : 0;
    });
    collect(task.cell, task.cell.number, morton_encode(task.place));
    return codes_;
  }

 private:
  bool is_visible(const Cell& cell, const TrianglePiece& piece) const {
    return !shading_.may_be_alpha_masked(cell.triangle_of(piece).source) ||
           shading_.is_visible(cell.triangle_of(piece).source,
                               pieces_.sampler().corners(cell, piece));
  }

  void collect(const NumberedCell& cell, std::uint64_t first, std::uint64_t code) {
    if (cell.level == index_.finest_level) {
      if (is_seen_[cell.number - first] == 0) codes_.push_back(code);
      return;
    }
    for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      collect(child_of(dag_, index_, cell, child), first,
              code << 3 | static_cast<std::uint64_t>(child));
    }
  }

  const SvdagView& dag_;
  const CellIndexView& index_;
  const TriangleSource& source_;
  const SurfaceShading& shading_;
  TaskPieces pieces_;
  std::vector<char> is_seen_;  // by number - that of the task's cell
  std::vector<std::uint64_t> codes_;
};

}  // namespace

std::optional<Svdag> cut_alpha(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                               const SurfaceShading& shading, Work work) {
  bool may_be_masked = false;
  for (std::uint32_t t = 0; !may_be_masked && t < mesh.triangles.size(); ++t)
    may_be_masked = shading.may_be_alpha_masked(t);
  if (!may_be_masked || dag.is_empty()) return std::nullopt;
  const QuantizedMesh quantized(mesh, grid, work);
  const MemoryReservation tables(work.memory, quantized.triangle_count());
  const std::vector<std::uint8_t> no_open_edges(quantized.triangle_count());
  const IndexSet no_duplicates;
  const TriangleSource source{grid, quantized, no_open_edges, nullptr, no_duplicates};
  const CellIndex index = build_cell_index(dag, dag.levels, work.memory);
  const MemoryReservation index_bytes(work.memory, index.view().bytes());
  const CellIndexView cells = index.view();
  NumberedTopCells top_cells = list_top_cells(dag, cells, source, work);
  PerThread<MaskedVoxels> finders(
      [&] { return MaskedVoxels(dag, cells, source, shading, work.memory); });
  MortonBuilder masked(dag.levels, work.memory);
  bool is_masked = false;
  filter_tasks(
      dag, cells, top_cells, MaskedVoxels::kBytesPerCell, work, "alpha test",
      [&](const CellTask& task) { return finders.local().find(task); },
      [&](std::size_t, const std::vector<std::uint64_t>& codes) {
        for (const std::uint64_t code : codes) masked.add(code);
        is_masked |= !codes.empty();
      });
  if (!is_masked) return std::nullopt;
  const Svdag removed = masked.finish();
  const MemoryReservation removed_bytes(work.memory, removed.view().bytes());
  return combine(dag, removed.view(), SetOperation::kDifference, work);
}

}  // namespace voxdag
