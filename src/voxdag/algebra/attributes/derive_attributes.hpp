#pragma once
/// Makes the attributes of a DAG from those of others.
///
/// derive_attributes() walks the cells of the result in step with a *source*, which says where
/// their values come from. Where the source names a run of stored values for a whole subtree, they
/// are copied and the cells of the subtree are not visited. Elsewhere:
///
///   a cell of the finest level m   gets the mean of its voxels, each with weight 1; usually m = L,
///                                  so that the cell is a voxel
///   a cell above                   gets the mean of its children as they are stored, weighted by
///                                  the number of cells of level m in each
///
/// cell_mean.hpp says what a mean is.
///
/// A source is a type with
///   Cell                      copyable: where a cell of the result stands in the source
///   root()                    returns the Cell of the root
///   child(above, cell, place) returns the Cell of `cell`, a child of the cell that has the Cell
///                             `above`; `place` is its place in cells of its level
///   run(at, cell)             returns std::optional<StoredRun>. For a level up to m: the cells of
///                             the subtree, down to level m, and their values are those of the
///                             stored attributes from a number on. For a finer level: each voxel of
///                             the cell has the values of this number.
///   reader()                  returns a Reader for one thread, which refers to the source.
///                             reader.values(at, voxel) returns the CellValues of a voxel.
///   stored_count()            returns the number of stored attributes
///   stored(i)                 returns the StoredValues that StoredRun::stored names
///   kinds()                   returns the ValueKinds of the result. Every StoredRun and every
///                             CellValues has all of them.
///
/// The walk calls child() and run() for the children of a cell without a run, and values() for
/// voxels without a run. The functions are const, thread-safe, and depend on their arguments alone.
/// Cells below level m have no NumberedCell::number.

#include <algorithm>
#include <bit>

#include "voxdag/algebra/attributes/derived_values.hpp"
#include "voxdag/core/parallel/ordered_pipeline.hpp"
#include "voxdag/core/parallel/thread_count.hpp"

namespace voxdag {
namespace detail {

/// Derives the values of one subtree of the result.
template <class Source>
class SubtreeWalk {
 public:
  SubtreeWalk(const SvdagView& dag, DerivedValues& derived, const Source& source)
      : dag_(dag),
        derived_(derived),
        source_(source),
        kinds_(source.kinds()),
        reader_(source.reader()) {}

  /// Appends the values of `count` cells. Returns those of the first.
  CellValues copy(const StoredRun& run, std::uint64_t count, ValueList& list) {
    list.push(run, count);
    return stored_reader(run.stored).values(run.first);
  }

  /// Appends the values of all cells in the subtree of `cell`. Returns those of `cell`.
  CellValues visit(const NumberedCell& cell, Vec3i place, const typename Source::Cell& at,
                   ValueList& list) {
    if (const std::optional<StoredRun> run = source_.run(at, cell))
      return copy(*run, cells_in(dag_, derived_.index(), cell), list);
    const std::size_t own = list.push({});
    CellMean mean(kinds_);
    if (cell.level == derived_.index().finest_level) {
      add_voxels(cell, place, at, mean);
      derived_.check_precision(mean.result());
    } else {
      for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1) {
        const int index = std::countr_zero(left);
        const NumberedCell child = child_of(dag_, derived_.index(), cell, index);
        const Vec3i there = place * 2 + child_offset(index);
        const CellValues values = visit(child, there, source_.child(at, child, there), list);
        mean.add(values, derived_.finest_cells().below(child));
      }
    }
    const CellValues result = mean.result();
    list.set(own, result);
    return result;
  }

 private:
  void add_voxels(const NumberedCell& cell, Vec3i place, const typename Source::Cell& at,
                  CellMean& mean) {
    if (cell.level == dag_.levels) return mean.add(reader_.values(at, place), 1);
    for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1) {
      const int index = std::countr_zero(left);
      const NumberedCell child = child_of(dag_, derived_.index(), cell, index);
      const Vec3i there = place * 2 + child_offset(index);
      const typename Source::Cell below = source_.child(at, child, there);
      if (const std::optional<StoredRun> run = source_.run(below, child))
        mean.add(stored_reader(run->stored).values(run->first), voxels_in(dag_, child));
      else
        add_voxels(child, there, below, mean);
    }
  }

  StoredReader& stored_reader(std::size_t i) {
    while (stored_.size() <= i) stored_.emplace_back(source_.stored(stored_.size()));
    return stored_[i];
  }

  const SvdagView& dag_;
  DerivedValues& derived_;
  const Source& source_;
  ValueKinds kinds_;
  typename Source::Reader reader_;
  std::vector<StoredReader> stored_;
};

