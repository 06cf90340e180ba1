/// Fuzzes the cost of the mesh readers: fails if one takes more instructions per byte of the file
/// and of the memory that it may use than below. Like fuzz_mesh, it chooses the reader by the first
/// byte. Larger inputs show more: run it with -max_len=65536, and -timeout=60 for what never ends.
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>

#include "mesh_readers.hpp"
#include "work_counter.hpp"

namespace {

/// Instructions, with sanitizers, which take about ten times as many as without.
constexpr std::uint64_t kPerRun = 300'000'000, kPerInputByte = 200'000;
constexpr std::uint64_t kMemoryBytes = std::uint64_t{4} << 20;
constexpr std::uint64_t kPerMemoryByte = 1'000;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace voxdag;
  if (size == 0) return 0;
  static const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  static const WorkCounter counter;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  MemoryBudget memory(kMemoryBytes);  // Bounds what instances of glTF meshes may make.
  MeshSource source{bytes, "fuzz", {}, nullptr, {}};
  source.options.memory = &memory;
  const std::uint64_t start = counter.count();
  try {
    read_chosen_mesh(data[0], source);
  } catch (const Error&) {
  }
  const std::uint64_t work = counter.count() - start;
  if (work > kPerRun + kPerInputByte * size + kPerMemoryByte * memory.peak()) {
    std::fprintf(stderr, "%zu bytes of input and %llu of memory took %llu instructions\n", size,
                 static_cast<unsigned long long>(memory.peak()),
                 static_cast<unsigned long long>(work));
    std::abort();
  }
  return 0;
}
