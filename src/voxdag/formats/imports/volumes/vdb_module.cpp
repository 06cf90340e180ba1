/// The module that reads .vdb files: the only part that links OpenVDB.
#include "voxdag/formats/imports/volumes/vdb_module.hpp"

#include <openvdb/openvdb.h>

#include <functional>
#include <limits>
#include <string>
#include <tuple>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/open_input.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/channels/channel_request.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/volumes/volume_grid.hpp"

namespace voxdag {
namespace {

using GridTypes = std::tuple<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                             openvdb::Int64Grid, openvdb::BoolGrid, openvdb::MaskGrid>;

/// Calls use(grid) with the grid as its own type. Returns whether it is one of GridTypes.
template <class Use, std::size_t I = 0>
bool with_grid(const openvdb::GridBase& grid, const Use& use) {
  if constexpr (I < std::tuple_size_v<GridTypes>) {
    using GridType = std::tuple_element_t<I, GridTypes>;
    if (!grid.isType<GridType>()) return with_grid<Use, I + 1>(grid, use);
    use(static_cast<const GridType&>(grid));
    return true;
  }
  return false;
}

/// Decides which values set their voxels.
struct ValueRule {
  bool is_level_set;
  std::optional<double> threshold;

  bool operator()(double value, bool is_active) const {
    if (threshold) return is_active && value >= *threshold;
    return is_level_set ? value < 0 : is_active;
  }
};

/// Calls visit(box, value) for all voxels and tiles that are set: first those of leaves.
template <class GridType, class Visit>
void for_each_box(const GridType& grid, const ValueRule& is_set, const Visit& visit) {
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
    for (auto value = leaf->cbeginValueAll(); value; ++value)
      if (is_set(static_cast<double>(*value), value.isValueOn()))
        visit(openvdb::CoordBBox(value.getCoord(), value.getCoord()), *value);
  auto tile = grid.tree().cbeginValueAll();
  tile.setMaxDepth(GridType::TreeType::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (is_set(static_cast<double>(*tile), tile.isValueOn())) visit(tile.getBoundingBox(), *tile);
}

/// Returns the kind of channel for the values of a grid.
ChannelKind kind_of_grid(const openvdb::GridBase& grid) {
  if (grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>())
    return ChannelKind::kF32;
  const bool is_whole = grid.isType<openvdb::Int32Grid>() || grid.isType<openvdb::Int64Grid>();
  return is_whole ? ChannelKind::kI32 : ChannelKind::kU8;
}

Vec3d vector_of(const openvdb::Vec3d& v) { return {v.x(), v.y(), v.z()}; }
Vec3l vector_of(const openvdb::Coord& c) { return {c.x(), c.y(), c.z()}; }

class Vdb : public VoxelSource {
 public:
  Vdb(std::filesystem::path path, std::optional<double> threshold, const std::string& grid,
      bool has_labels, const std::vector<ChannelRequest>& channels)
      : path_(std::move(path)), rule_{false, threshold}, has_labels_(has_labels) {
    open_input(path_);  // Throws the usual errors.
    read_grids(grid, channels);
    rule_.is_level_set = vdb_->getGridClass() == openvdb::GRID_LEVEL_SET;
    find_extent();
  }

  bool has_points() const override { return false; }
  bool has_place() const override { return true; }
  bool has_labels() const override { return has_labels_; }
  std::vector<ChannelSpec> channels() const override { return channels_; }
  std::optional<Grid> grid() const override { return map_.grid(); }
  std::vector<std::string> warnings() const override { return warnings_; }

  void visit_all(const VisitBatch& visit) const override {
    const VisitBatch visit_cubes = [&](const VoxelBatch& batch) { map_.visit_cubes(batch, visit); };
    BatchedVoxels voxels(visit_cubes);
    std::vector<std::function<double(const openvdb::Coord&)>> channels;
    for (const openvdb::GridBase::ConstPtr& of_channel : channel_grids_)
      with_grid(*of_channel, [&](const auto& grid) {
        channels.push_back([values = grid.getConstAccessor()](const openvdb::Coord& at) {
          return static_cast<double>(values.getValue(at));
        });
      });
    with_grid(*vdb_, [&](const auto& grid) {
      for_each_box(grid, rule_, [&](const openvdb::CoordBBox& box, auto value) {
        const Vec3l lo = vector_of(box.min()) - lo_, hi = vector_of(box.max()) - lo_;
        for (std::int64_t z = lo.z; z <= hi.z; ++z)
          for (std::int64_t y = lo.y; y <= hi.y; ++y)
            for (std::int64_t x = lo.x; x <= hi.x; ++x) {
              if (has_labels_) voxels.add_label(label_of(value));
              for (const auto& value_at : channels)
                voxels.add_channel(value_at(box.min().offsetBy(static_cast<int>(x - lo.x),
                                                               static_cast<int>(y - lo.y),
                                                               static_cast<int>(z - lo.z))));
              voxels.add(static_cast<Vec3d>(Vec3l{x, y, z}));
            }
      });
    });
    voxels.finish();
  }

 private:
  /// Reads the grid of this name; if it is empty, the default of open_vdb(). Reads those of the
  /// channels.
  void read_grids(const std::string& wanted, const std::vector<ChannelRequest>& channels) {
    openvdb::initialize();
    openvdb::io::File file(path_.string());
    file.open(/*delayLoad=*/false);
    std::string chosen, names;
    std::size_t count = 0;
    std::vector<std::string> readable;
    for (auto name = file.beginName(); name != file.endName(); ++name) {
      if (!with_grid(*file.readGridMetadata(*name), [](const auto&) {})) continue;
      readable.push_back(*name);
      names += (count++ == 0 ? "" : ", ") + name_in_quotes(*name);
      const bool is_better =
          wanted.empty() ? chosen.empty() || *name == "density" : *name == wanted;
      if (is_better) chosen = *name;
    }
    if (count == 0)
      throw Error(path_.string(), "", "has no grid of floats, doubles, integers or bools, no mask");
    if (chosen.empty() && !wanted.empty())
      throw Error(path_.string(), "", "has no grid " + name_in_quotes(wanted) + ", but " + names);
    if (wanted.empty() && count > 1)
      warnings_.push_back("has the grids " + names + "; " + name_in_quotes(chosen) +
                          " is read, --grid chooses another one");
    vdb_ = file.readGrid(chosen);
    for (const ChannelRequest& channel : channels) {
      ChannelRequest of_grid = channel;
      if (channel.field == "value" && std::count(readable.begin(), readable.end(), "value") == 0)
        of_grid.field = chosen;
      const std::string name = readable[find_channel_fields(
          {of_grid}, readable.size(), [&](std::size_t i) { return readable[i]; })[0]];
      const auto grid = name == chosen ? vdb_ : file.readGrid(name);
      if (grid->transform() != vdb_->transform())
        throw Error(path_.string(), "",
                    "grid " + name_in_quotes(name) + " has another transform than " +
                        name_in_quotes(chosen) + ", whose voxels are read");
      channels_.push_back(channel_spec(channel, kind_of_grid(*grid)));
      channel_grids_.push_back(grid);
    }
  }

  void find_extent() {
    constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();
    Vec3l lo{kNone, kNone, kNone}, hi{-kNone, -kNone, -kNone};
    with_grid(*vdb_, [&](const auto& grid) {
      for_each_box(grid, rule_, [&](const openvdb::CoordBBox& box, const auto&) {
        lo = min(lo, vector_of(box.min()));
        hi = max(hi, vector_of(box.max()));
      });
    });
    if (lo.x > hi.x) lo = hi = {};
    lo_ = lo;
    VolumeSize size;
    for (int axis = 0; axis < 3; ++axis)
      size[axis] = static_cast<std::uint64_t>(hi[axis] - lo[axis] + 1);
    check_volume_size(path_, size);
    map_ = VolumeMap(path_, size, placement(), warnings_);
  }

  /// OpenVDB maps whole numbers to the centres of voxels.
  VolumePlacement placement() const {
    const openvdb::math::Transform& transform = vdb_->transform();
    const openvdb::Vec3d first = vector_from(lo_);
    VolumePlacement placement;
    placement.first_centre = vector_of(transform.indexToWorld(first));
    placement.is_known = true;
    placement.is_curved = !transform.isLinear();
    for (int axis = 0; axis < 3; ++axis) {
      openvdb::Vec3d next = first;
      next[axis] += 1;
      placement.steps[static_cast<std::size_t>(axis)] =
          vector_of(transform.indexToWorld(next)) - *placement.first_centre;
    }
    return placement;
  }

  static openvdb::Vec3d vector_from(Vec3l v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  }

  std::filesystem::path path_;
  openvdb::GridBase::ConstPtr vdb_;
  ValueRule rule_;
  bool has_labels_;
  std::vector<ChannelSpec> channels_;
  std::vector<openvdb::GridBase::ConstPtr> channel_grids_;
  Vec3l lo_;
  VolumeMap map_;
  std::vector<std::string> warnings_;
};

VoxelSource* open_vdb_in_module(const std::filesystem::path& path, std::optional<double> threshold,
                                const std::string& grid, bool has_labels,
                                const std::vector<ChannelRequest>& channels) {
  try {
    return new Vdb(path, threshold, grid, has_labels, channels);
  } catch (const openvdb::Exception& error) {
    throw Error(path.string(), "", "OpenVDB: " + printable(error.what()));
  } catch (const std::ios_base::failure& error) {
    throw Error(path.string(), "", "OpenVDB: " + printable(error.what()));
  }
}

}  // namespace
}  // namespace voxdag

extern "C" const voxdag::VdbModule voxdag_vdb_module = {voxdag::open_vdb_in_module};
