#pragma once
/// The base of sources that change another source.
#include <memory>
#include <utility>
#include <vector>

#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Answers as the source that it owns. Derived classes override what they change.
class DerivedSource : public VoxelSource {
 public:
  explicit DerivedSource(std::unique_ptr<VoxelSource> source) : source_(std::move(source)) {}

  bool has_points() const override { return source_->has_points(); }
  bool has_colors() const override { return source_->has_colors(); }
  bool has_splats() const override { return source_->has_splats(); }
  bool has_labels() const override { return source_->has_labels(); }
  std::map<Label, std::string> label_names() const override { return source_->label_names(); }
  std::vector<ChannelSpec> channels() const override { return source_->channels(); }
  CoordinateError coordinate_error() const override { return source_->coordinate_error(); }
  bool has_palette() const override { return source_->has_palette(); }
  std::optional<Grid> grid() const override { return source_->grid(); }
  bool has_place() const override { return source_->has_place(); }
  std::optional<char> up() const override { return source_->up(); }
  Vec3l first_voxel() const override { return source_->first_voxel(); }
  std::vector<std::string> warnings() const override { return source_->warnings(); }
  void visit_all(const VisitBatch& visit) const override { source_->visit_all(visit); }

 protected:
  /// Calls visit() with place_of(place) for every place of the source.
  template <class PlaceOf>
  void visit_moved(const VisitBatch& visit, const PlaceOf& place_of) const {
    std::vector<Vec3d> places;
    source_->visit_all([&](const VoxelBatch& batch) {
      places.clear();
      for (const Vec3d place : batch.places) places.push_back(place_of(place));
      visit({places, batch.colors, {}, batch.labels, batch.channels});
    });
  }

  std::unique_ptr<VoxelSource> source_;
};

}  // namespace voxdag
