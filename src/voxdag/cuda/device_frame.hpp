#pragma once
/// What a RenderSetup points to, in the memory of a CUDA device.
#include "voxdag/cuda/memory.hpp"
#include "voxdag/render/post_filter.hpp"
#include "voxdag/render/render_plan.hpp"

namespace voxdag {

class DeviceFrame {
 public:
  /// On the current device. Throws Error where memory is short, before any is taken.
  DeviceFrame(const RenderPlan& plan, bool with_beams, bool with_steps);

  /// With the device's pointers; beam_starts only with beams.
  const RenderSetup& setup() const { return setup_; }
  float* beam_starts() const { return beam_starts_.data(); }
  unsigned long long* rays() const { return rays_.data(); }  ///< Zero at first.

  /// What filters the picture, where the plan's options ask for it; else of no pixels.
  const FilterInput& filter_input() const { return filter_input_; }
  const FilterSample* filter_samples() const { return filter_samples_.data(); }
  Vec3f* filtered() const { return filtered_.data(); }

  /// Copies the picture, its filtered colours if it is so, and the number of its rays, once all
  /// kernels are done.
  void copy_to(RenderedImage& image, bool is_filtered) const;

 private:
  DeviceBuffer<Point2f> square_, disc_, rotations_;
  DeviceBuffer<HemisphereSample> hemisphere_;
  DeviceBuffer<Vec3f> radiance_, normal_, filtered_;
  DeviceBuffer<std::uint8_t> cell_pixels_;
  DeviceBuffer<FilterSample> filter_samples_;
  DeviceBuffer<float> depth_, occlusion_, shadow_, steps_, beam_starts_;
  DeviceBuffer<unsigned long long> rays_;
  RenderSetup setup_;
  FilterInput filter_input_;
};

}  // namespace voxdag
