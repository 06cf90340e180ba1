#include "voxdag/stored/attributes/join_page.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "support/random_pages.hpp"
#include "voxdag/stored/attributes/validate_pages.hpp"
#include "voxdag/stored/attributes/value_encoder.hpp"

namespace voxdag {
namespace {

constexpr std::array<int, 3> kWeights{2, 4, 1};

/// Values and where they come from: a number of the source, or a value of their own.
struct Origin {
  std::int64_t number = -1;
  Value8 value{};
};

/// Encodes values in runs of copied and of new ones, in a random order.
ValuePages encode(const std::vector<Origin>& origins, const ValuePagesView& from,
                  PagePrecision precision, std::mt19937& rng, bool* rounds_copies = nullptr) {
  ValueEncoder encoder(origins.size(), make_value_metric(kWeights, 0), precision, nullptr);
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const bool goes_on =
        i > 0 && (origins[i].number < 0 ? origins[i - 1].number < 0
                                        : origins[i - 1].number >= 0 &&
                                              origins[i].number == origins[i - 1].number + 1);
    if (!goes_on) runs.emplace_back(i, 0);
    ++runs.back().second;
  }
  std::shuffle(runs.begin(), runs.end(), rng);
  for (const auto& [first, count] : runs) {
    if (origins[first].number >= 0) {
      encoder.copy(first, count, from, static_cast<std::uint64_t>(origins[first].number));
      continue;
    }
    std::vector<Value8> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(origins[first + i].value);
    encoder.add(first, values);
  }
  if (rounds_copies != nullptr) *rounds_copies = encoder.rounds_copies();
  return encoder.finish();
}

Value8 rounded(Value8 value, PagePrecision precision) {
  Value8 nearest{};
  for (int c = 0; c < 3; ++c) {
    int least = 256;
    for (std::uint64_t field = 0; field < 1u << precision.channel_bits(c); ++field) {
      std::uint64_t end = field;
      for (int before = 0; before < c; ++before) end <<= precision.channel_bits(before);
      const std::uint8_t stored = precision.unpack(end)[c];
      if (std::abs(stored - value[c]) < least) {
        least = std::abs(stored - value[c]);
        nearest[c] = stored;
      }
    }
  }
  return nearest;
}

TEST(JoinPage, KeepsCopiedValuesAndRoundsNewOnes) {
  for (int code = 0; code <= PagePrecision::kMaxCode; ++code) {
    std::mt19937 rng(static_cast<unsigned>(code));
    const ValuePages source = random_pages(5000, code, 3, 0.3);
    const PagePrecision precision = joined_precision({{{code}}});
    EXPECT_EQ(precision.bits(), source.precision.bits());
    std::vector<Origin> origins;
    while (origins.size() < 20000) {
      const bool copies = rng() % 3 != 0;
      const std::size_t count = 1 + rng() % (copies ? 600 : 40);
      const auto first = static_cast<std::int64_t>(rng() % (5000 - count));
      const auto value = [&] { return static_cast<std::uint8_t>(rng() % 3 * 100); };
      for (std::size_t i = 0; i < count; ++i)
        origins.push_back(copies ? Origin{first + static_cast<std::int64_t>(i), {}}
                                 : Origin{-1, {value(), value(), value()}});
    }
    const ValuePages pages = encode(origins, source.view(), precision, rng);
    validate_value_pages(pages.view());
    for (std::size_t i = 0; i < origins.size(); ++i)
      ASSERT_EQ(read_value(pages.view(), i),
                origins[i].number >= 0
                    ? read_value(source.view(), static_cast<std::uint64_t>(origins[i].number))
                    : rounded(origins[i].value, precision))
          << i << ", precision " << code;
    EXPECT_EQ(encode(origins, source.view(), precision, rng).words, pages.words);
  }
}

TEST(JoinPage, KeepsValuesOfPagesWithOtherPrecisions) {
  for (int code = 0; code <= PagePrecision::kMaxCode; ++code) {
    const ValuePages source = random_pages(256, code, 3, 0.5);
    const PagePrecision precision = joined_precision({{{code}, {(code + 1) % 4}}});
    EXPECT_EQ(precision.bits(), 24);
    const CopiedValues all{0, kPageValues, source.view(), 0};
    const EncodedPage page =
        join_page({}, {&all, 1}, kPageValues, make_value_metric(kWeights, 0), precision);
    const std::uint64_t group = 0;
    const std::uint16_t begin = 0;
    const ValuePagesView view{{&group, &begin, page.words.data(), page.words.size(), 256},
                              precision};
    for (std::uint64_t i = 0; i < 256; ++i)
      ASSERT_EQ(read_value(view, i), read_value(source.view(), i));
  }
}

TEST(JoinPage, PagesDoNotGrowHoweverOftenTheirValuesMove) {
  std::mt19937 rng(1);
  ValuePages pages = random_pages(20000, 0, 5, 0.3);
  const std::size_t before = pages.words.size();
  std::size_t once = 0;
  for (int i = 0; i < 40; ++i) {
    // A value is lost at the begin, and one is new at the end.
    std::vector<Origin> origins;
    for (std::int64_t k = 1; k < 20000; ++k) origins.push_back({k, {}});
    origins.push_back({});
    pages = encode(origins, pages.view(), joined_precision({{pages.precision}}), rng);
    if (i == 0) once = pages.words.size();
  }
  EXPECT_LT(once, before * 112 / 100);
  EXPECT_LT(pages.words.size(), once * 103 / 100);
}

TEST(JoinPage, StoresEachValueWhereThePageWouldBeTooLong) {
  std::mt19937 rng(1);
  const ValuePages source = random_pages(20000, 0, 5, 1);
  std::vector<Origin> origins;
  for (std::int64_t i = 0; i < 10000; ++i)
    origins.push_back({static_cast<std::int64_t>(rng() % 20000), {}});
  for (const int code : {source.precision.code, 3}) {
    const PagePrecision precision = joined_precision({{{code}}});
    const bool is_exact = code == 3;
    bool rounds_copies = is_exact;
    const ValuePages pages = encode(origins, source.view(), precision, rng, &rounds_copies);
    EXPECT_NE(rounds_copies, is_exact);
    validate_value_pages(pages.view());
    for (std::size_t i = 0; i < origins.size(); ++i) {
      const Value8 value = read_value(source.view(), static_cast<std::uint64_t>(origins[i].number));
      const Value8 stored = read_value(pages.view(), i);
      ASSERT_TRUE(stored == value || (!is_exact && stored == rounded(value, precision))) << i;
    }
  }
}

}  // namespace
}  // namespace voxdag
