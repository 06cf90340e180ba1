#pragma once
/// Expects that a reader of .vdag files survives damage. `error_of(bytes)` reads the bytes and
/// returns the error, or "no error".
#include <gtest/gtest.h>

#include <string>

#include "support/vdag_bytes.hpp"

namespace voxdag {

// Not inlined: if it is, GCC 12 warns wrongly of reads beyond a short string.
[[gnu::noinline]] inline std::string with_flipped_bit(std::string bytes, std::size_t bit) {
  bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
  return bytes;
}

template <class ErrorOf>
void expect_truncations_are_refused(const std::string& bytes, const ErrorOf& error_of) {
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(error_of(bytes.substr(0, size)), "no error") << size << " bytes";
}

template <class ErrorOf>
void expect_bit_flips_are_refused(const std::string& bytes, const ErrorOf& error_of) {
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const std::string error = error_of(with_flipped_bit(bytes, bit));
    EXPECT_NE(error, "no error") << "byte " << bit / 8;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
}

/// Flips every bit and corrects the checksums, which may make another valid file. Expects errors of
/// one line and no crash. Returns how many of the files were refused.
template <class ErrorOf>
int survive_bit_flips(const std::string& bytes, const ErrorOf& error_of) {
  int refused = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string changed = with_flipped_bit(bytes, bit);
    repair_checksums(changed);
    const std::string error = error_of(changed);
    EXPECT_EQ(error.find('\n'), std::string::npos);
    refused += error != "no error" ? 1 : 0;
  }
  return refused;
}

}  // namespace voxdag
