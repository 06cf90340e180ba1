#include "voxdag/core/io/process_memory.hpp"

#include <emscripten/heap.h>

namespace voxdag {

MemoryBudget command_budget(std::uint64_t limit) {
  return MemoryBudget(limit != 0 ? limit : default_memory_limit(), resident_bytes());
}

std::uint64_t default_memory_limit() {
  return static_cast<std::uint64_t>(emscripten_get_heap_max()) / 8 * 7;
}

std::optional<std::uint64_t> cgroup_memory_limit(const std::filesystem::path&) {
  return std::nullopt;
}

std::uint64_t resident_bytes() { return *emscripten_get_sbrk_ptr(); }

std::uint64_t peak_resident_bytes() { return emscripten_get_heap_size(); }

}  // namespace voxdag
