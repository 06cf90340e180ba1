#include "voxdag/stored/attributes/channels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/error_of.hpp"
#include "support/with_threads.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"
#include "voxdag/stored/attributes/validate_channels.hpp"

namespace voxdag {
namespace {

constexpr ChannelKind kKinds[] = {ChannelKind::kU8, ChannelKind::kU16, ChannelKind::kI16,
                                  ChannelKind::kI32, ChannelKind::kF32};

std::vector<std::int32_t> codes_of(ChannelKind kind, const std::vector<double>& values) {
  std::vector<std::int32_t> codes;
  for (const double value : values) codes.push_back(channel_code(kind, value));
  return codes;
}

CellChannels channels_of(const std::vector<ChannelSpec>& specs,
                         const std::vector<std::vector<double>>& values) {
  std::vector<EncodedChannel> channels;
  for (std::size_t i = 0; i < specs.size(); ++i)
    channels.push_back(encode_channel(specs[i], codes_of(specs[i].kind, values[i])));
  return join_channels(values[0].size(), channels);
}

/// Returns values of a kind: small steps, jumps over the whole range, and both ends of the range.
std::vector<double> random_values(ChannelKind kind, std::size_t count) {
  std::mt19937 rng(static_cast<unsigned>(count));
  const ChannelRange range = range_of(kind);
  std::vector<double> values{range.least, range.most};
  double value = 0;
  while (values.size() < count) {
    if (kind == ChannelKind::kF32)
      value = rng() % 300 == 0 ? float_of_code(static_cast<std::int32_t>(rng() % kMaxFloatCode))
                               : value + static_cast<double>(rng() % 1000) / 7 - 70;
    else if (rng() % 300 == 0)
      value = std::floor(range.least +
                         (range.most - range.least) * (static_cast<double>(rng()) / 4294967296.0));
    else
      value += static_cast<double>(rng() % 5) - 2;
    value = std::clamp(value, range.least, range.most);
    if (kind == ChannelKind::kF32) value = static_cast<double>(static_cast<float>(value));
    values.push_back(value);
  }
  values.resize(count);
  return values;
}

TEST(Channels, EveryValueOfEveryKindIsReadBack) {
  for (const ChannelKind kind : kKinds)
    for (const std::size_t count : {1u, 2u, 255u, 256u, 257u, 70000u}) {
      const std::vector<double> values = random_values(kind, count);
      const CellChannels packed = channels_of({{"a", kind, 0}}, {values});
      const ChannelsView view = validate_channels(packed.words, count);
      EXPECT_EQ(view.bytes(), 8 * packed.words.size());
      const ChannelView channel = view[view.find("a")];
      double least = HUGE_VAL, most = -HUGE_VAL;
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(channel.read(i), values[i]) << name_of(kind) << " " << i << " of " << count;
        least = std::min(least, values[i]);
        most = std::max(most, values[i]);
      }
      EXPECT_EQ(range_of(channel).least, least);
      EXPECT_EQ(range_of(channel).most, most);
    }
}

TEST(Channels, CodesOfFloatsHaveTheirOrder) {
  const float values[] = {-3.4e38f, -1.0f, -1e-45f, -0.0f, 0.0f, 1e-45f, 1.0f, 3.4e38f};
  for (std::size_t i = 0; i + 1 < std::size(values); ++i)
    EXPECT_LT(code_of_float(values[i]), code_of_float(values[i + 1]));
  for (const float value : values)
    EXPECT_EQ(std::bit_cast<std::int32_t>(float_of_code(code_of_float(value))),
              std::bit_cast<std::int32_t>(value));
  EXPECT_EQ(code_of_float(std::numeric_limits<float>::max()), kMaxFloatCode);
  EXPECT_EQ(code_of_float(-std::numeric_limits<float>::max()), -kMaxFloatCode - 1);
}

/// In long double, the difference of these floats is exact.
TEST(Channels, NoValueDiffersByMoreThanTheBound) {
  for (const double bound : {1.2e-38, 1e-6, 0.1, 0.5, 3.0, 1e30})
    for (const std::size_t count : {256u, 5000u}) {
      std::vector<double> values = random_values(ChannelKind::kF32, count);
      for (std::size_t i = 300; i < count; ++i)  // halves: often just at the bound
        values[i] = std::floor(values[i] * 2) / 2;
      const CellChannels packed = channels_of({{"a", ChannelKind::kF32, bound}}, {values});
      const ChannelView channel = validate_channels(packed.words, count)[0];
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_LE(std::abs(static_cast<long double>(channel.read(i)) -
                           static_cast<long double>(static_cast<float>(values[i]))),
                  static_cast<long double>(bound))
            << i;
    }
}

TEST(Channels, ABoundMakesSmallNumbers) {
  std::vector<double> values;
  for (int i = 0; i < 256; ++i) values.push_back(i / 255.0);
  const CellChannels packed = channels_of({{"a", ChannelKind::kF32, 0.5 / 255}}, {values});
  const ChannelBlock block = packed.view()[0].block(0);
  EXPECT_EQ(block.width, 8);
  EXPECT_FALSE(block.is_exact);
  // Stored values stay as they are when they are packed again.
  std::vector<double> again;
  for (std::uint64_t i = 0; i < 256; ++i) again.push_back(packed.view()[0].read(i));
  EXPECT_EQ(channels_of({{"a", ChannelKind::kF32, 0.5 / 255}}, {again}).words, packed.words);
}

/// The example of docs/format.md.
TEST(Channels, FourTemperatures) {
  const CellChannels packed =
      channels_of({{"temperature", ChannelKind::kI16, 0}}, {{-3, -1, 2, -3}});
  EXPECT_EQ(packed.words.size(), 8u + 16 + 2 + 1);
  EXPECT_EQ(packed.words[24], 0u);
  EXPECT_EQ(packed.words[25], 0x3FFFFFFFDu);
  EXPECT_EQ(packed.words[26], 0x150u);
}

TEST(Channels, ValuesThatAKindDoesNotHaveAreRefused) {
  EXPECT_EQ(error_of([] { channel_code(ChannelKind::kU8, 256); }),
            "has the value 256, and the kind u8 has finite numbers from 0 to 255");
  for (const ChannelKind kind : kKinds) {
    EXPECT_NE(error_of([&] { channel_code(kind, std::nan("")); }), "no error");
    EXPECT_NE(error_of([&] { channel_code(kind, HUGE_VAL); }), "no error");
  }
  EXPECT_EQ(channel_code(ChannelKind::kI16, -2.5), -2);
  EXPECT_EQ(channel_code(ChannelKind::kI16, 2.5), 3);
}

TEST(Channels, WrongNamesBoundsAndCountsAreRefused) {
  const std::vector<std::int32_t> codes{1};
  for (const char* name : {"", "a b", "a/b", "\xC3\xA9"})
    EXPECT_NE(error_of([&] { encode_channel({name, ChannelKind::kU8, 0}, codes); }), "no error");
  EXPECT_NE(error_of([&] {
              encode_channel({std::string(64, 'a'), ChannelKind::kU8, 0}, codes);
            }),
            "no error");
  EXPECT_NE(error_of([&] { encode_channel({"a", ChannelKind::kU8, 1}, codes); }), "no error");
  for (const double bound : {-1.0, -0.0, 1e-320, 1e-38, 1e39, HUGE_VAL, std::nan("")})
    EXPECT_NE(error_of([&] {
                encode_channel({"a", ChannelKind::kF32, bound}, codes);
              }),
              "no error")
        << bound;
  const EncodedChannel one = encode_channel({"a", ChannelKind::kU8, 0}, codes);
  EXPECT_EQ(error_of([&] {
              join_channels(1, std::vector{one, one});
            }),
            "has two channels with the name 'a'");
  EXPECT_EQ(error_of([&] { join_channels(1, std::vector(17, one)); }),
            "has 17 channels, and at most 16 are stored");
}

TEST(Channels, TheNumberOfThreadsDoesNotMatter) {
  const std::vector<std::int32_t> codes =
      codes_of(ChannelKind::kF32, random_values(ChannelKind::kF32, 100000));
  const ChannelSpec spec{"a", ChannelKind::kF32, 0.01};
  const auto words = [&] { return encode_channel(spec, codes).words; };
  EXPECT_EQ(with_threads(1, words), with_threads(4, words));
}

/// A flipped bit is refused, or gives other values that are safe to read.
TEST(Channels, EveryFlippedBitIsRefusedOrGivesValuesOfTheKind) {
  const std::vector<ChannelSpec> specs{{"intensity", ChannelKind::kU8, 0},
                                       {"heat", ChannelKind::kF32, 0.25},
                                       {"exact", ChannelKind::kF32, 0}};
  std::vector<std::vector<double>> values;
  for (const ChannelSpec& spec : specs) values.push_back(random_values(spec.kind, 300));
  const CellChannels packed = channels_of(specs, values);
  int refused = 0, accepted = 0;
  // All bits of the header and the entries, and one in 5 of the others.
  for (std::size_t bit = 0; bit < 64 * packed.words.size(); bit += bit < 64 * 60 ? 1 : 5) {
    CellChannels changed = packed;
    changed.words[bit / 64] ^= std::uint64_t{1} << bit % 64;
    try {
      const ChannelsView view = validate_channels(changed.words, 300);
      ++accepted;
      for (std::size_t c = 0; c < view.count(); ++c)
        for (std::uint64_t i = 0; i < 300; ++i) {
          const ChannelRange range = range_of(view[c].kind);
          ASSERT_GE(view[c].read(i), range.least);
          ASSERT_LE(view[c].read(i), range.most);
        }
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(accepted, 100);
  for (std::size_t words = 0; words < packed.words.size(); ++words)
    EXPECT_NE(error_of([&] { validate_channels(std::span(packed.words).first(words), 300); }),
              "no error");
  EXPECT_NE(error_of([&] { validate_channels(packed.words, 301); }), "no error");
}

}  // namespace
}  // namespace voxdag
