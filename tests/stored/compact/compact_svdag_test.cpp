// Tests the compact form: every DAG comes back, the same bits for any number of threads, and any
// bits are safe to read.
#include <gtest/gtest.h>
#include <sys/mman.h>

#include "support/brute_svdag.hpp"
#include "support/compact_walk.hpp"
#include "support/random_bits.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/stored/compact/compact_bytes.hpp"
#include "voxdag/stored/compact/compact_parts.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"

namespace voxdag {
namespace {

/// Voxels of a tilted plane, of which a part is repeated all over the grid.
std::vector<Vec3i> repeated_plane(int levels) {
  std::vector<Vec3i> voxels;
  const std::int32_t n = 1 << levels;
  for (std::int32_t y = 0; y < n; ++y)
    for (std::int32_t x = 0; x < n; ++x) {
      const std::int32_t z = (x % 32 * 3 + y % 64 * 5) / 8 % n;
      voxels.push_back({x, y, z});
      if (x / 16 % 2 == 0) voxels.push_back({x, y, n - 1 - z});
    }
  return voxels;
}

std::vector<Svdag> compact_examples() {
  std::vector<Svdag> dags;
  for (int levels = 2; levels <= 8; ++levels)
    for (const int count : {0, 1, 2, 30, 400, 5000})
      dags.push_back(
          brute_svdag(levels, random_voxels(levels, count, static_cast<unsigned>(count))));
  for (int levels = 4; levels <= 8; ++levels)
    dags.push_back(brute_svdag(levels, repeated_plane(levels)));
  dags.push_back(brute_svdag(kMaxLevels, {{0, 0, 0}, {1048575, 524288, 1}, {77, 77, 77}}));
  dags.push_back(brute_svdag(6, [] {
    std::vector<Vec3i> all;
    for (std::uint64_t i = 0; i < 64 * 64 * 64; ++i) all.push_back(morton_decode(i));
    return all;
  }()));
  return dags;
}

TEST(CompactSvdag, EveryDagComesBack) {
  for (const Svdag& dag : compact_examples()) {
    const CompactSvdag compact = encode_svdag(dag.view());
    EXPECT_EQ(compact.levels, dag.levels);
    EXPECT_EQ(decode_svdag(compact.view()), dag) << dag.levels << " levels";
  }
}

TEST(CompactSvdag, TheHeadComesBack) {
  for (const Svdag& dag : compact_examples()) {
    const CompactSvdag compact = encode_svdag(dag.view());
    const std::vector<std::byte> head = compact_head(compact);
    CompactSvdag read = parse_compact_head(head, dag.levels, compact.words().size());
    read.stream = compact.stream;
    EXPECT_EQ(decode_svdag(read.view()), dag);
    EXPECT_EQ(compact_head(read), head);
  }
}

TEST(CompactSvdag, TheWorkedExampleOfTheFormatHoldsTrue) {
  // docs/format.md, "A worked example"
  const Svdag dag = brute_svdag(4, {{0, 0, 0}, {15, 15, 15}});
  const CompactSvdag compact = encode_svdag(dag.view());
  EXPECT_EQ(compact.stream_bits, 6u);
  EXPECT_EQ(compact.stream, (std::vector<std::uint32_t>{0x4C000000u, 0}));
  const std::vector<std::byte> head = compact_head(compact);
  ASSERT_EQ(head.size(), 174u);
  EXPECT_EQ(std::to_integer<int>(head[0]), 0x03);
  EXPECT_EQ(std::to_integer<int>(head[172]), 0x10);
}

TEST(CompactSvdag, HasTheSameBitsForAnyNumberOfThreads) {
  const Svdag dag = brute_svdag(8, repeated_plane(8));
  const CompactSvdag compact = encode_svdag(dag.view());
  for (const std::size_t threads : {1u, 3u, 8u}) {
    const ThreadLimit limit(threads);
    const CompactSvdag again = encode_svdag(dag.view());
    EXPECT_EQ(again.stream, compact.stream);
    EXPECT_EQ(compact_head(again), compact_head(compact));
    EXPECT_EQ(decode_svdag(compact.view()), dag);
  }
}

TEST(CompactSvdag, FewerTablesGiveTheSameVoxels) {
  const Svdag dag = brute_svdag(8, repeated_plane(8));
  for (const int tables : {1, 16, kMaxTables})
    EXPECT_EQ(decode_svdag(encode_svdag(dag.view(), {.tables = tables}).view()), dag);
}

TEST(CompactSvdag, IsSmallerThanThePapersLayout) {
  const Svdag dag = brute_svdag(8, repeated_plane(8));
  const CompactSvdag compact = encode_svdag(dag.view());
  EXPECT_LT(compact.stream_bits / 8, dag.view().bytes() / 2);
}

TEST(CompactSvdag, ThePartsAddUp) {
  for (const Svdag& dag : compact_examples()) {
    const CompactSvdag compact = encode_svdag(dag.view());
    const CompactParts parts = compact_parts(compact.view());
    EXPECT_EQ(parts.node_bits + parts.unit_bits + parts.shared_brick_bits, compact.stream_bits);
  }
}

TEST(CompactSvdag, AnyStreamIsSafeToRead) {
  Random random(5);
  const Svdag dag = brute_svdag(8, repeated_plane(8));
  const CompactSvdag compact = encode_svdag(dag.view());
  int refused = 0;
  for (int round = 0; round < 600; ++round) {
    CompactSvdag broken = compact;
    if (round < 300) {
      const std::uint64_t bit = random() % compact.stream_bits;
      broken.stream[bit / 32] ^= 1u << bit % 32;
    } else {
      for (std::size_t i = 0; i + 1 < broken.stream.size(); ++i) broken.stream[i] = random();
    }
    ASSERT_TRUE(ranges_are_safe(broken.view(), 2000));
    try {
      decode_svdag(broken.view());
    } catch (const Error&) {
      ++refused;
    }
  }
  // Most random streams break off somewhere. A stream with one changed bit often codes other
  // voxels.
  EXPECT_GT(refused, 300);
}

TEST(CompactSvdag, EveryTruncatedOrChangedHeadIsRefusedOrHarmless) {
  const Svdag dag = brute_svdag(6, repeated_plane(6));
  const CompactSvdag compact = encode_svdag(dag.view());
  const std::vector<std::byte> head = compact_head(compact);
  for (std::size_t size = 0; size < head.size(); ++size)
    EXPECT_THROW(parse_compact_head(std::span(head).first(size), 6, compact.stream.size()), Error)
        << size << " bytes";
  for (std::size_t bit = 0; bit < head.size() * 8; ++bit) {
    std::vector<std::byte> changed = head;
    changed[bit / 8] ^= std::byte{1} << bit % 8;
    try {
      CompactSvdag read = parse_compact_head(changed, 6, compact.stream.size());
      read.stream = compact.stream;
      decode_svdag(read.view());
    } catch (const Error&) {
    }
  }
}

/// Zeroed memory. The system provides only the pages that are written.
class SparseWords {
 public:
  explicit SparseWords(std::size_t words) : bytes_(words * 4) {
    memory_ = ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  }
  ~SparseWords() { ::munmap(memory_, bytes_); }
  SparseWords(const SparseWords&) = delete;
  SparseWords& operator=(const SparseWords&) = delete;
  bool is_mapped() const { return memory_ != MAP_FAILED; }
  std::uint32_t* data() const { return static_cast<std::uint32_t*>(memory_); }

