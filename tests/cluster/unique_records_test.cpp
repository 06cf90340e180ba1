#include "voxdag/cluster/unique_records.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "voxdag/core/io/checksum.hpp"

namespace voxdag {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span<const char>(text));
}

TEST(UniqueRecords, NumberDifferentRecordsInTheirOrder) {
  MemoryBudget budget;
  {
    UniqueRecords records(&budget);
    std::map<std::string, std::uint64_t> expected;
    std::string all;
    std::mt19937 random(1);
    for (int i = 0; i < 20'000; ++i) {
      // Few lengths and letters, so that records repeat, and some begin alike.
      std::string text(1 + random() % 7, 'a');
      for (char& c : text) c = static_cast<char>('a' + random() % 4);
      const auto [found, is_new] = expected.try_emplace(text, expected.size());
      if (is_new) all += text;
      ASSERT_EQ(records.find_or_add(bytes_of(text), xxh3_64(bytes_of(text))), found->second);
    }
    EXPECT_EQ(records.count(), expected.size());
    const auto bytes = records.bytes();
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), all);
    EXPECT_GT(budget.used(), all.size());
  }
  EXPECT_EQ(budget.used(), 0u);
}

TEST(UniqueRecords, TellRecordsWithEqualHashesApart) {
  UniqueRecords records(nullptr);
  for (int round = 0; round < 2; ++round)
    for (std::uint64_t i = 0; i < 300; ++i)
      EXPECT_EQ(records.find_or_add(bytes_of(std::to_string(i)), 42), i);
}

}  // namespace
}  // namespace voxdag
