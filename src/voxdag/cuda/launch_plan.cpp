#include "voxdag/cuda/launch_plan.hpp"

#include <algorithm>

namespace voxdag {
namespace {

constexpr double kSecondsPerLaunch = 0.2;
constexpr double kMaxGrowth = 4;

}  // namespace

LaunchPlan::LaunchPlan(std::uint32_t blocks, int samples, double work_per_sample, double first_work,
                       std::uint32_t max_blocks, int max_samples)
    : blocks_(blocks),
      max_blocks_(max_blocks),
      samples_(blocks == 0 ? 0 : samples),
      max_samples_(max_samples),
      work_per_sample_(work_per_sample),
      work_per_launch_(first_work) {}

std::optional<LaunchRange> LaunchPlan::next() {
  if (sample_ == samples_) return std::nullopt;
  const double affordable = std::max(work_per_launch_ / work_per_sample_, 1.0);  // samples
  if (block_ == 0) {
    const double passes = std::clamp(affordable / blocks_, 1.0, static_cast<double>(max_samples_));
    end_sample_ = sample_ + static_cast<int>(std::min<double>(passes, samples_ - sample_));
  }
  const double blocks = std::max(affordable / (end_sample_ - sample_), 1.0);
  const double most = std::min<double>(max_blocks_, blocks_ - block_);
  LaunchRange range;
  range.first_block = block_;
  range.last_block = block_ + static_cast<std::uint32_t>(std::min(blocks, most));
  range.first_sample = sample_;
  range.last_sample = end_sample_;
  block_ = range.last_block;
  if (block_ == blocks_) {
    block_ = 0;
    sample_ = end_sample_;
  }
  return range;
}

void LaunchPlan::measured(const LaunchRange& range, double seconds) {
  const double work = work_per_sample_ * (range.last_block - range.first_block) *
                      (range.last_sample - range.first_sample);
  const double factor = kSecondsPerLaunch / std::max(seconds, kSecondsPerLaunch / kMaxGrowth);
  // The time of a small last launch says nothing about larger ones.
  if (factor < 1 || work * factor > work_per_launch_) work_per_launch_ = work * factor;
}

double LaunchPlan::fraction() const {
  if (samples_ == 0) return 1;
  const double done = sample_ + (end_sample_ - sample_) * (static_cast<double>(block_) / blocks_);
  return done / samples_;
}

}  // namespace voxdag
