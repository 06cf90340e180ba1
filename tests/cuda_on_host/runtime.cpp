#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>

#include "cuda_on_host/device_work.hpp"
#include "cuda_on_host/host_device.hpp"

namespace {

using voxdag::begin_call, voxdag::end_call, voxdag::host_device;

cudaError_t last_error = cudaSuccess;

/// The pages of an array on the device. An inaccessible page follows them.
struct Pages {
  std::byte* first;
  std::size_t bytes;  // without the inaccessible page
  std::size_t wanted;
};
std::map<const void*, Pages>& device_memory() {
  static std::map<const void*, Pages> memory;
  return memory;
}

void protect(int access) {
  for (const auto& [address, pages] : device_memory()) mprotect(pages.first, pages.bytes, access);
}

/// Fills new memory with values other than zero; of large arrays only the beginning, to save time.
void fill_with_noise(void* memory, std::size_t bytes) {
  std::memset(memory, 0xA5, std::min(bytes, std::size_t{1} << 20));
}

std::size_t page_bytes() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }

/// Returns whether the bytes lie in one array of the device.
bool is_on_device(const void* address, std::size_t bytes) {
  const auto next = device_memory().upper_bound(address);
  if (next == device_memory().begin()) return false;
  const auto& [begin, pages] = *std::prev(next);
  const auto offset = static_cast<std::size_t>(static_cast<const std::byte*>(address) -
                                               static_cast<const std::byte*>(begin));
  return offset <= pages.wanted && bytes <= pages.wanted - offset;
}

cudaError_t copy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
  const bool is_up = kind == cudaMemcpyHostToDevice;
  if (!is_on_device(is_up ? to : from, bytes) || is_on_device(is_up ? from : to, 1))
    return cudaErrorInvalidValue;
  const voxdag::DeviceAtWork at_work;
  std::memcpy(to, from, bytes);
  return cudaSuccess;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

namespace voxdag {

HostDevice& host_device() {
  static HostDevice device;
  return device;
}

cudaError_t end_call(cudaError_t status) {
  if (status != cudaSuccess) last_error = status;
  return status;
}

cudaError_t begin_call() {
  std::optional<int>& succeeding = host_device().failing_call;
  if (!succeeding || (*succeeding)-- > 0) return cudaSuccess;
  succeeding.reset();
  return end_call(cudaErrorUnknown);
}

DeviceAtWork::DeviceAtWork() { protect(PROT_READ | PROT_WRITE); }
DeviceAtWork::~DeviceAtWork() { protect(PROT_NONE); }

}  // namespace voxdag

cudaError_t CUstream_st::add(std::function<cudaError_t()> step) {
  steps.push_back(std::move(step));
  return host_device().is_eager ? finish() : cudaSuccess;
}

cudaError_t CUstream_st::finish() {
  cudaError_t status = cudaSuccess;
  for (; !steps.empty() && status == cudaSuccess; steps.pop_front()) status = steps.front()();
  steps.clear();
  return status;
}

struct CUevent_st {
  /// The time of the event, once its step has run. The step can outlive the event.
  std::shared_ptr<std::optional<double>> seconds;
};

const char* cudaGetErrorString(cudaError_t error) {
  switch (error) {
    case cudaSuccess:
      return "no error";
    case cudaErrorInvalidValue:
      return "invalid argument";
    case cudaErrorMemoryAllocation:
      return "out of memory";
    case cudaErrorInvalidConfiguration:
      return "invalid configuration argument";
    case cudaErrorInsufficientDriver:
      return "CUDA driver version is insufficient";
    case cudaErrorNoDevice:
      return "no CUDA-capable device is detected";
    case cudaErrorInvalidDevice:
      return "invalid device ordinal";
    case cudaErrorNotReady:
      return "device not ready";
    case cudaErrorUnknown:
      break;
  }
  return "unknown error";
}

cudaError_t cudaGetLastError() { return std::exchange(last_error, cudaSuccess); }

cudaError_t cudaDriverGetVersion(int* version) {
  *version = host_device().driver_version;
  return cudaSuccess;
}

cudaError_t cudaGetDeviceCount(int* count) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  if (host_device().driver_version < CUDART_VERSION) return end_call(cudaErrorInsufficientDriver);
  *count = host_device().count;
  return end_call(*count == 0 ? cudaErrorNoDevice : cudaSuccess);
}

cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int device) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  if (device < 0 || device >= host_device().count) return end_call(cudaErrorInvalidDevice);
  std::snprintf(properties->name, sizeof properties->name, "the host");
  properties->totalGlobalMem = host_device().memory_bytes;
  properties->major = host_device().compute_capability / 10;
  properties->minor = host_device().compute_capability % 10;
  properties->multiProcessorCount = 1;
  return cudaSuccess;
}

cudaError_t cudaGetDevice(int* device) {
  *device = 0;
  return cudaSuccess;
}

cudaError_t cudaSetDevice(int device) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  return end_call(device < 0 || device >= host_device().count ? cudaErrorInvalidDevice
                                                              : cudaSuccess);
}

cudaError_t cudaMemGetInfo(std::size_t* free, std::size_t* total) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  *total = host_device().memory_bytes;
  *free = *total - host_device().device_bytes;
  return cudaSuccess;
}

cudaError_t cudaMalloc(void** memory, std::size_t bytes) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  voxdag::HostDevice& device = host_device();
  if (bytes > device.memory_bytes - device.device_bytes) return end_call(cudaErrorMemoryAllocation);
  const std::size_t page = page_bytes();
  Pages pages{nullptr, (bytes + page - 1) / page * page, bytes};
  void* const mapped =
      mmap(nullptr, pages.bytes + page, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (mapped == MAP_FAILED) return end_call(cudaErrorMemoryAllocation);
  pages.first = static_cast<std::byte*>(mapped);
  *memory = pages.first + (pages.bytes - (bytes + 15) / 16 * 16);
  device_memory().emplace(*memory, pages);
  device.device_bytes += bytes;
  ++device.device_arrays;
  const voxdag::DeviceAtWork at_work;
  fill_with_noise(*memory, bytes);
  return cudaSuccess;
}

cudaError_t cudaFree(void* memory) {
  const auto found = device_memory().find(memory);
  if (found == device_memory().end()) return end_call(cudaErrorInvalidValue);
  const std::size_t page = page_bytes();
  munmap(found->second.first, found->second.bytes + page);
  host_device().device_bytes -= found->second.wanted;
  --host_device().device_arrays;
  device_memory().erase(found);
  return cudaSuccess;
}

cudaError_t cudaMallocHost(void** memory, std::size_t bytes) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  *memory = std::malloc(bytes);
  if (*memory == nullptr) return end_call(cudaErrorMemoryAllocation);
  fill_with_noise(*memory, bytes);
  ++host_device().pinned_arrays;
  return cudaSuccess;
}

cudaError_t cudaFreeHost(void* memory) {
  std::free(memory);
  --host_device().pinned_arrays;
  return cudaSuccess;
}

cudaError_t cudaMemcpy(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  return end_call(copy(to, from, bytes, kind));
}

cudaError_t cudaMemcpyAsync(void* to, const void* from, std::size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t stream) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  return end_call(stream->add([=] { return copy(to, from, bytes, kind); }));
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* stream, unsigned /*flags*/) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  *stream = new CUstream_st;
  ++host_device().queues;
  return cudaSuccess;
}

cudaError_t cudaStreamDestroy(cudaStream_t stream) {
  delete stream;
  --host_device().queues;
  return cudaSuccess;
}

cudaError_t cudaStreamSynchronize(cudaStream_t stream) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  return end_call(stream == nullptr ? cudaSuccess : stream->finish());
}

cudaError_t cudaEventCreate(cudaEvent_t* event) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  *event = new CUevent_st;
  ++host_device().events;
  return cudaSuccess;
}

cudaError_t cudaEventDestroy(cudaEvent_t event) {
  delete event;
  --host_device().events;
  return cudaSuccess;
}

cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t stream) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  event->seconds = std::make_shared<std::optional<double>>();
  return end_call(stream->add([seconds = event->seconds] {
    *seconds = now();
    return cudaSuccess;
  }));
}

cudaError_t cudaEventElapsedTime(float* milliseconds, cudaEvent_t begin, cudaEvent_t end) {
  if (begin_call() != cudaSuccess) return cudaErrorUnknown;
  if (!begin->seconds || !end->seconds) return end_call(cudaErrorInvalidValue);
  if (!*begin->seconds || !*end->seconds) return end_call(cudaErrorNotReady);
  *milliseconds = static_cast<float>((**end->seconds - **begin->seconds) * 1e3);
  return cudaSuccess;
}
