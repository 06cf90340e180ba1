#pragma once
/// The tables and buffers of a RenderSetup in the memory of a CUDA device.
#include "voxdag/cuda/memory.hpp"
#include "voxdag/render/post_filter.hpp"
#include "voxdag/render/render_plan.hpp"

namespace voxdag {

class DeviceFrame {
 public:
  /// Allocates a buffer on the current device for each of the plan's. `filter` must be that of the
  /// plan's options. Throws Error if memory is short, before it allocates anything.
  DeviceFrame(const RenderPlan& plan, bool with_beams, FilterKind filter);

  /// Returns the setup with pointers into device memory; beam_starts is null without beams.
  const RenderSetup& setup() const { return setup_; }
  float* beam_starts() const { return beam_starts_.data(); }
  unsigned long long* rays() const { return rays_.data(); }  ///< Initially zero.

  /// Returns the filter's input; its pixels are null without a filter.
  const FilterInput& filter_input() const { return filter_input_; }
  const FilterSample* filter_samples() const { return filter_samples_.data(); }
  Vec3f* filtered() const { return filtered_.data(); }

  /// Copies the picture and its number of rays to `image`; takes the filtered colours if
  /// `is_filtered`. All kernels must have finished.
  void copy_to(RenderedImage& image, bool is_filtered) const;

 private:
  DeviceBuffer<Point2f> square_, disc_, rotations_;
  DeviceBuffer<HemisphereSample> hemisphere_;
  DeviceBuffer<Vec3f> radiance_, normal_, albedo_, filtered_, environment_;
  DeviceBuffer<std::uint8_t> cell_pixels_;
  DeviceBuffer<SeenCell> cells_;
  DeviceBuffer<FilterSample> filter_samples_;
  DeviceBuffer<float> coverage_, depth_, occlusion_, shadow_, steps_, beam_starts_;
  DeviceBuffer<unsigned long long> rays_;
  RenderSetup setup_;
  FilterInput filter_input_;
};

}  // namespace voxdag
