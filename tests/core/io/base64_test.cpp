#include "voxdag/core/io/base64.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

TEST(Base64, DecodesTheExamplesOfTheStandard) {
  // RFC 4648, section 10.
  const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                          {"f", "Zg=="},
                                                          {"fo", "Zm8="},
                                                          {"foo", "Zm9v"},
                                                          {"foob", "Zm9vYg=="},
                                                          {"fooba", "Zm9vYmE="},
                                                          {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : examples) {
    EXPECT_EQ(base64(bytes), text);
    EXPECT_EQ(decode_base64(text), bytes);
  }
}

TEST(Base64, DecodesTheAlphabetForUrlsWithoutPadding) {
  EXPECT_EQ(decode_base64("+/+/Zg=="), decode_base64("-_-_Zg"));
  EXPECT_EQ(decode_base64("Zm9v\n"), std::nullopt);
  EXPECT_EQ(decode_base64("Z=m9"), std::nullopt);
}

}  // namespace
}  // namespace voxdag
