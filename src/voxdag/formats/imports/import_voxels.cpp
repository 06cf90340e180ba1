#include "voxdag/formats/imports/import_voxels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <string>

#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/formats/imports/channels/channel_collector.hpp"
#include "voxdag/formats/imports/colors/colored_voxel_builder.hpp"
#include "voxdag/formats/imports/labels/label_collector.hpp"
#include "voxdag/formats/imports/labels/label_names.hpp"
#include "voxdag/formats/imports/splats/import_splats.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"

namespace voxdag {
namespace {

/// Voxels in memory at a time, without a limit: 512 MiB.
constexpr std::size_t kMaxBufferedVoxels = std::size_t{1} << 26;

std::size_t voxels_in_memory(const MemoryBudget* memory, std::size_t bytes_per_voxel) {
  if (memory == nullptr || memory->limit() == 0) return kMaxBufferedVoxels;
  // The other half is for the nodes.
  return std::min<std::size_t>(kMaxBufferedVoxels, memory->left() / 2 / bytes_per_voxel);
}

/// The least and greatest coordinates in the file.
struct Extent {
  Vec3d lo{HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  std::uint64_t count = 0, not_finite = 0;
};

Extent extent_of(const VoxelSource& source, Work work) {
  Extent extent;
  source.visit_all([&](const VoxelBatch& batch) {
    work.poll();
    for (const Vec3d p : batch.places) {
      if (!is_finite(p)) {
        ++extent.not_finite;
        continue;
      }
      ++extent.count;
      extent.lo = min(extent.lo, p);
      extent.hi = max(extent.hi, p);
    }
  });
  return extent;
}

Grid grid_of_voxels(const VoxelSource& source, const ImportOptions& options, Work work) {
  Grid grid = source.grid().value_or(Grid{});
  if (!source.grid()) {
    const Extent extent = extent_of(source, work);
    const double most = std::max({extent.hi.x, extent.hi.y, extent.hi.z, 0.0});
    grid.levels =
        std::max(kMinLevels, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most))));
    if (grid.levels > kMaxLevels)
      throw Error("", "", "has voxels beyond 1048575, the last one of the largest grid");
  }
  grid.voxel_size = options.voxel_size.value_or(grid.voxel_size);
  grid.origin = options.origin.value_or(grid.origin * (options.voxel_size ? grid.voxel_size : 1));
  grid.quantization_scale = kSubvoxels / grid.voxel_size;
  if (options.resolution) grid.levels = levels_of(*options.resolution);
  return grid;
}

Grid grid_of_points(const VoxelSource& source, const ImportOptions& options, Work work) {
  if (options.bounds) return grid_for(Box3d::empty(), options);
  if (const std::optional<Grid> grid = source.grid();
      grid && !options.resolution && !options.origin && !options.snap && options.padding == 0 &&
      !options.center && options.voxel_size.value_or(grid->voxel_size) == grid->voxel_size)
    return *grid;
  const Extent extent = extent_of(source, work);
  if (extent.count == 0)
    throw Error("", "",
                extent.not_finite > 0 ? "has only points that are not finite, so it has no bounds"
                                      : "has no points, so it has no bounds");
  if (options.resolution) {
    GridRequest request = options;
    Box3d bounds{request.origin.value_or(extent.lo), extent.hi};
    request.origin.reset();
    // One point has a grid of voxels of size 1, as a mesh of one point has.
    if (bounds.lo == bounds.hi)
      bounds.hi = bounds.lo + Vec3d{1, 1, 1} * static_cast<double>(*options.resolution);
    request.bounds = bounds;
    return grid_for(Box3d::empty(), request);
  }
  if (options.origin || options.snap) {
    GridRequest request = options;
    Box3d bounds{extent.lo, extent.hi};
    // Points below the origin are left out, even if those are all.
    if (options.origin) bounds.hi = max(bounds.hi, *options.origin);
    return grid_for(bounds, request);
  }
  // Each axis begins half a voxel below the least coordinate; the last voxel is that of the
  // greatest one.
  const double size = *options.voxel_size;
  Grid grid = grid_from_voxel_size(Box3d{extent.lo, extent.lo}, size);
  grid.origin = extent.lo - Vec3d{0.5, 0.5, 0.5} * size;
  const PointLocator locator(grid, source.coordinate_error());
  double last = 0;
  Vec3l used;
  for (int axis = 0; axis < 3; ++axis) {
    const double index = locator.index(extent.hi[axis], axis);
    last = std::max(last, index);
    used[axis] = static_cast<std::int64_t>(index) + 1;
  }
  grid.levels = grid_from_voxel_size(Box3d{{0, 0, 0}, Vec3d{1, 1, 1} * (last * size)}, size).levels;
  return with_margins(grid, used, options);
}

}  // namespace