 private:
  std::size_t bytes_;
  void* memory_;
};

TEST(CompactSvdag, StreamsOfMoreThanFourGigabytesAreRead) {
  const Svdag dag = brute_svdag(8, repeated_plane(8));
  const CompactSvdag compact = encode_svdag(dag.view());
  // The stream lies behind more than 2^32 bytes that no node uses.
  constexpr std::size_t kWords = (std::size_t{1} << 30) + 12345;
  const SparseWords words(kWords + compact.stream.size());
  if (!words.is_mapped()) GTEST_SKIP() << "the system provides no 4 GiB of address space";
  std::copy(compact.stream.begin(), compact.stream.end(), words.data() + kWords);
  std::vector<std::uint64_t> begins = compact.shared_begin;
  for (std::uint64_t& begin : begins) begin += kWords * 32;
  CompactSvdagView view = compact.view();
  view.stream = words.data();
  view.stream_bits += kWords * 32;
  view.shared_begin = begins.data();
  EXPECT_TRUE(ranges_are_safe(view, 100'000));
  EXPECT_EQ(decode_svdag(view), dag);
}

TEST(CompactSvdag, AMemoryLimitIsKeptOrRefused) {
  const Svdag dag = brute_svdag(8, repeated_plane(8));
  MemoryBudget small(std::uint64_t{1} << 16);
  EXPECT_THROW(encode_svdag(dag.view(), {}, &small), OverMemory);
  EXPECT_EQ(small.used(), 0u);
  MemoryBudget large(std::uint64_t{1} << 30);
  const CompactSvdag compact = encode_svdag(dag.view(), {}, &large);
  EXPECT_EQ(large.used(), 0u);
  MemoryBudget tiny(1000);
  EXPECT_THROW(decode_svdag(compact.view(), &tiny), OverMemory);
  EXPECT_EQ(tiny.used(), 0u);
}

TEST(CompactSvdag, CanBeCancelled) {
  const Svdag dag = brute_svdag(8, repeated_plane(8));
  const CompactSvdag compact = encode_svdag(dag.view());
  Progress progress;
  progress.cancel();
  EXPECT_THROW(encode_svdag(dag.view(), {}, &progress), Cancelled);
  EXPECT_THROW(decode_svdag(compact.view(), &progress), Cancelled);
}

}  // namespace
}  // namespace voxdag
