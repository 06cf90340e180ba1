#pragma once
/// Finds the materials of the cells of one subtree of a DAG.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/builders/attributes/cell_task.hpp"

namespace voxdag {

/// The area of the surface of one material in a cell, in voxels². A triangle that only touches the
/// cell counts as a very small area, so that every cell has a material.
struct MaterialArea {
  std::uint32_t id = 0;
  double area = 0;
};
using MaterialAreas = std::vector<MaterialArea>;  ///< In increasing order of the ids.

/// Areas that differ by less than this part of the largest one count as equal, so that rounding
/// decides nothing.
inline constexpr double kEqualAreas = 0x1p-16;

/// Returns the id with the largest area, or the smallest id of those whose areas count as equal to
/// it. `areas` must not be empty.
std::uint32_t largest_material(std::span<const MaterialArea> areas);

/// Adds the areas `from` to `to`.
void add_areas(MaterialAreas& to, const MaterialAreas& from);

/// A run of cells with consecutive numbers and one material.
struct CellRun {
  std::uint32_t id = 0;
  std::uint32_t length = 0;
};

/// Filters tasks, one at a time. Each thread has its own. Ignores transparency, as the shape does.
class MaterialFilter {
 public:
  /// Refers to the arguments. `materials` has the material of each triangle of the mesh. Counts the
  /// pieces of triangles and their areas in `memory`.
  MaterialFilter(const SvdagView& dag, const CellIndexView& index, const TriangleSource& source,
                 std::span<const std::uint32_t> materials, MemoryBudget* memory);

  /// The bytes that filter() needs for each cell in the subtree. The caller counts them.
  static constexpr std::uint64_t kBytesPerCell = sizeof(std::uint16_t) + sizeof(CellRun);

  /// Returns the areas in the task's cell. Sets `runs` to the materials of all cells in its
  /// subtree, in the order of their numbers. Throws OverMemory.
  MaterialAreas filter(const CellTask& task, std::vector<CellRun>& runs);

 private:
  /// The area of a material in a cell of the finest level, of number first_ + cell.
  struct Entry {
    std::uint32_t cell = 0, id = 0;
    double area = 0;
  };
  void add_entries(std::uint32_t cell, const Cell& pieces);
  void join(const NumberedCell& cell);

  const SvdagView& dag_;
  const CellIndexView& index_;
  std::span<const std::uint32_t> materials_;
  TaskPieces pieces_;
  std::uint64_t first_ = 0;         // number of the task's cell
  CountedVector<Entry> entries_;    // by cell and id
  std::size_t next_ = 0;            // the first entry that join() has not read
  MaterialAreas stack_;             // areas in the cells on the path of join()
  std::vector<std::uint16_t> ids_;  // of all cells in the task, by number - first_
};

}  // namespace voxdag
