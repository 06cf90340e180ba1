#include "voxdag/cuda/memory.hpp"

#include <cstdio>
#include <string>

#include "voxdag/cuda/check.hpp"

namespace voxdag {
namespace {

std::string size_text(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f MiB", static_cast<double>(bytes) / (1 << 20));
  return text;
}

std::string current_device() {
  int index = 0;
  cudaDeviceProp properties{};
  if (cudaGetDevice(&index) != cudaSuccess ||
      cudaGetDeviceProperties(&properties, index) != cudaSuccess)
    return "CUDA device";
  return properties.name;
}

}  // namespace

void require_device_memory(std::uint64_t bytes, const char* what) {
  std::size_t free = 0, total = 0;
  check_cuda(cudaMemGetInfo(&free, &total), "querying the free memory");
  if (bytes <= free) return;
  throw Error(current_device(), "",
              std::string("out of memory: ") + what + " needs " + size_text(bytes) + ", but only " +
                  size_text(free) + " of " + size_text(total) + " are free");
}

void* allocate_device(std::uint64_t bytes, const char* what) {
  if (bytes == 0) return nullptr;
  require_device_memory(bytes, what);
  void* memory = nullptr;
  check_cuda(cudaMalloc(&memory, bytes), what);
  return memory;
}

void free_device(void* memory) noexcept { cudaFree(memory); }

void* allocate_pinned(std::uint64_t bytes, const char* what) {
  if (bytes == 0) return nullptr;
  void* memory = nullptr;
  check_cuda(cudaMallocHost(&memory, bytes), what);
  return memory;
}

void free_pinned(void* memory) noexcept { cudaFreeHost(memory); }

void copy_to_device(void* device, const void* host, std::uint64_t bytes) {
  if (bytes == 0) return;
  const char* doing = "copying to the device";
  check_cuda(cudaMemcpy(device, host, bytes, cudaMemcpyHostToDevice), doing);
  // cudaMemcpy may return before the last bytes arrive, and other streams would not wait for them.
  check_cuda(cudaStreamSynchronize(nullptr), doing);
}

void copy_to_host(void* host, const void* device, std::uint64_t bytes) {
  if (bytes == 0) return;
  check_cuda(cudaMemcpy(host, device, bytes, cudaMemcpyDeviceToHost), "copying from the device");
}

}  // namespace voxdag
