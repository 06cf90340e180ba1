#include "voxdag/formats/imports/moved_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "voxdag/algebra/align_grids.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/imports/derived_source.hpp"

namespace voxdag {
namespace {

/// Returns the turn of a transform as a quaternion w, x, y, z.
std::array<double, 4> quaternion_of(const InputTransform& transform) {
  const Vec3d x = transform.turned({1, 0, 0}), y = transform.turned({0, 1, 0}),
              z = transform.turned({0, 0, 1});
  // Four times the squares of its parts; the largest one gives the others.
  const std::array<double, 4> squares{1 + x.x + y.y + z.z, 1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z,
                                      1 - x.x - y.y + z.z};
  std::array<double, 4> q{squares[0], y.z - z.y, z.x - x.z, x.y - y.x};
  const auto most = std::max_element(squares.begin(), squares.end()) - squares.begin();
  if (most == 1) q = {y.z - z.y, squares[1], y.x + x.y, z.x + x.z};
  if (most == 2) q = {z.x - x.z, y.x + x.y, squares[2], z.y + y.z};
  if (most == 3) q = {x.y - y.x, z.x + x.z, z.y + y.z, squares[3]};
  return q;
}

/// Returns the rotation that turns by `b`, then by `a`, rounded to floats.
std::array<float, 4> quaternion_product(const std::array<double, 4>& a,
                                        const std::array<float, 4>& b) {
  const double w = b[0], x = b[1], y = b[2], z = b[3];
  const std::array<double, 4> turned{
      a[0] * w - a[1] * x - a[2] * y - a[3] * z, a[0] * x + a[1] * w + a[2] * z - a[3] * y,
      a[0] * y - a[1] * z + a[2] * w + a[3] * x, a[0] * z + a[1] * y - a[2] * x + a[3] * w};
  std::array<float, 4> rounded;
  for (std::size_t i = 0; i < 4; ++i) rounded[i] = static_cast<float>(turned[i]);
  return rounded;
}

class MovedPoints final : public DerivedSource {
 public:
  MovedPoints(std::unique_ptr<VoxelSource> source, const InputTransform& transform)
      : DerivedSource(std::move(source)), transform_(transform), turn_(quaternion_of(transform)) {}

  CoordinateError coordinate_error() const override {
    CoordinateError error = source_->coordinate_error();
    const Vec3d of_file = error.absolute;
    const double most = std::max({of_file.x, of_file.y, of_file.z}) * transform_.factor();
    // The transform rounds once more.
    return {2 * error.relative, {most, most, most}};
  }
  std::optional<Grid> grid() const override { return std::nullopt; }
  void visit_all(const VisitBatch& visit) const override {
    if (!has_splats())
      return visit_moved(visit, [this](Vec3d point) { return transform_.point(point); });
    std::vector<Vec3d> places;
    std::vector<Splat> splats;
    source_->visit_all([&](const VoxelBatch& batch) {
      places.clear();
      for (const Vec3d place : batch.places) places.push_back(transform_.point(place));
      splats.assign(batch.splats.begin(), batch.splats.end());
      for (Splat& splat : splats) {
        splat.rotation = quaternion_product(turn_, splat.rotation);
        for (float& scale : splat.scale)
          scale = static_cast<float>(static_cast<double>(scale) * transform_.factor());
      }
      visit({places, batch.colors, splats});
    });
  }

 private:
  InputTransform transform_;
  std::array<double, 4> turn_;
};

class TurnedVoxels final : public DerivedSource {
 public:
  TurnedVoxels(std::unique_ptr<VoxelSource> source, const InputTransform& transform)
      : DerivedSource(std::move(source)), transform_(transform) {
    if (!transform.keeps_axes()) throw Error("", "", "holds voxels, which turn by quarters only");
    grid_ = source_->grid();
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d unit{};
      unit[axis] = 1;
      const Vec3d turned = transform.turned(unit);
      for (int to = 0; to < 3; ++to)
        if (turned[to] != 0) from_[to] = axis, is_flipped_[to] = turned[to] < 0;
    }
    if (!grid_) {
      if (transform.factor() != 1 || transform.point({}) != Vec3d{})
        throw Error("", "",
                    "does not say where its voxels lie, so --unit, --scale and --translate cannot "
                    "move them: --voxel-size and --origin place them");
      find_sides();
      return;
    }
    sides_ = Vec3d{1, 1, 1} * static_cast<double>(grid_->resolution());
    const Vec3d corner = transform.point(grid_->origin);
    grid_->voxel_size *= transform.factor();
    grid_->quantization_scale = kSubvoxels / grid_->voxel_size;
    grid_->origin = corner;
    for (int axis = 0; axis < 3; ++axis)
      if (is_flipped_[axis]) grid_->origin[axis] -= sides_[axis] * grid_->voxel_size;
  }

  std::optional<Grid> grid() const override { return grid_; }
  Vec3l first_voxel() const override { return {}; }
  void visit_all(const VisitBatch& visit) const override {
    visit_moved(visit, [this](Vec3d voxel) {
      Vec3d turned;
      for (int axis = 0; axis < 3; ++axis) {
        const int from = from_[axis];
        turned[axis] = is_flipped_[axis] ? sides_[from] - 1 - voxel[from] : voxel[from];
      }
      return turned;
    });
  }

