#include "voxdag/stored/compact/symbol_coder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "support/random_bits.hpp"
#include "voxdag/stored/compact/adaptive_bits.hpp"
#include "voxdag/stored/compact/context_tree.hpp"

namespace voxdag {
namespace {

struct Coded {
  std::uint32_t start, frequency;  ///< A frequency of 0 marks a raw number of `start` bits.
  std::uint32_t value;
};

std::vector<Coded> random_symbols(Random& random, std::size_t count) {
  std::vector<Coded> symbols;
  for (std::size_t i = 0; i < count; ++i) {
    if (random() % 4 == 0) {
      const std::uint32_t bits = random() % 33;
      const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
      symbols.push_back({bits, 0, static_cast<std::uint32_t>(random() & mask)});
    } else {
      const std::uint32_t frequency = random() % 8 == 0 ? 4096 : 1 + random() % 4095;
      symbols.push_back({static_cast<std::uint32_t>(random() % (4097 - frequency)), frequency, 0});
    }
  }
  return symbols;
}

void put(const std::vector<Coded>& symbols, SymbolWriter& out) {
  for (const Coded& s : symbols) {
    if (s.frequency == 0) {
      out.put_raw(s.value, static_cast<int>(s.start));
    } else {
      out.put(s.start, s.frequency);
    }
  }
}

void expect(const std::vector<Coded>& symbols, SymbolReader& in) {
  for (const Coded& s : symbols) {
    if (s.frequency == 0) {
      ASSERT_EQ(in.take_raw(static_cast<int>(s.start)), s.value);
    } else {
      ASSERT_GE(in.code(), s.start * in.unit());
      ASSERT_LT(in.code(), (s.start + s.frequency) * in.unit());
      in.take(s.start, s.frequency);
    }
  }
}

TEST(SymbolCoder, ClosedRecordsGiveBackTheirSymbols) {
  Random random(1);
  SymbolWriter writer;
  for (int round = 0; round < 2000; ++round) {
    const std::vector<Coded> symbols = random_symbols(random, random() % 40);
    BitWriter bits;
    bits.put(random() & 0x1FFF, 13);
    put(symbols, writer);
    writer.close(bits);
    const std::uint64_t end = bits.bits();
    bits.put(random() & 0x7FFFFFFF, 31);
    const std::vector<std::uint32_t> words = bits.finish();
    SymbolReader reader(words.data(), 13, end);
    expect(symbols, reader);
    EXPECT_TRUE(reader.is_finished());
  }
}

TEST(SymbolCoder, OpenRecordsDoNotNeedTheirEnd) {
  Random random(2);
  SymbolWriter writer;
  for (int round = 0; round < 2000; ++round) {
    const std::vector<Coded> symbols = random_symbols(random, random() % 40);
    BitWriter bits;
    put(symbols, writer);
    writer.leave_open(bits);
    const std::uint64_t end = bits.bits();
    bits.put(random(), 32);
    const std::uint64_t stream_end = bits.bits();
    const std::vector<std::uint32_t> words = bits.finish();
    SymbolReader reader(words.data(), 0, stream_end);
    expect(symbols, reader);
    EXPECT_EQ(reader.open_end(), end);
  }
}

TEST(SymbolCoder, CarriesReachAllBitsBefore) {
  // Halves that begin at part 2047 of 4096 make the digits a run of ones. The last symbol sends a
  // carry through all of them.
  for (int symbols = 1; symbols < 300; ++symbols) {
    SymbolWriter writer;
    BitWriter bits;
    for (int i = 0; i < symbols; ++i) writer.put(2047, 2048);
    writer.put(4095, 1);
    writer.leave_open(bits);
    const std::uint64_t end = bits.bits();
    const std::vector<std::uint32_t> words = bits.finish();
    SymbolReader reader(words.data(), 0, end);
    std::vector<Coded> expected(static_cast<std::size_t>(symbols), {2047, 2048, 0});
    expected.push_back({4095, 1, 0});
    expect(expected, reader);
  }
}

TEST(SymbolCoder, SymbolsThatAreCertainTakeNoBits) {
  BitWriter bits;
  SymbolWriter writer;
  for (int i = 0; i < 1000; ++i) writer.put(0, 4096);
  writer.close(bits);
  EXPECT_EQ(bits.bits(), 0u);
}

TEST(SymbolCoder, ARecordTakesTheBitsOfItsInformation) {
  // 300 symbols of 1/2 and 300 of 1/16 have 1500 bits.
  BitWriter bits;
  SymbolWriter writer;
  for (int i = 0; i < 300; ++i) {
    writer.put(2048, 2048);
    writer.put(256, 256);
  }
  writer.close(bits);
  EXPECT_GE(bits.bits(), 1490u);
  EXPECT_LE(bits.bits(), 1501u);
}

TEST(SymbolCoder, ShortRecordsWasteLessThanABit) {
  Random random(6);
  double wasted = 0;
  constexpr int kRounds = 4000;
  for (int round = 0; round < kRounds; ++round) {
    // The symbols come as often as their frequencies say.
    SymbolWriter writer;
    BitWriter bits;
    double information = 0;
    for (int i = 0; i < 6; ++i) {
      const bool first = random() % 4 != 0;
      writer.put(first ? 0 : 3072, first ? 3072 : 1024);
      information -= std::log2(first ? 0.75 : 0.25);
    }
    writer.close(bits);
    wasted += static_cast<double>(bits.bits()) - information;
  }
  EXPECT_LT(wasted / kRounds, 0.6);
}

TEST(SymbolCoder, AnyBitsAreSafeToRead) {
  Random random(3);
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::uint32_t> words(8);
    for (std::uint32_t& word : words) word = random();
    words.back() = 0;
    const std::uint64_t end = random() % 193, begin = random() % (end + 1);
    SymbolReader reader(words.data(), begin, end);
    // Sanitizers report reads outside the words.
    for (int i = 0; i < 100; ++i) {
      if (random() % 3 == 0) {
        reader.take_raw(static_cast<int>(random() % 33));
        continue;
      }
      const std::uint32_t frequency = 1 + random() % 4096;
      reader.take(random() % (4097 - frequency), frequency);
    }
  }
}

TEST(Frequencies, AddUpForAnyWeights) {
  Random random(4);
  for (int round = 0; round < 2000; ++round) {
    WeightCodes weights{};
    const std::size_t used = 1 + random() % 256;
    for (std::size_t s = 0; s < used; ++s)
      weights[s] =
          static_cast<std::uint8_t>(random() % 2 == 0 ? 1 : random() % (kMaxWeightCode + 1));
    weights[0] = 1;
    const Frequencies frequencies = frequencies_of(weights);
    std::uint32_t sum = 0;
    for (std::size_t s = 0; s < 256; ++s) {
      EXPECT_EQ(frequencies[s] != 0, weights[s] != 0);
      sum += frequencies[s];
    }
    EXPECT_EQ(sum, 4096u);
  }
}

TEST(Frequencies, FollowTheCounts) {
  std::array<std::uint32_t, 256> counts{};
  counts[7] = 3'000'000;
  counts[9] = 1'000'000;
  counts[200] = 1;
  const Frequencies frequencies = frequencies_of(weights_for(counts));
  EXPECT_NEAR(frequencies[7], 3072, 64);
  EXPECT_NEAR(frequencies[9], 1024, 64);
  EXPECT_GE(frequencies[200], 1);
}

TEST(AdaptiveBits, GiveBackWhatWasWritten) {
  std::mt19937_64 random(5);
  std::vector<std::uint64_t> values;
  for (int i = 0; i < 3000; ++i)
    values.push_back((random() & ((std::uint64_t{1} << 62) - 1)) >> random() % 62);
  AdaptiveBitWriter out;
  AdaptiveCount count;
  AdaptiveBit bit;
  for (const std::uint64_t value : values) {
    count.put(out, value);
    out.put(value % 7 == 0, bit);
  }
  const std::vector<std::byte> bytes = out.finish();
  AdaptiveBitReader in(bytes);
  AdaptiveCount read;
  AdaptiveBit read_bit;
  for (const std::uint64_t value : values) {
    EXPECT_EQ(read.get(in), value);
    EXPECT_EQ(in.get(read_bit), value % 7 == 0);
  }
  EXPECT_TRUE(in.is_at_end());
}

}  // namespace
}  // namespace voxdag
