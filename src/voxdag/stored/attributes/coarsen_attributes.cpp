#include "voxdag/stored/attributes/coarsen_attributes.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"
#include "voxdag/stored/attributes/numbered_cell.hpp"
#include "voxdag/stored/attributes/page_reader.hpp"

namespace voxdag {
namespace {

/// Returns a copy of the pages. `memory` counts it until the function returns.
CellPages copy_of(const CellPagesView& view, MemoryBudget* memory) {
  const MemoryReservation counted(memory, view.bytes());
  return {{view.groups, view.groups + view.group_count()},
          {view.pages, view.pages + view.page_count()},
          {view.words, view.words + view.word_count},
          view.values};
}

ValueMetric color_metric(const CoarsenBounds& bounds) {
  return make_value_metric(kColorWeights, 255 * bounds.color_bound);
}

ValueMetric normal_metric(const CoarsenBounds& bounds) {
  return make_normal_metric(bounds.normal_bound_degrees);
}

/// Encodes values again, from lists of the numbers that they have in the fine grid.
class ValueCopier {
 public:
  ValueCopier(const ValuePagesView& fine, std::uint64_t cells, const ValueMetric& metric,
              MemoryBudget* memory)
      : fine_(fine) {
    if (!fine.is_empty()) encoder_.emplace(cells, metric, memory);
  }

  /// Adds the values with these numbers. `first`, a multiple of kPageValues, is the new number of
  /// the first one. Thread-safe.
  void add(std::uint64_t first, std::span<const std::uint64_t> numbers) {
    if (!encoder_) return;
    PageReader reader(fine_);
    std::array<Value8, kPageValues> values;
    std::transform(numbers.begin(), numbers.end(), values.begin(),
                   [&](std::uint64_t number) { return reader.value(number); });
    encoder_->add(first, std::span(values).first(numbers.size()));
  }
  ValuePages finish() { return encoder_ ? encoder_->finish() : ValuePages{}; }

 private:
  const ValuePagesView& fine_;
  std::optional<ValueEncoder> encoder_;
};

/// Walks the cells of the fine grid down to the finest level of the coarse one.
class Coarsener {
 public:
  Coarsener(const ColoredDagView& fine, const CellIndex& index, const CoarsenBounds& bounds,
            Work work)
      : fine_(fine),
        index_(index),
        work_(work),
        colors_(fine.attributes.colors, index.cells, color_metric(bounds), work.memory),
        normals_(fine.attributes.normals, index.cells, normal_metric(bounds), work.memory) {
    if (fine.attributes.has_materials())
      materials_.emplace(fine.attributes.materials.materials, work.memory);
    numbers_.reserve(kAtOnce);
  }

  void fill(DagAttributes& result) {
    visit({});
    flush();
    result.colors = colors_.finish();
    const MemoryReservation color_bytes(work_.memory, result.colors.view().bytes());
    result.normals = normals_.finish();
    if (materials_) result.materials = materials_->finish();
  }

 private:
  static constexpr std::size_t kAtOnce = std::size_t{1024} * kPageValues;

  void visit(const NumberedCell& cell) {
    numbers_.push_back(cell.number);
    if (numbers_.size() == kAtOnce) flush();
    if (cell.level == index_.finest_level) return;
    for (std::uint32_t left = children_of(fine_.dag, cell); left != 0; left &= left - 1)
      visit(child_of(fine_.dag, fine_.attributes.index, cell, std::countr_zero(left)));
  }

  /// Encodes the values of the cells that were visited.
  void flush() {
    parallel_for((numbers_.size() + kPageValues - 1) / kPageValues, [&](std::size_t page) {
      work_.poll();
      const std::size_t begin = page * kPageValues;
      const auto part = std::span(numbers_).subspan(
          begin, std::min<std::size_t>(kPageValues, numbers_.size() - begin));
      colors_.add(done_ + begin, part);
      normals_.add(done_ + begin, part);
    });
    if (materials_)
      for (const std::uint64_t number : numbers_)
        materials_->add(read_material(fine_.attributes.materials, number), 1);
    done_ += numbers_.size();
    numbers_.clear();
    work_.report_done("attributes", done_, index_.cells);
  }

  const ColoredDagView& fine_;
  const CellIndex& index_;
  Work work_;
  ValueCopier colors_, normals_;
  std::optional<MaterialEncoder> materials_;
  std::vector<std::uint64_t> numbers_;  // in the fine grid, of cells that are not yet encoded
  std::uint64_t done_ = 0;
};

/// Calls add(number) with the number of a cell, and those of all cells below it down to `finest`.
template <class Add>
void visit_numbers(const ColoredDagView& fine, const NumberedCell& cell, int finest,
                   const Add& add) {
  add(cell.number);
  if (cell.level == finest) return;
  for (std::uint32_t left = children_of(fine.dag, cell); left != 0; left &= left - 1)
    visit_numbers(fine, child_of(fine.dag, fine.attributes.index, cell, std::countr_zero(left)),
                  finest, add);
}

/// Returns the channels of the cells that stay, with the values that they have.
CellChannels coarsen_channels(const ColoredDagView& fine, const CellIndex& index, Work work) {
  const ChannelsView& channels = fine.attributes.channels;
  std::vector<EncodedChannel> coarse;
  for (std::size_t i = 0; i < channels.count(); ++i) {
    const ChannelView channel = channels[i];
    CountedVector<std::int32_t> codes(work.memory);
    visit_numbers(fine, {}, index.finest_level, [&](std::uint64_t number) {
      work.poll_seldom(number);
      codes.push_back(channel_code(channel.kind, channel.read(number)));
    });
    coarse.push_back(encode_channel(spec_of(channel), codes, work));
  }
  return join_channels(index.cells, coarse);
}

}  // namespace

DagAttributes coarsen_attributes(const ColoredDagView& fine, const SvdagView& coarse,
                                 const CoarsenBounds& bounds, Work work) {
  DagAttributes result;
  if (fine.is_empty()) return result;
  const int finest = fine.attributes.index.finest_level;
  result.index = build_cell_index(coarse, std::min(finest, coarse.levels), work.memory);
  const MemoryReservation index_bytes(work.memory, result.index.view().bytes());
  if (finest <= coarse.levels) {
    // The cells with attributes, and so their numbers, are those of the fine grid.
    const auto& [fine_index, colors, normals, materials, channels] = fine.attributes;
    result.colors = {copy_of(colors, work.memory), colors.precision};
    result.normals = {copy_of(normals, work.memory), normals.precision};
    result.materials = {copy_of(materials, work.memory), materials.materials};
    result.channels.words.assign(channels.words, channels.words + channels.bytes() / 8);
    return result;
  }
  Coarsener(fine, result.index, bounds, work).fill(result);
  result.channels = coarsen_channels(fine, result.index, work);
  return result;
}

}  // namespace voxdag
