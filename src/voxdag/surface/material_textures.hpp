#pragma once
/// The decoded textures of a mesh's materials.
#include <memory>
#include <string>
#include <vector>

#include "voxdag/image/texture.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// The appearance of a material, ready for look-up.
struct MaterialLook {
  Vec3f color{1, 1, 1};  ///< Linear light; multiplies the texture if there is one.
  std::shared_ptr<const Texture> color_texture;
  UvTransform color_uv;
  std::shared_ptr<const Texture> normal_texture;
  UvTransform normal_uv;
  /// Surface with less corner alpha is removed. Over 1: all of it.
  float least_corner_alpha = 0;
  bool is_alpha_textured = false;  ///< The alpha test removes some texels of the colour texture.
};

/// Decodes the textures of the materials, each one once, in parallel. A texture that cannot be read
/// is left out; `warnings` gets a line that names the file, the reason and the replacement. If the
/// mesh has no texture coordinates (`has_uvs`), all textures are left out. Throws Cancelled, and
/// OverMemory with the name of the image.
std::vector<MaterialLook> load_material_looks(const Appearance& appearance, bool has_uvs,
                                              std::vector<std::string>& warnings,
                                              Progress* progress, MemoryBudget* memory);

/// Decodes an image that a mesh names or contains. Throws Error, OverMemory, and what options.poll
/// throws.
DecodedImage decode_texture_image(const TextureImage& image, const ImageOptions& options);

/// Returns options that count memory in `memory` and throw Cancelled when `progress` is cancelled.
/// Both may be null.
ImageOptions image_options(Progress* progress, MemoryBudget* memory);

}  // namespace voxdag
