#pragma once
/// MTL, the material files of Wavefront OBJ.
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Fills those of `appearance.materials` that the file describes, by name, and adds the images that
/// they use. `file` is its path: names of images start in its folder.
///
/// Read are Kd (taken as sRGB), d and Tr, map_Kd, map_d, norm, bump (map_bump) with -bm, disp
/// (map_disp) with -mm, and for each map -s, -o and -clamp; other statements and options are passed
/// over. A map_Kd gives the colour alone: Kd stands in where it is missing. A map_d makes the
/// material a mask. Appends to `warnings` what is malformed among these, with its line and what
/// stands in. Returns the names of the materials that the file describes.
std::vector<std::string> read_mtl(std::string_view text, const std::filesystem::path& file,
                                  Appearance& appearance, std::vector<std::string>& warnings);

}  // namespace voxdag
