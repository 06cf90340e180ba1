#pragma once
/// The statements of MTL files that name an image.
#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace voxdag {

/// A malformed statement; the message is the reason.
struct MalformedMtl : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The options of a map statement and its file.
struct MtlMap {
  std::string file;
  std::array<float, 3> scale{1, 1, 1}, offset{0, 0, 0};
  std::array<float, 2> base_gain{0, 1};
  float bump = 1;
  bool clamp = false;
};

/// Parses the arguments of a map statement: options, the name of a file, and options again, which
/// some programs write after the name. Throws MalformedMtl.
MtlMap parse_mtl_map(std::string_view text);

/// Removes the numbers at the start of the text, at most `numbers.size()`, and stores them in
/// `numbers`. Returns the number of values removed, also counting values that are not finite.
std::size_t take_numbers(std::string_view& text, std::span<float> numbers);

/// Removes numbers like the function above. Throws MalformedMtl with the message `expected` if
/// there are fewer than `least` numbers, or if one is not finite.
void take_numbers(std::string_view& text, std::span<float> numbers, std::size_t least,
                  const char* expected);

bool all_finite(std::span<const float> numbers);

}  // namespace voxdag
