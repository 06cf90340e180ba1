#include "voxdag/core/io/mapped_arrays.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <numeric>
#include <thread>

#include "support/error_of.hpp"
#include "support/file_size_limit.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

using Numbers = StoredVector<std::uint32_t>;

TEST(MappedArrays, ArraysStartAtZeroAndKeepTheirValuesWhenTheirPagesAreReleased) {
  const TempDir dir;
  MappedArrays store(dir.path());
  Numbers numbers(100'000, &store);
  for (const std::uint32_t number : numbers) ASSERT_EQ(number, 0u);
  std::iota(numbers.begin(), numbers.end(), 7u);
  store.release();
  for (std::uint32_t i = 0; i < numbers.size(); ++i) ASSERT_EQ(numbers[i], i + 7);
  for (std::uint32_t i = 0; i < 100'000; ++i) numbers.push_back(i);
  store.release();
  EXPECT_EQ(numbers[99'999], 100'006u);
  EXPECT_EQ(numbers.back(), 99'999u);
}

TEST(MappedArrays, TheFolderStaysEmptyAndTheSpaceIsCounted) {
  const TempDir dir;
  MappedArrays store(dir.path());
  {
    const Numbers numbers(1000, &store);
    EXPECT_EQ(store.bytes(), 4000u);
    EXPECT_EQ(dir.count(), 0);
  }
  EXPECT_EQ(store.bytes(), 0u);
}

TEST(MappedArrays, VectorsMoveAndSwapWithTheirStoreAndCopyToTheHeap) {
  const TempDir dir;
  MappedArrays store(dir.path());
  Numbers first(1000, &store);
  first[999] = 5;
  const std::uint32_t* const memory = first.data();
  Numbers moved = std::move(first);
  EXPECT_EQ(moved.data(), memory);
  Numbers assigned;
  assigned = std::move(moved);
  EXPECT_EQ(assigned.data(), memory);
  EXPECT_EQ(assigned.get_allocator().store(), &store);

  const Numbers copy = assigned;
  Numbers copied;
  copied = assigned;
  EXPECT_EQ(copy, assigned);
  EXPECT_EQ(copied, assigned);
  EXPECT_EQ(copy.get_allocator().store(), nullptr);
  EXPECT_EQ(copied.get_allocator().store(), nullptr);

  copied.swap(assigned);
  EXPECT_EQ(copied.data(), memory);
  EXPECT_EQ(assigned.get_allocator().store(), nullptr);
  EXPECT_EQ(store.bytes(), 4000u);
}

TEST(MappedArrays, NewElementsOnTheHeapAreZero) {
  Numbers numbers(1000, 9u);
  numbers.clear();
  numbers.resize(1000);
  EXPECT_EQ(numbers, Numbers(1000, 0u));
}

TEST(MappedArrays, ThreadsWriteWhilePagesAreReleased) {
  const TempDir dir;
  MappedArrays store(dir.path());
  Numbers numbers(200'000, &store);
  std::atomic<bool> is_done = false;
  std::thread releasing([&] {
    while (!is_done) store.count_work(std::uint64_t{20} << 20);
  });
  for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
  is_done = true;
  releasing.join();
  for (std::uint32_t i = 0; i < numbers.size(); ++i) ASSERT_EQ(numbers[i], i);
}

TEST(MappedArrays, AFullDiskIsAnErrorThatNamesTheFolder) {
  const TempDir dir;
  MappedArrays store(dir.path());
  const FileSizeLimit limit(1 << 20);
  EXPECT_EQ(error_of([&] { Numbers(1 << 20, &store); }),
            dir.path().string() + ": cannot make a file of 4 MiB for an array: File too large");
  EXPECT_EQ(store.bytes(), 0u);
  EXPECT_EQ(dir.count(), 0);
}

TEST(MappedArrays, AMissingFolderIsAnErrorThatNamesIt) {
  const TempDir dir;
  MappedArrays store(dir / "none");
  EXPECT_EQ(error_of([&] { Numbers(10, &store); }),
            (dir / "none").string() +
                ": cannot make a file of 1 MiB for an array: No such file or directory");
}

}  // namespace
}  // namespace voxdag
