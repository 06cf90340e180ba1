// The decompressor of LZF, against the text that was compressed.
#include "voxdag/formats/imports/points/lzf_stream.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "lzf_text.hpp"
#include "voxdag/formats/readers/chunks.hpp"

namespace voxdag {
namespace {

TEST(LzfStream, GivesTheTextBack) {
  std::mt19937 rng(1);
  for (const unsigned letters : {1u, 2u, 5u, 256u})
    for (const std::size_t size : {0u, 1u, 263u, 8'193u, 300'000u}) {
      std::string text;
      for (std::size_t i = 0; i < size; ++i)
        text += rng() % 50 == 0 || i < 20 ? static_cast<char>(rng() % letters)
                                          : text[i - 1 - rng() % 19];
      const std::string compressed = lzf_of(text);
      LzfStream stream(compressed);
      std::string back;
      for (std::size_t at = 0; at < size;) {
        const std::size_t step = std::min<std::size_t>(size - at, 1 + rng() % 9'000);
        if (rng() % 3 == 0) {
          stream.skip(step);
          back += text.substr(at, step);
        } else {
          std::string part(step, '?');
          stream.read(part.data(), step);
          back += part;
        }
        at += step;
      }
      EXPECT_EQ(back, text);
      EXPECT_THROW(stream.skip(1), Fault);
      EXPECT_LE(size, compressed.size() * LzfStream::kMaxRatio);
    }
}

}  // namespace
}  // namespace voxdag
