#pragma once
/// A picture in pieces that keep a device busy for a fraction of a second each: a display that runs
/// on it stays alive, progress is seen and work can be cancelled.
#include <cstdint>
#include <optional>

namespace voxdag {

/// Samples [first_sample, last_sample) of the pixels of blocks [first_block, last_block).
struct LaunchRange {
  std::uint32_t first_block = 0, last_block = 0;
  int first_sample = 0, last_sample = 0;
};

/// Every sample of every block once, a block's samples in order. Pieces grow and shrink with the
/// speed that they run at.
class LaunchPlan {
 public:
  /// `work_per_sample` is about what a block's sample costs, in any unit, `first_work` what the
  /// first piece may cost. No piece has more than `max_blocks` blocks or `max_samples` samples.
  LaunchPlan(std::uint32_t blocks, int samples, double work_per_sample, double first_work,
             std::uint32_t max_blocks, int max_samples);

  /// The next piece, until there is none.
  std::optional<LaunchRange> next();
  /// Tells how long a piece took.
  void measured(const LaunchRange& range, double seconds);

  /// The part of all that the pieces so far are, 0 to 1.
  double fraction() const;

 private:
  std::uint32_t blocks_, max_blocks_;
  int samples_, max_samples_;
  double work_per_sample_, work_per_launch_;
  std::uint32_t block_ = 0;
  int sample_ = 0, end_sample_ = 0;  // of the pass over the blocks at hand
};

}  // namespace voxdag
