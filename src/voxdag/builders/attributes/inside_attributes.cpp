#include "voxdag/builders/attributes/inside_attributes.hpp"

#include <algorithm>
#include <bit>
#include <vector>

#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/ordered_pipeline.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"
#include "voxdag/stored/attributes/numbered_cell.hpp"
#include "voxdag/stored/attributes/page_reader.hpp"

namespace voxdag {
namespace {

/// Subtrees of up to so many cells are filled in one step.
constexpr std::uint64_t kMostCells = std::uint64_t{1} << 16;

/// A cell of the solid, alone or with its subtree.
struct Filled {
  NumberedCell cell;
  Vec3i place{};  ///< In cells of its level.
  bool has_subtree = false;
};

/// The values of cells with consecutive numbers.
struct FilledValues {
  std::uint64_t first = 0;
  std::vector<Value8> colors, normals;
  std::vector<std::uint32_t> materials;
};

class InsideFiller {
 public:
  InsideFiller(const ColoredDagView& surface, const SvdagView& solid, const CellIndexView& index,
               const std::optional<Value8>& inside_color,
               std::span<CountedVector<std::int32_t>> channel_codes, Work work)
      : surface_(surface),
        solid_(solid),
        index_(index),
        inside_color_(inside_color),
        channel_codes_(channel_codes),
        finest_(coarsen(surface.dag, std::max<int>(index.finest_level, kMinLevels), work)),
        finest_bytes_(work.memory, finest_.view().bytes()),
        cells_(CountedAllocator<Filled>(work.memory)) {
    if (!solid.is_empty()) list({}, {});
  }

  const CountedVector<Filled>& cells() const { return cells_; }

  FilledValues values(const Filled& filled) const {
    FilledValues values{filled.cell.number, {}, {}, {}};
    PageReader colors(surface_.attributes.colors), normals(surface_.attributes.normals);
    fill(filled.cell, filled.place, filled.has_subtree, colors, normals, values);
    return values;
  }

 private:
  /// Lists the cells from `cell` on in the order of their numbers.
  void list(const NumberedCell& cell, Vec3i place) {
    const bool has_subtree = cells_in(solid_, index_, cell) <= kMostCells;
    cells_.push_back({cell, place, has_subtree});
    if (has_subtree) return;
    for (std::uint32_t left = children_of(solid_, cell); left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      list(child_of(solid_, index_, cell, child), place * 2 + child_offset(child));
    }
  }

  void fill(const NumberedCell& cell, Vec3i place, bool has_subtree, PageReader& colors,
            PageReader& normals, FilledValues& values) const {
    const auto [number, is_inside] = surface_number(cell, place);
    const DagAttributesView& of = surface_.attributes;
    if (of.has_colors())
      values.colors.push_back(is_inside && inside_color_ ? *inside_color_ : colors.value(number));
    if (of.has_normals()) values.normals.push_back(normals.value(number));
    if (of.has_materials()) values.materials.push_back(read_material(of.materials, number));
    for (std::size_t i = 0; i < channel_codes_.size(); ++i)
      channel_codes_[i][cell.number] =
          channel_code(of.channels[i].kind, of.channels[i].read(number));
    if (!has_subtree || cell.level == index_.finest_level) return;
    for (std::uint32_t left = children_of(solid_, cell); left != 0; left &= left - 1) {
      const int child = std::countr_zero(left);
      fill(child_of(solid_, index_, cell, child), place * 2 + child_offset(child), true, colors,
           normals, values);
    }
  }

  /// Returns the number of the surface's cell whose values the cell takes, and whether the surface
  /// does not have the cell itself.
  std::pair<std::uint64_t, bool> surface_number(const NumberedCell& cell, Vec3i place) const {
    std::uint64_t number = 0;
    const SvdagView& dag = surface_.dag;
    const CellIndexView& index = surface_.attributes.index;
    if (find_cell_number(dag, index, place, cell.level, number)) return {number, false};
    const double side = std::ldexp(1.0, finest_.levels - cell.level);
    const Vec3d centre = (static_cast<Vec3d>(place) + Vec3d{0.5, 0.5, 0.5}) * side;
    find_cell_number(dag, index, nearest_voxel(finest_.view(), centre)->voxel, finest_.levels,
                     number);
    return {number, true};
  }

  const ColoredDagView& surface_;
  const SvdagView& solid_;
  const CellIndexView& index_;
  const std::optional<Value8>& inside_color_;
  std::span<CountedVector<std::int32_t>> channel_codes_;  ///< By channel and number of cell.
  Svdag finest_;  ///< The cells of the surface's finest level, as voxels.
  MemoryReservation finest_bytes_;
  CountedVector<Filled> cells_;
};

}  // namespace

DagAttributes inside_attributes(const ColoredDagView& surface, const SvdagView& solid,
                                const AttributeOptions& options,
                                const std::optional<Value8>& inside_color, Work work) {
  DagAttributes result;
  if (surface.dag.is_empty() && !solid.is_empty())
    throw Error("no surface lies in the grid, so that the inside has nothing to take values from");
  if (surface.is_empty()) return result;
  result.index = build_cell_index(solid, surface.attributes.index.finest_level, work.memory);
  const MemoryReservation index_bytes(work.memory, result.index.view().bytes());
  const CellIndexView index = result.index.view();
  const DagAttributesView& of = surface.attributes;
  std::vector<CountedVector<std::int32_t>> channel_codes;
  for (std::size_t i = 0; i < of.channels.count(); ++i)
    channel_codes.emplace_back(index.cells, work.memory);
  const InsideFiller filler(surface, solid, index, inside_color, channel_codes, work);
  ValueEncoder colors(of.has_colors() ? index.cells : 0,
                      make_value_metric(kColorWeights, 255 * options.color_bound), work.memory);
  ValueEncoder normals(of.has_normals() ? index.cells : 0,
                       make_normal_metric(options.normal_bound_degrees), work.memory);
  MaterialEncoder materials(std::max(of.materials.materials, 1u), work.memory);
  const std::size_t waiting = 2 * thread_count();
  const MemoryReservation values(work.memory, waiting * kMostCells * 12);
  ordered_pipeline(
      filler.cells().size(), waiting, work,
      [&](std::size_t i) {
        FilledValues filled = filler.values(filler.cells()[i]);
        if (of.has_colors()) colors.add(filled.first, filled.colors);
        if (of.has_normals()) normals.add(filled.first, filled.normals);
        filled.colors = filled.normals = {};
        return filled;
      },
      [&](const FilledValues& filled) {
        for (const std::uint32_t id : filled.materials) materials.add(id, 1);
        work.report_done("inside", filled.first, index.cells);
      });
  if (of.has_colors()) result.colors = colors.finish(), result.color_errors = colors.errors();
  const MemoryReservation color_bytes(work.memory, result.colors.view().bytes());
  if (of.has_normals()) result.normals = normals.finish(), result.normal_errors = normals.errors();
  if (of.has_materials()) result.materials = materials.finish();
  std::vector<EncodedChannel> channels;
  for (std::size_t i = 0; i < channel_codes.size(); ++i) {
    channels.push_back(encode_channel(spec_of(of.channels[i]), channel_codes[i], work));
    channel_codes[i] = CountedVector<std::int32_t>(work.memory);
  }
  // The channels, and their copies in the result.
  const MemoryReservation channel_bytes(work.memory, 2 * bytes_of(channels));
  result.channels = join_channels(index.cells, channels);
  return result;
}

}  // namespace voxdag
