#pragma once
/// The parts of derive_attributes() that do not depend on the source.
#include <atomic>
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

/// The values of cells with consecutive numbers.
class ValueList {
 public:
  /// The next values() of new cells, or a run of stored ones.
  struct Part {
    std::uint64_t cells = 0;
    std::optional<StoredRun> run;
  };

  /// Appends a new cell. Returns its place in values().
  std::size_t push(const CellValues& values) {
    if (parts_.empty() || parts_.back().run) parts_.push_back({});
    ++parts_.back().cells;
    values_.push_back(values);
    return values_.size() - 1;
  }
  void push(const StoredRun& run, std::uint64_t cells) { parts_.push_back({cells, run}); }
  void set(std::size_t place, const CellValues& values) { values_[place] = values; }

  std::span<const Part> parts() const { return parts_; }
  std::span<const CellValues> values() const { return values_; }

 private:
  std::vector<Part> parts_;
  std::vector<CellValues> values_;  ///< Of the parts without a run.
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
                std::vector<StoredValues> stored, const CoarsenBounds& bounds, bool has_8_bits,
                Work work);

  const CellIndexView& index() const { return index_; }
  const FinestCells& finest_cells() const { return finest_; }
  CountedVector<TopCell>& tops() { return tops_; }

  /// Notes whether the precision of the pages is too coarse for new values of a cell of the finest
  /// level. Thread-safe.
  void check_precision(const CellValues& values);
  /// Returns whether it is, for new or copied values.
  bool needs_8_bits() const {
    return needs_8_bits_ || colors_.rounds_copies() || normals_.rounds_copies();
  }

  /// Encodes colours and normals of cells from number `first` on. Thread-safe.
  void encode(std::uint64_t first, const ValueList& list);
  /// Returns the materials of cells as runs. Thread-safe.
  std::vector<MaterialCells> materials_of(const ValueList& list) const;
  /// Adds the materials of the next cells of a top cell. Calls are in the order of the numbers.
  void add_materials(TopCell& top, const std::vector<MaterialCells>& runs);
  /// Returns the attributes. All top cells that are not inner have their values.
  DagAttributes finish();

 private:
  CellValues join(std::size_t& at);
  /// Encodes the values of one kind: pages(attributes) are the stored ones, value(values) is that
  /// of a new cell.
  template <class Pages, class Value>
  void encode_kind(ValueEncoder& encoder, bool copies, std::uint64_t first, const ValueList& list,
                   const Pages& pages, const Value& value) const;

  SvdagView dag_;
  ValueKinds kinds_;
  std::vector<StoredValues> stored_;
  bool copies_colors_, copies_normals_;  ///< Values that stay as they are stored are not decoded.
  Work work_;
  DagAttributes result_;
  MemoryReservation index_bytes_;
  CellIndexView index_;
  FinestCells finest_;
  ValueEncoder colors_, normals_;
  std::atomic<bool> needs_8_bits_ = false;
  CountedVector<TopCell> tops_;             ///< In the order of their numbers.
  CountedVector<MaterialCells> materials_;  ///< Of the top cells that are not inner.
};

}  // namespace detail
}  // namespace voxdag