ImportResult import_voxels(const VoxelSource& source, const ImportOptions& options, Work work) {
  if (source.has_splats()) return import_splats(source, options, work);
  const bool has_points = source.has_points();
  ImportResult result;
  result.grid =
      has_points ? grid_of_points(source, options, work) : grid_of_voxels(source, options, work);
  const int levels = result.grid.levels;
  const PointLocator locator(result.grid, source.coordinate_error());
  const auto voxel_of = [&](Vec3d place) -> std::optional<Vec3i> {
    if (!has_points) {
      constexpr double kMax = std::numeric_limits<std::int32_t>::max();
      if (std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)}) > kMax)
        throw Error("", "", "has a voxel at a coordinate beyond 2^31");
      return static_cast<Vec3i>(place);
    }
    if (!options.bounds && !options.origin && !options.snap) return locator.voxel_in_box(place);
    return locator.voxel(place);
  };
  const LabelFilter filter(source, options);
  // Calls add(voxel, index) for all places in the grid.
  const auto each_voxel = [&](const VoxelBatch& batch, const auto& add) {
    work.poll();
    result.read += batch.places.size();
    for (std::size_t i = 0; i < batch.places.size(); ++i) {
      const Vec3d place = batch.places[i];
      if (!is_finite(place))
        ++result.not_finite;
      else if (!batch.labels.empty() && !filter.keeps(batch.labels[i]))
        ++result.unwanted;
      else if (const std::optional<Vec3i> voxel = voxel_of(place))
        add(*voxel, i);
      else
        ++result.outside;
    }
  };
  const bool has_colors = options.colors && source.has_colors(), has_labels = source.has_labels();
  const std::vector<ChannelSpec> specs = source.channels();
  const std::size_t tables = specs.size() + (has_colors ? 1 : 0) + (has_labels ? 1 : 0);
  const ColorRule rule = source.has_palette() ? ColorRule::kLast : ColorRule::kMean;
  const auto most = [&](std::size_t bytes) {
    return voxels_in_memory(work.memory, bytes) / std::max<std::size_t>(tables, 1);
  };
  std::optional<ColoredVoxelBuilder> colors;
  std::optional<LabelCollector> labels;
  std::optional<VoxelBuilder> voxels;
  if (has_colors) colors.emplace(levels, most(sizeof(ColoredCode)), options.folder, work, rule);
  if (has_labels)
    labels.emplace(levels, most(sizeof(VoxelRecord<Label>)), options.folder, work, rule);
  std::vector<EncodedChannel> encoded;
  for (const ChannelSpec& spec : specs) encoded.push_back({spec, {}});
  join_channels(1, encoded);  // Refuses wrong lists before the file is read.
  encoded.clear();
  std::deque<ChannelCollector> channels;
  for (const ChannelSpec& spec : specs)
    channels.emplace_back(levels, spec, most(sizeof(VoxelRecord<double>)), options.folder, work);
  if (tables == 0) voxels.emplace(levels, most(sizeof(std::uint64_t)), options.folder, work);
  source.visit_all([&](const VoxelBatch& batch) {
    if (voxels) return each_voxel(batch, [&](Vec3i voxel, std::size_t) { voxels->add(voxel); });
    each_voxel(batch, [&](Vec3i voxel, std::size_t i) {
      if (colors) colors->add(voxel, batch.colors[i]);
      if (labels) labels->add(voxel, batch.labels[i]);
      for (std::size_t c = 0; c < channels.size(); ++c)
        channels[c].add(voxel, batch.channels[i * channels.size() + c]);
    });
  });
  if (voxels) {
    result.dag = voxels->finish();
  } else if (colors) {
    auto [dag, attributes] = colors->finish(color_bound_of(source, options));
    colors.reset();
    result.dag = std::move(dag);
    result.attributes = std::move(attributes);
  } else {
    result.dag = labels ? labels->make_dag() : channels.front().make_dag();
  }
  const MemoryReservation bytes(work.memory, result.dag.view().bytes() + result.attributes.bytes());
  if (tables > 0 && !has_colors && !result.dag.view().is_empty())
    result.attributes.index = build_cell_index(result.dag.view(), levels, work.memory);
  if (labels) {
    LabelIds found = labels->encode();
    result.attributes.materials = std::move(found.ids);
    result.label_names = names_of_labels(found.labels, source.label_names());
    result.labels = std::move(found.labels);
    labels.reset();
  }
  for (; !result.dag.view().is_empty() && !channels.empty(); channels.pop_front())
    encoded.push_back(channels.front().encode(result.dag.view(), result.attributes.index.view()));
  result.attributes.channels = join_channels(result.attributes.index.cells, encoded);
  return result;
}

}  // namespace voxdag
