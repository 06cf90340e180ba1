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

/// Whether a text is read as it stands, or without what some programs add to it.
enum class MtlText { kExact, kPlain };

/// Parses the arguments of a map statement: options, the name of a file, and options again, which
/// some programs write after the name. Plain text has no comment, and no options that are not
/// known: words such as "-colorspace", and one value. Throws MalformedMtl.
MtlMap parse_mtl_map(std::string_view text, MtlText kind = MtlText::kExact);

/// Returns the text before a comment: a blank and '#', but not "#1", which ends names of materials.
std::string_view without_mtl_comment(std::string_view text);

/// Returns the name of a material without a comment and without quotes.
std::string_view plain_mtl_name(std::string_view name);

/// Removes the numbers at the start of the text, at most `numbers.size()`, and stores them in
/// `numbers`. Returns the number of values removed, also counting values that are not finite.
std::size_t take_numbers(std::string_view& text, std::span<float> numbers);

/// Removes numbers like the function above. Throws MalformedMtl with the message `expected` if
/// there are fewer than `least` numbers, or if one is not finite.
void take_numbers(std::string_view& text, std::span<float> numbers, std::size_t least,
                  const char* expected);

bool all_finite(std::span<const float> numbers);

}  // namespace voxdag
