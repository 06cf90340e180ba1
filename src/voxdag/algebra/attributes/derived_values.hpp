#pragma once
/// The parts of derive_attributes() that do not depend on the source.
#include <cstdint>
#include <optional>
#include <vector>

#include "voxdag/algebra/attributes/stored_reader.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/attributes/coarsen_attributes.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"
#include "voxdag/stored/attributes/numbered_cell.hpp"

namespace voxdag {

/// Cells of the result whose values are those of stored attributes, in the same order.
struct StoredRun {
  std::size_t stored = 0;   ///< Which attributes of the source.
  std::uint64_t first = 0;  ///< The number there of the first cell.
};

namespace detail {

/// The most cells that a thread derives in one step.
inline constexpr std::uint64_t kStepCells = std::uint64_t{1} << 16;

/// Equal materials of consecutive cells.
struct MaterialCells {
  std::uint32_t id = 0, count = 0;
};

/// The values of cells with consecutive numbers, by kind.
struct ValueList {
  std::vector<Value8> colors, normals;
  std::vector<std::uint16_t> materials;
  std::size_t cells = 0;

  void reserve(const ValueKinds& kinds, std::size_t count) {
    if (kinds.colors) colors.reserve(count);
    if (kinds.normals) normals.reserve(count);
    if (kinds.materials != 0) materials.reserve(count);
  }
  void push(const ValueKinds& kinds, const CellValues& values) {
    ++cells;
    if (kinds.colors) colors.push_back(values.color);
    if (kinds.normals) normals.push_back(values.normal);
    if (kinds.materials != 0) materials.push_back(values.material);
  }
  void set(std::size_t place, const CellValues& values) {
    if (!colors.empty()) colors[place] = values.color;
    if (!normals.empty()) normals[place] = values.normal;
    if (!materials.empty()) materials[place] = values.material;
  }
};

/// Counts the cells of the finest level below cells of a DAG.
class FinestCells {
 public:
  FinestCells(const SvdagView& dag, const CellIndexView& index, MemoryBudget* memory);

  std::uint64_t below(const NumberedCell& cell) const {
    if (cell.level == index_.finest_level) return 1;
    return cells_in(dag_, index_, cell) - cells_in(dag_, above_.view(), cell);
  }

 private:
  SvdagView dag_;
  CellIndexView index_;
  CellIndex above_;  ///< Numbers the cells above the finest level.
  MemoryReservation bytes_;
};

/// Returns the number of voxels in a cell of a DAG.
std::uint64_t voxels_in(const SvdagView& dag, const NumberedCell& cell);

/// A cell near the root: alone, or with its subtree.
struct TopCell {
  NumberedCell cell;
  Vec3i place{};            ///< In cells of its level.
  std::uint64_t cells = 1;  ///< Cells that it stands for. More than 1: its subtree.
  bool is_inner = false;    ///< Stands for itself alone; its children follow in the list.
  std::optional<StoredRun> run;
  CellValues values;  ///< Of the cell itself.
  std::uint64_t first_materials = 0, end_materials = 0;
};

/// Collects the values of all cells of a DAG, and encodes them.
class DerivedValues {
 public:
  DerivedValues(const SvdagView& dag, int finest_level, const ValueKinds& kinds,
                const CoarsenBounds& bounds, Work work);

  const CellIndexView& index() const { return index_; }
  const FinestCells& finest_cells() const { return finest_; }
  CountedVector<TopCell>& tops() { return tops_; }

  /// Encodes colours and normals of cells from number `first` on. Thread-safe.
  void encode(std::uint64_t first, ValueList& values);
  /// Returns the materials as runs.
  static std::vector<MaterialCells> runs_of(const std::vector<std::uint16_t>& materials);
  /// Adds the materials of the next cells of a top cell. Calls are in the order of the numbers.
  void add_materials(TopCell& top, const std::vector<MaterialCells>& runs);
  /// Returns the attributes. All top cells that are not inner have their values.
  DagAttributes finish();

 private:
  CellValues join(std::size_t& at);

  SvdagView dag_;
  ValueKinds kinds_;
  Work work_;
  DagAttributes result_;
  MemoryReservation index_bytes_;
  CellIndexView index_;
  FinestCells finest_;
  ValueEncoder colors_, normals_;
  CountedVector<TopCell> tops_;             ///< In the order of their numbers.
  CountedVector<MaterialCells> materials_;  ///< Of the top cells that are not inner.
};

}  // namespace detail
}  // namespace voxdag
