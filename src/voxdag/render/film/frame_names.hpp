#pragma once
/// Names of numbered files, such as frame_%04d.png.
#include <string>

namespace voxdag {

/// Returns whether the text has exactly one placeholder for a number: %d, or %0Nd for N digits (1
/// to 9).
bool is_frame_pattern(const std::string& pattern);

/// Returns the reason why the text is not a pattern, or an empty text if it is one.
std::string frame_pattern_fault(const std::string& text);

/// Returns the pattern with the number in it. A text that is not a pattern is returned unchanged.
std::string frame_name(const std::string& pattern, int frame);

}  // namespace voxdag
