#include <algorithm>
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

void Warp::run_threads() {
  Warp& warp = *running;
  const unsigned stack = warp.started_;
  while (warp.started_ < warp.size_) {
    const unsigned lane = warp.started_++;
    warp.stack_of_[lane] = stack;
    warp.enter(lane);
    (*warp.thread_)();
    warp.is_done_[lane] = true;
  }
}

void Warp::enter(unsigned lane) {
  lane_ = lane;
  threadIdx = place(first_ + lane, block_);
}

void Warp::start_stack(unsigned stack) {
  ucontext_t& context = contexts_[stack];
  getcontext(&context);
  context.uc_stack.ss_sp = stacks_.get() + stack * kStackBytes;
  context.uc_stack.ss_size = kStackBytes;
  context.uc_link = &caller_;
  makecontext(&context, run_threads, 0);
  swapcontext(&caller_, &context);
}

void Warp::run(const std::function<void()>& thread, const dim3& block, unsigned first) {
  thread_ = &thread;
  running = this;
  block_ = block;
  first_ = first;
  size_ = count(block) - first < kSize ? count(block) - first : kSize;
  is_done_ = {};
  for (started_ = 0; started_ < size_;) start_stack(started_);
  for (;;) {
    ++round_;
    const auto done = static_cast<unsigned>(std::count(is_done_.begin(), is_done_.end(), true));
    if (done == size_) return;
    // This is undefined behaviour in CUDA.
    if (done != 0) {
      std::fputs("a thread ended while others of its warp waited for it\n", stderr);
      std::abort();
    }
    for (unsigned lane = 0; lane < size_; ++lane) {
      enter(lane);
      swapcontext(&caller_, &contexts_[stack_of_[lane]]);
    }
  }
}

unsigned long long Warp::value_down(unsigned long long value, unsigned by) {
  const unsigned lane = lane_;
  // Two rounds alternate, because other threads still read the values of the previous round.
  auto& values = values_[round_ % 2];
  values[lane] = value;
  swapcontext(&contexts_[stack_of_[lane]], &caller_);
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
