#pragma once
/// Names of numbered files, such as frame_%04d.png.
#include <string>

namespace voxdag {

/// Whether the text holds just one place for a number: %d, or %0Nd for N digits (N from 1 to 9).
bool is_frame_pattern(const std::string& pattern);

/// Why the text is no pattern; empty where it is one.
std::string frame_pattern_fault(const std::string& text);

/// The pattern with the number in its place; a text that is no pattern stays as it is.
std::string frame_name(const std::string& pattern, int frame);

}  // namespace voxdag