 private:
  /// Finds the sides of the box from voxel 0 on that holds all voxels.
  void find_sides() {
    source_->visit_all([this](const VoxelBatch& batch) {
      for (const Vec3d voxel : batch.places) sides_ = max(sides_, voxel + Vec3d{1, 1, 1});
    });
  }

  InputTransform transform_;
  std::optional<Grid> grid_;
  int from_[3] = {};
  bool is_flipped_[3] = {};
  Vec3d sides_{1, 1, 1};  ///< In voxels, along the axes of the source.
};

class JoinedSource final : public VoxelSource {
 public:
  explicit JoinedSource(std::vector<std::unique_ptr<VoxelSource>> sources)
      : sources_(std::move(sources)), offsets_(sources_.size()) {
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      const VoxelSource& source = *sources_[i];
      if (source.has_points() != has_points())
        throw Error("", "", "is joined with others: all of them must hold points, or all voxels");
      if (source.has_splats() != has_splats())
        throw Error("", "", "is joined with others: all of them must hold splats, or none");
      if (source.has_labels() != has_labels())
        throw Error("", "", "is joined with others: all of them must have labels, or none");
      if (source.channels() != channels())
        throw Error("", "", "is joined with others: all of them must have the same channels");
      if (source.has_labels()) add_names(source.label_names());
      has_colors_ |= source.has_colors();
      if (!has_points()) add_grid(i);
    }
  }

  bool has_points() const override { return sources_[0]->has_points(); }
  bool has_colors() const override { return has_colors_; }
  bool has_splats() const override { return sources_[0]->has_splats(); }
  bool has_labels() const override { return sources_[0]->has_labels(); }
  std::map<Label, std::string> label_names() const override { return label_names_; }
  std::vector<ChannelSpec> channels() const override { return sources_[0]->channels(); }
  bool has_palette() const override {
    return std::all_of(sources_.begin(), sources_.end(),
                       [](const auto& source) { return source->has_palette(); });
  }
  bool has_place() const override { return sources_[0]->has_place(); }
  std::optional<char> up() const override { return sources_[0]->up(); }
  std::optional<Grid> grid() const override { return grid_; }
  CoordinateError coordinate_error() const override {
    CoordinateError most = sources_[0]->coordinate_error();
    for (const auto& source : sources_) {
      const CoordinateError error = source->coordinate_error();
      most.relative = std::max(most.relative, error.relative);
      most.absolute = max(most.absolute, error.absolute);
    }
    return most;
  }
  void visit_all(const VisitBatch& visit) const override {
    std::vector<Vec3d> places;
    std::vector<Rgb8> grey;
    for (std::size_t i = 0; i < sources_.size(); ++i)
      sources_[i]->visit_all([&](const VoxelBatch& batch) {
        VoxelBatch moved = batch;
        if (offsets_[i] != Vec3i{}) {
          places.clear();
          for (const Vec3d place : batch.places)
            places.push_back(place + static_cast<Vec3d>(offsets_[i]));
          moved.places = places;
        }
        if (has_colors_ && batch.colors.empty()) {
          grey.resize(batch.places.size(), {204, 204, 204});
          moved.colors = std::span(grey).first(batch.places.size());
        }
        visit(moved);
      });
  }

 private:
  /// Adds the names of a source. Each file of Minecraft numbers its own blocks.
  void add_names(const std::map<Label, std::string>& names) {
    for (const auto& [label, name] : names)
      if (const auto known = label_names_.emplace(label, name).first; known->second != name)
        throw Error("", "",
                    "is joined with others: its label " + std::to_string(label) + " is " +
                        name_in_quotes(name) + ", and that of another file is " +
                        name_in_quotes(known->second) + "; import them one by one, and combine");
  }
  /// Lets the common grid hold that of source `i`.
  void add_grid(std::size_t i) {
    const std::optional<Grid> grid = sources_[i]->grid();
    if (i > 0 && grid.has_value() != grid_.has_value())
      throw Error("", "",
                  "is joined with others: all of them must say where their voxels lie, or none");
    if (!grid || i == 0) {
      grid_ = grid;
      return;
    }
    const AlignedGrids aligned = align_grids(*grid_, *grid);
    for (std::size_t k = 0; k < i; ++k) offsets_[k] = offsets_[k] + aligned.first;
    offsets_[i] = aligned.second;
    grid_ = aligned.grid;
  }

  std::vector<std::unique_ptr<VoxelSource>> sources_;
  std::vector<Vec3i> offsets_;  ///< Of the sources' voxels in the common grid.
  std::optional<Grid> grid_;
  bool has_colors_ = false;
  std::map<Label, std::string> label_names_;
};

}  // namespace

std::unique_ptr<VoxelSource> moved_source(std::unique_ptr<VoxelSource> source,
                                          const InputTransform& transform) {
  if (transform.is_identity()) return source;
  if (source->has_points()) return std::make_unique<MovedPoints>(std::move(source), transform);
  return std::make_unique<TurnedVoxels>(std::move(source), transform);
}

std::unique_ptr<VoxelSource> joined_source(std::vector<std::unique_ptr<VoxelSource>> sources) {
  if (sources.size() == 1) return std::move(sources[0]);
  return std::make_unique<JoinedSource>(std::move(sources));
}

}  // namespace voxdag
