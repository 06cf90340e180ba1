#pragma once
/// What `voxdag render` writes: the picture and the values behind it.
#include <string>
#include <vector>

#include "voxdag/render/render_options.hpp"

namespace voxdag {

/// One of kPassNames into a file, by its extension .exr or .png.
struct RenderPass {
  std::string name, path;
};

/// "depth=z.exr". Throws std::invalid_argument for unknown passes and extensions.
RenderPass parse_pass(const std::string& text);

/// Throws std::invalid_argument unless the path ends in one of .exr and .png.
void check_picture_path(const std::string& path);

/// EXR holds the values: the picture tone mapped in linear light; radiance; depth in world units
/// (Z); normals (N.X N.Y N.Z); occlusion, shadow, steps under their names. PNG shows them: the
/// picture in sRGB; depth from white (nearest) to grey (farthest) and black for nothing; normals as
/// (n + 1) / 2; steps from none to the most in a colour scale. Throws Error.
void write_pass(const RenderPass& pass, const RenderedImage& image);

}  // namespace voxdag
