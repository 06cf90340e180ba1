#pragma once
/// Parses the texts of command line options. Every parse function throws std::invalid_argument with
/// the reason if the text is malformed or the value is not allowed.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/image/image_size.hpp"

namespace voxdag::cli {

/// Returns the value of a text that is a finite number, else nothing.
std::optional<double> read_number(std::string_view text);
/// Returns the value of a text that is a whole number, else nothing.
std::optional<std::int64_t> read_whole_number(std::string_view text);

// Numbers in lists must be in the range of float, like coordinates of meshes.

/// Parses a list of at least one number: "1,2.5".
std::vector<double> parse_numbers(const std::string& text);
/// Parses a list of at least one word: "ground,7".
std::vector<std::string> parse_words(const std::string& text);
/// Parses three numbers: "1.5,-2,0".
Vec3d parse_vec3(const std::string& text);
/// Parses three numbers, not all zero.
Vec3d parse_direction(const std::string& text);
/// Parses red, green and blue, whole numbers from 0 to 255.
Vec3<std::uint8_t> parse_color(const std::string& text);
/// Parses the lower and the upper corner of a box: "x0,y0,z0,x1,y1,z1".
Box3d parse_box(const std::string& text);
/// Parses a box of voxels, in whole numbers: the first voxel, and one past the last on each axis.
Box3i parse_window(const std::string& text);
/// Parses "x", "y" or "z". Returns 0, 1 or 2.
int parse_axis(const std::string& text);
/// Parses a finite number.
double parse_finite(const std::string& text);
/// Parses a finite number above zero.
double parse_positive(const std::string& text);
/// Parses the number of voxels along a side, "1000" or "8K": 1 to 2^kMaxLevels.
std::int64_t parse_resolution(const std::string& text);
/// Parses a power of two, "8192" or "8K", and returns its log2.
int parse_levels(const std::string& text);
/// Parses a size in bytes: "512M", "16GiB", "1000000".
std::uint64_t parse_memory(const std::string& text);
/// Parses a size in pixels: "1920x1080".
ImageSize parse_image_size(const std::string& text);

}  // namespace voxdag::cli