/// Lists the top cells from `cell` on, in the order of their numbers, and where they stand.
template <class Source>
void list_tops(const SvdagView& dag, const Source& source, const NumberedCell& cell, Vec3i place,
               const typename Source::Cell& at, DerivedValues& derived,
               CountedVector<typename Source::Cell>& places) {
  TopCell top{cell, place, cells_in(dag, derived.index(), cell), false, source.run(at, cell), {},
              0,    0};
  top.is_inner = !top.run && top.cells > kStepCells;
  if (top.is_inner) top.cells = 1;
  derived.tops().push_back(top);
  places.push_back(at);
  if (!top.is_inner) return;
  for (std::uint32_t left = children_of(dag, cell); left != 0; left &= left - 1) {
    const int index = std::countr_zero(left);
    const NumberedCell child = child_of(dag, derived.index(), cell, index);
    const Vec3i there = place * 2 + child_offset(index);
    list_tops(dag, source, child, there, source.child(at, child, there), derived, places);
  }
}

/// Derives attributes in pages with the precision of those that are copied, or with 8 bits. Returns
/// nothing if that is too coarse.
template <class Source>
std::optional<DagAttributes> derive_in_precision(const SvdagView& dag, int finest_level,
                                                 const Source& source, const CoarsenBounds& bounds,
                                                 bool has_8_bits, Work work) {
  std::vector<StoredValues> stored;
  for (std::size_t i = 0; i < source.stored_count(); ++i) stored.push_back(source.stored(i));
  DerivedValues derived(dag, finest_level, source.kinds(), std::move(stored), bounds, has_8_bits,
                        work);
  CountedVector<typename Source::Cell> places(work.memory);
  list_tops(dag, source, {}, {}, source.root(), derived, places);
  struct Step {
    std::size_t top;
    std::uint64_t begin, count;  ///< A part of the run of the top cell.
  };
  CountedVector<Step> steps(work.memory);
  CountedVector<TopCell>& tops = derived.tops();
  for (std::size_t i = 0; i < tops.size(); ++i)
    for (std::uint64_t begin = 0; !tops[i].is_inner && begin < tops[i].cells; begin += kStepCells)
      steps.push_back({i, begin, std::min(kStepCells, tops[i].cells - begin)});
  const std::size_t waiting = 2 * thread_count();
  const MemoryReservation lists(work.memory,
                                waiting * std::min(kStepCells, derived.index().cells) * 16);
  struct Done {
    std::size_t step;
    CellValues values;
    std::vector<MaterialCells> materials;
  };
  ordered_pipeline(
      steps.size(), waiting, work,
      [&](std::size_t i) {
        const Step& step = steps[i];
        const TopCell& top = tops[step.top];
        Done done{i, {}, {}};
        if (derived.needs_8_bits()) return done;
        SubtreeWalk<Source> walk(dag, derived, source);
        ValueList list;
        if (top.run)
          done.values = walk.copy({top.run->stored, top.run->first + step.begin}, step.count, list);
        else
          done.values = walk.visit(top.cell, top.place, places[step.top], list);
        derived.encode(top.cell.number + step.begin, list);
        done.materials = derived.materials_of(list);
        return done;
      },
      [&](const Done& done) {
        const Step& step = steps[done.step];
        TopCell& top = tops[step.top];
        if (step.begin == 0) top.values = done.values;
        derived.add_materials(top, done.materials);
        work.report_done("attributes", top.cell.number + step.begin + step.count,
                         derived.index().cells);
      });
  if (derived.needs_8_bits()) return std::nullopt;
  return derived.finish();
}

}  // namespace detail

/// Returns the attributes of the cells of `dag`, a valid DAG, down to the level `finest_level`, 0
/// to L. Without bounds, values of cells of level m are exact. The pages have the precision of
/// those that are copied (join_page.hpp) if it can store the new values, else 8 bits; means of
/// cells above are rounded to it. A kind with a bound is encoded again within it. The result's
/// errors are the differences of this encoding. The result depends on the DAG and the source alone,
/// on any number of threads. Without voxels or kinds, it is empty. Beside the encoding of all cells
/// and O(DAG), the time follows the cells without a run. Counts its memory in `work` until it
/// returns, some 16 bytes for each of the 65,536 cells that a thread derives in a step. Runs on the
/// current TBB arena. Throws OverMemory and Cancelled.
template <class Source>
DagAttributes derive_attributes(const SvdagView& dag, int finest_level, const Source& source,
                                const CoarsenBounds& bounds = {}, Work work = {}) {
  if (dag.is_empty() || source.kinds().is_empty()) return {};
  for (const bool has_8_bits : {false, true})
    if (auto derived =
            detail::derive_in_precision(dag, finest_level, source, bounds, has_8_bits, work))
      return *std::move(derived);
  return {};
}

}  // namespace voxdag
