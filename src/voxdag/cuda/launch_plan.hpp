#pragma once
/// Divides a picture into launches that take a fraction of a second each, so that a display on the
/// same device stays responsive, progress is visible, and the work can be cancelled.
#include <cstdint>
#include <optional>

namespace voxdag {

/// The work of one launch: samples [first_sample, last_sample) of the pixels of blocks
/// [first_block, last_block).
struct LaunchRange {
  std::uint32_t first_block = 0, last_block = 0;
  int first_sample = 0, last_sample = 0;
};

/// Covers every sample of every block once; a block's samples come in order. Adapts the size of
/// launches to their measured speed.
class LaunchPlan {
 public:
  /// `work_per_sample` estimates the cost of a block's sample, in any unit; `first_work` limits the
  /// cost of the first launch. No launch has more than `max_blocks` blocks or `max_samples`
  /// samples.
  LaunchPlan(std::uint32_t blocks, int samples, double work_per_sample, double first_work,
             std::uint32_t max_blocks, int max_samples);

  /// Returns the next launch, or nothing at the end.
  std::optional<LaunchRange> next();
  /// Records the time that a launch took.
  void measured(const LaunchRange& range, double seconds);

  /// Returns the fraction of the picture that the launches so far cover, 0 to 1.
  double fraction() const;

 private:
  std::uint32_t blocks_, max_blocks_;
  int samples_, max_samples_;
  double work_per_sample_, work_per_launch_;
  std::uint32_t block_ = 0;
  int sample_ = 0, end_sample_ = 0;  // range of the current pass over the blocks
};

}  // namespace voxdag
