#pragma once
/// Texts of command line options to values. Every function throws std::invalid_argument with the
/// reason where the text is not what it should be.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/image/image_size.hpp"

namespace voxdag {

/// Nothing where the whole of the text is not a finite number, or a whole one.
std::optional<double> read_number(std::string_view text);
std::optional<std::int64_t> read_whole_number(std::string_view text);

/// The numbers of lists are coordinates and the like: those that floats reach, as in meshes.
std::vector<double> parse_numbers(const std::string& text);  ///< "1,2.5": at least one.
Vec3d parse_vec3(const std::string& text);                   ///< "1.5,-2,0".
Vec3d parse_direction(const std::string& text);              ///< As parse_vec3, but not zero.
Box3d parse_box(const std::string& text);  ///< "x0,y0,z0,x1,y1,z1", the second corner above.
Box3i parse_window(
    const std::string& text);  ///< As parse_box, of voxels: `hi` is one past the last.
double parse_positive(const std::string& text);  ///< A finite number above zero.
int parse_levels(const std::string& text);       ///< "8192" or "8K", a power of two, to its log2.
std::uint64_t parse_memory(const std::string& text);  ///< "512M", "16GiB", "1000000": bytes.
ImageSize parse_image_size(const std::string& text);  ///< "1920x1080".

}  // namespace voxdag
