#pragma once
/// Collects points or voxels to batches.
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Passes points or voxels to `visit`, many at a time. Call finish() at the end.
class BatchedVoxels {
 public:
  explicit BatchedVoxels(const VisitBatch& visit) : visit_(visit) { places_.reserve(kBatch); }

  void add(Vec3d place) {
    places_.push_back(place);
    if (places_.size() == kBatch) finish();
  }
  /// A source gives all its places a colour, or none.
  void add(Vec3d place, Rgb8 color) {
    colors_.push_back(color);
    add(place);
  }
  /// Notes the splat of the place that is added next. A source gives all its places one, or none.
  void add_splat(const Splat& splat) { splats_.push_back(splat); }
  /// Notes the label of the place that is added next. A source gives all its places one, or none.
  void add_label(Label label) { labels_.push_back(label); }
  /// Notes the next channel of the place that is added next. A source gives all its places the same
  /// channels.
  void add_channel(double value) { channels_.push_back(value); }
  void finish() {
    if (!places_.empty()) visit_({places_, colors_, splats_, labels_, channels_});
    places_.clear();
    colors_.clear();
    splats_.clear();
    labels_.clear();
    channels_.clear();
  }

 private:
  static constexpr std::size_t kBatch = 4096;

  const VisitBatch& visit_;
  std::vector<Vec3d> places_;
  std::vector<Rgb8> colors_;
  std::vector<Splat> splats_;
  std::vector<Label> labels_;
  std::vector<double> channels_;
};

}  // namespace voxdag
