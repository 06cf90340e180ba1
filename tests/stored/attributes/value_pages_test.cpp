#include "voxdag/stored/attributes/value_pages.hpp"

#include <gtest/gtest.h>

#include "support/damaged_pages.hpp"
#include "support/error_of.hpp"
#include "voxdag/stored/attributes/page_reader.hpp"
#include "voxdag/stored/attributes/validate_pages.hpp"

namespace voxdag {
namespace {

/// Writes pages bit by bit, as the header of value_pages.hpp describes them.
class HandWritten {
 public:
  HandWritten& add(std::uint64_t value, int bits) {
    for (int i = 0; i < bits; ++i, ++bit_) {
      if (bit_ % 64 == 0) pages_.words.push_back(0);
      pages_.words.back() |= (value >> i & 1) << bit_ % 64;
    }
    return *this;
  }
  HandWritten& header(int type, int length) {
    return add(static_cast<std::uint64_t>(type), 3)
        .add(static_cast<std::uint64_t>(length / 4 - 1), 6);
  }
  ValuePages one_page() {
    pages_.groups = {0};
    pages_.pages = {0};
    pages_.values = 256;
    return pages_;
  }

 private:
  ValuePages pages_;
  int bit_ = 0;
};

/// Ends of 5, 6 and 5 bits: a dark red and white.
constexpr std::uint64_t kRed = 1, kWhite = 0xFFFF;

TEST(ValuePages, EveryTypeOfBlockIsReadAsSpecified) {
  HandWritten page;
  page.header(0, 8).add(kRed, 16);
  page.header(1, 4).add(kRed, 16).add(9, 6).add(0b0110, 4);
  page.header(2, 4).add(kRed, 16).add(63, 6).add(0b11'10'01'00, 8);
  page.header(3, 4).add(kRed, 16).add(1, 6).add(0b111'000'001'100, 12);
  page.header(4, 4).add(kRed, 16).add(kWhite, 16).add(kRed, 16).add(0, 16);
  page.header(5, 4).add(kRed, 16).add(kWhite, 16).add(0b11'10'01'00, 8);
  page.header(6, 4).add(0, 16).add(kWhite, 16).add(0b111'000'001'100, 12);
  page.header(7, 4).add(0, 16).add(kWhite, 16).add(0xF810, 16);
  page.header(0, 220).add(kWhite, 16);
  const ValuePages pages = page.one_page();
  const Value8 red{8, 0, 0}, white{255, 255, 255};
  const std::vector<Value8> expected = {red,
                                        red,
                                        red,
                                        red,
                                        red,
                                        red,
                                        red,
                                        red,
                                        red,
                                        {48, 40, 40},
                                        {48, 40, 40},
                                        red,
                                        red,
                                        {90, 85, 85},
                                        {173, 170, 170},
                                        white,
                                        {13, 5, 5},
                                        {9, 1, 1},
                                        red,
                                        {16, 8, 8},
                                        red,
                                        white,
                                        red,
                                        {0, 0, 0},
                                        red,
                                        {90, 85, 85},
                                        {173, 170, 170},
                                        white,
                                        {146, 146, 146},
                                        {36, 36, 36},
                                        {0, 0, 0},
                                        white,
                                        {0, 0, 0},
                                        {17, 17, 17},
                                        {136, 136, 136},
                                        white,
                                        white};
  PageReader reader(pages.view());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(read_value(pages.view(), i), expected[i]) << i;
    EXPECT_EQ(reader.value(i), expected[i]) << i;
  }
  EXPECT_EQ(read_value(pages.view(), 255), white);
  EXPECT_EQ(reader.value(255), white);
  EXPECT_NO_THROW(validate_value_pages(pages.view()));
}

TEST(ValuePages, EndsRepeatTheirHighestBits) {
  EXPECT_EQ((PagePrecision{0}.unpack(0xFFFF)), (Value8{255, 255, 255}));
  EXPECT_EQ((PagePrecision{0}.unpack(16 | 32 << 5 | 1 << 11)), (Value8{132, 130, 8}));
  EXPECT_EQ((PagePrecision{1}.unpack(32 | 1 << 6 | 63 << 12)), (Value8{130, 4, 255}));
  EXPECT_EQ((PagePrecision{2}.unpack(64 | 1 << 7 | 127 << 14)), (Value8{129, 2, 255}));
  EXPECT_EQ((PagePrecision{3}.unpack(1 | 2 << 8 | 255 << 16)), (Value8{1, 2, 255}));
}

ValuePages small_page() {
  HandWritten page;
  page.header(2, 16).add(kRed, 16).add(63, 6).add(0x12345678, 32);
  page.header(0, 240).add(kWhite, 16);
  return page.one_page();
}

TEST(ValuePages, EveryFlippedBitIsRefusedOrSafeToRead) {
  const int refused = refused_bit_flips(small_page(), validate_value_pages,
                                        [](const ValuePages& pages, std::size_t) {
                                          for (std::uint64_t i = 0; i < pages.values; ++i)
                                            read_value(pages.view(), i);
                                        });
  EXPECT_GT(refused, 20);  // lengths and padding
}

TEST(ValuePages, TablesThatPointElsewhereAreRefused) {
  const auto refused = [](const auto& change) {
    ValuePages pages = small_page();
    change(pages);
    EXPECT_NE(error_of([&] { validate_value_pages(pages.view()); }), "no error");
  };
  refused([](ValuePages& pages) { pages.groups[0] = 1; });
  refused([](ValuePages& pages) { pages.groups[0] = ~std::uint64_t{0}; });
  refused([](ValuePages& pages) { pages.pages[0] = 1; });
  refused([](ValuePages& pages) { pages.words.push_back(0); });
  refused([](ValuePages& pages) { pages.words.pop_back(); });
  refused([](ValuePages& pages) { pages.precision.code = 4; });
  refused([](ValuePages& pages) { pages.precision.code = 3; });
}

/// A group begins with its first page, so the offset of that page is 0.
TEST(ValuePages, AGroupThatBeginsBeforeItsFirstPageIsRefused) {
  HandWritten words;
  for (int page = 0; page < 65; ++page) words.header(0, 256).add(kWhite, 16).add(0, 7);
  ValuePages pages = words.one_page();
  pages.values = 65 * 256;
  pages.groups = {0, 64 * 4};
  pages.pages.clear();
  for (int page = 0; page < 65; ++page)
    pages.pages.push_back(static_cast<std::uint16_t>(page % 64 * 4));
  ASSERT_NO_THROW(validate_value_pages(pages.view()));
  pages.groups[1] -= 4;
  pages.pages[64] += 4;
  EXPECT_NE(error_of([&] { validate_value_pages(pages.view()); }), "no error");
}

}  // namespace
}  // namespace voxdag
