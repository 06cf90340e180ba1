#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "cuda_on_host/device_work.hpp"
#include "cuda_on_host/warp.hpp"

constinit thread_local uint3 threadIdx{}, blockIdx{};

namespace voxdag {
namespace {

thread_local Warp* running = nullptr;

unsigned count(const dim3& size) { return size.x * size.y * size.z; }

uint3 place(unsigned i, const dim3& size) {
  return {i % size.x, i / size.x % size.y, i / size.x / size.y};
}

}  // namespace

void Warp::run_thread() {
  (*running->thread_)();
  running->is_done_[running->lane_] = true;
}

void Warp::begin(unsigned lane) {
  is_done_[lane] = false;
  ucontext_t& context = contexts_[lane];
  getcontext(&context);
  context.uc_stack.ss_sp = stacks_.get() + lane * kStackBytes;
  context.uc_stack.ss_size = kStackBytes;
  context.uc_link = &caller_;
  makecontext(&context, run_thread, 0);
}

void Warp::run(const std::function<void()>& thread, const dim3& block, unsigned first) {
  thread_ = &thread;
  running = this;
  size_ = count(block) - first < kSize ? count(block) - first : kSize;
  for (unsigned lane = 0; lane < size_; ++lane) begin(lane);
  for (unsigned left = size_; left > 0; ++round_) {
    for (lane_ = 0; lane_ < size_; ++lane_) {
      if (is_done_[lane_]) continue;
      threadIdx = place(first + lane_, block);
      swapcontext(&caller_, &contexts_[lane_]);
      left -= is_done_[lane_] ? 1 : 0;
    }
    if (left == 0 || left == size_) continue;
    // This is undefined behaviour in CUDA.
    std::fputs("a thread ended while others of its warp waited for it\n", stderr);
    std::abort();
  }
}

unsigned long long Warp::value_down(unsigned long long value, unsigned by) {
  const unsigned lane = lane_;
  // Two rounds alternate, because other threads still read the values of the previous round.
  auto& values = values_[round_ % 2];
  values[lane] = value;
  swapcontext(&contexts_[lane], &caller_);
  return lane + by < size_ ? values[lane + by] : value;
}

namespace {

cudaError_t run_kernel(const cudaLaunchConfig_t& config, const std::function<void()>& thread) {
  static thread_local Warp warp;
  const DeviceAtWork at_work;
  for (unsigned block = 0; block < count(config.gridDim); ++block) {
    blockIdx = place(block, config.gridDim);
    for (unsigned first = 0; first < count(config.blockDim); first += Warp::kSize)
      warp.run(thread, config.blockDim, first);
  }
  return cudaSuccess;
}

}  // namespace
}  // namespace voxdag

cudaError_t launch_on_host(const cudaLaunchConfig_t& config, std::function<void()> thread) {
  if (voxdag::begin_call() != cudaSuccess) return cudaErrorUnknown;
  const auto is_in = [](unsigned size, unsigned most) { return size >= 1 && size <= most; };
  const dim3 &grid = config.gridDim, &block = config.blockDim;
  if (!is_in(grid.x, 0x7FFFFFFF) || !is_in(grid.y, 0xFFFF) || !is_in(grid.z, 0xFFFF) ||
      !is_in(voxdag::count(block), 1024))
    return voxdag::end_call(cudaErrorInvalidConfiguration);
  return voxdag::end_call(config.stream->add(
      [config, thread = std::move(thread)] { return voxdag::run_kernel(config, thread); }));
}

unsigned long long __shfl_down_sync(unsigned /*warp*/, unsigned long long value, int by) {
  return voxdag::running->value_down(value, static_cast<unsigned>(by));
}
