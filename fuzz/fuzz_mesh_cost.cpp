/// Fuzzes the cost of the mesh readers. Fails if a reader takes more instructions, per byte of the
/// file and of its memory, than the limits below. The first byte chooses the reader, as in
/// fuzz_mesh. Larger inputs find more: run it with -max_len=65536, and with -timeout=60 to find
/// endless loops.
#include <tbb/global_control.h>

#include <cstdio>
#include <cstdlib>

#include "mesh_readers.hpp"
#include "work_counter.hpp"

namespace {

/// Limits on instructions with sanitizers, which take about ten times as many as without.
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
  MemoryBudget memory(kMemoryBytes);  // Bounds the size of instanced glTF meshes.
  MeshSource source{bytes, "fuzz", {}, nullptr, {}};
  source.options.work = &memory;
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
