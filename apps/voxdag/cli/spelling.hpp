#pragma once
/// Names that a user may have meant, and British and American spellings.
#include <string>
#include <vector>

namespace voxdag::cli {

/// Returns the name that needs the fewest edits to become `word` (insert, delete or replace a
/// letter, swap two neighbours), or that `word` begins. Returns "" if all need more than a third of
/// the letters of `word`. Dashes at the beginning do not count. For some options of other programs
/// (--width), returns the name that does their work (--size).
std::string nearest_name(const std::string& word, const std::vector<std::string>& names);

/// Returns the text with British words in American spelling, and the reverse: "colour" and "color".
std::vector<std::string> other_spellings(const std::string& text);

}  // namespace voxdag::cli
