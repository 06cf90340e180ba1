#include "voxdag/stored/wire/wire_values.hpp"

#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/random_pages.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"
#include "voxdag/stored/attributes/validate_pages.hpp"

namespace voxdag::wire {
namespace {

ValuePages decode(const WireValues& wire, const ValuePages& like, ValueKind kind) {
  ValuePages pages;
  pages.values = like.values;
  pages.precision = like.precision;
  pages.groups.resize(like.groups.size());
  pages.pages.resize(like.pages.size());
  pages.words.resize(like.words.size());
  decode_wire_values(wire.segments, wire.bytes, like.precision, kind,
                     {pages.groups.data(), pages.pages.data(), pages.words.data(),
                      pages.words.size(), pages.values});
  return pages;
}

TEST(WireValues, DecodingGivesThePagesBack) {
  for (int precision = 0; precision <= PagePrecision::kMaxCode; ++precision)
    for (const ValueKind kind : {ValueKind::kColor, ValueKind::kNormal})
      for (const std::uint64_t values : {1u, 256u, 257u, 40'000u, 300'000u})
        for (const double busy : {0.0, 0.1, 1.0}) {
          const ValuePages pages = random_pages(values, precision, 7, busy);
          validate_value_pages(pages.view());
          const WireValues wire = encode_wire_values(pages.view(), kind);
          EXPECT_EQ(wire.segments.size(), (values + 262'143) / 262'144);
          const ValuePages again = decode(wire, pages, kind);
          EXPECT_EQ(again.words, pages.words);
          EXPECT_EQ(again.pages, pages.pages);
          EXPECT_EQ(again.groups, pages.groups);
        }
}

TEST(WireValues, DecodingGivesMaterialIdsBack) {
  for (const std::uint32_t materials : {1u, 2u, 25u, 65'535u})
    for (const std::uint64_t values : {1u, 256u, 257u, 40'003u, 300'000u})
      for (const double busy : {0.0, 0.02, 0.5}) {
        std::mt19937 rng(3);
        MaterialEncoder encoder(materials);
        std::uint32_t id = 0;
        for (std::uint64_t i = 0; i < values; ++i) {
          if (std::bernoulli_distribution(busy)(rng))
            id = static_cast<std::uint32_t>(rng() % materials);
          encoder.add(id, 1);
        }
        const MaterialIds pages = encoder.finish();
        const WireValues wire = encode_wire_materials(pages.view());
        MaterialIds again;
        again.groups.resize(pages.groups.size());
        again.pages.resize(pages.pages.size());
        again.words.resize(pages.words.size());
        decode_wire_materials(wire.segments, wire.bytes, materials,
                              {again.groups.data(), again.pages.data(), again.words.data(),
                               again.words.size(), values});
        EXPECT_EQ(again.words, pages.words);
        EXPECT_EQ(again.pages, pages.pages);
        EXPECT_EQ(again.groups, pages.groups);
      }
}

/// The example of docs/format.md.
TEST(WireValues, APageOfOneBlockHasTheBytesOfTheExample) {
  ValuePages pages;
  pages.values = 256;
  pages.add_page(0);
  pages.words = {pages.precision.pack_header({ValueBlock::kFlat, 256}) |
                 4 << pages.precision.header_bits()};
  const WireValues wire = encode_wire_values(pages.view(), ValueKind::kColor);
  const std::vector<std::byte> expected = {std::byte{0x00}, std::byte{0xE0}, std::byte{0x7F},
                                           std::byte{0x7F}, std::byte{0x80}, std::byte{0x00},
                                           std::byte{0x00}, std::byte{0x00}};
  EXPECT_EQ(wire.bytes, expected);
  EXPECT_EQ(wire.segments.at(0).page_end, 4u);
}

TEST(WireValues, WhatRepeatsTakesFewBytes) {
  const ValuePages still = random_pages(100'000, 1, 3, 0), busy = random_pages(100'000, 1, 3, 1);
  const auto bytes = [](const ValuePages& pages) {
    return encode_wire_values(pages.view(), ValueKind::kColor).bytes.size();
  };
  EXPECT_LT(bytes(still), 8 * still.words.size() / 2);
  // Random bits cannot be shortened, and take little more.
  EXPECT_LT(bytes(busy), 8 * busy.words.size() * 101 / 100);
}

TEST(WireValues, DamagedBytesAreRefusedOrSafeToValidate) {
  const ValuePages pages = random_pages(2'000, 1, 5, 0.3);
  const WireValues good = encode_wire_values(pages.view(), ValueKind::kColor);
  int refused = 0;
  for (std::size_t bit = 0; bit < 8 * good.bytes.size(); ++bit) {
    WireValues wire = good;
    wire.bytes[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
    try {
      const ValuePages again = decode(wire, pages, ValueKind::kColor);
      validate_value_pages(again.view());
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, static_cast<int>(7 * good.bytes.size()));
  for (std::size_t cut = 0; cut < good.bytes.size(); ++cut) {
    WireValues wire = good;
    wire.bytes.resize(cut);
    wire.segments[0].coded_end = cut;
    EXPECT_NE(error_of([&] { decode(wire, pages, ValueKind::kColor); }), "no error");
  }
}

TEST(WireValues, WrongSegmentsAreRefused) {
  const ValuePages pages = random_pages(300'000, 2, 5, 0.3);
  const WireValues good = encode_wire_values(pages.view(), ValueKind::kNormal);
  const auto error = [&](auto change) {
    WireValues wire = good;
    change(wire);
    return error_of([&] { decode(wire, pages, ValueKind::kNormal); });
  };
  EXPECT_EQ(error([](WireValues&) {}), "no error");
  EXPECT_EQ(error([](WireValues& wire) { wire.segments.pop_back(); }),
            "has 1 segments instead of 2");
  EXPECT_EQ(error([](WireValues& wire) { wire.segments[1].coded_end += 1; }),
            "segment 1 ends outside of the coded bytes");
  EXPECT_EQ(error([](WireValues& wire) { wire.segments[0].coded_end = wire.bytes.size() + 9; }),
            "segment 0 ends outside of the coded bytes");
  EXPECT_EQ(error([](WireValues& wire) { wire.segments[0].page_end = std::uint64_t{1} << 63; }),
            "segment 0 has pages outside of the words");
  EXPECT_EQ(error([](WireValues& wire) { wire.bytes.push_back({}); }),
            "has bytes after its last segment");
}

}  // namespace
}  // namespace voxdag::wire
