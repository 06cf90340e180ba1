#pragma once
/// The materials of a mesh with their textures decoded.
#include <memory>
#include <string>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/image/texture.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// A material with its alpha test applied to the texels.
struct ResolvedMaterial {
  Vec3f color{1, 1, 1};  ///< Linear light; multiplies the texture if there is one.
  std::shared_ptr<const Texture> color_texture;
  UvTransform color_uv;
  Vec3f emission{};  ///< Linear light, added to the colour; multiplies the texture if there is one.
  std::shared_ptr<const Texture> emission_texture;
  UvTransform emission_uv;
  std::shared_ptr<const Texture> normal_texture;
  UvTransform normal_uv;
  MetallicRoughness metallic_roughness;  ///< Each number multiplies its texture if there is one.
  /// Blue of the first and green of the second. Both may be one texture.
  std::shared_ptr<const Texture> metallic_texture, roughness_texture;
  UvTransform metallic_uv, roughness_uv;
  /// The alpha test of corners: the surface is masked out where the corners' alpha is less, so
  /// everywhere if this exceeds 1.
  float least_corner_alpha = 0;
  bool is_alpha_textured = false;  ///< Some texels of the colour texture are masked out.
};

/// Decodes the textures of the materials, each texture once, in parallel. A texture that cannot be
/// read is left out; a line in `warnings` names the file, the reason and the replacement, for the
/// first eight of them. If `has_uvs` is false, there are no texture coordinates and all textures
/// are left out. Without `with_metallic_roughness`, materials have the default of these numbers.
/// Throws Cancelled, and OverMemory with the name of an image that does not fit even when it is
/// decoded alone.
std::vector<ResolvedMaterial> load_materials(const Appearance& appearance, bool has_uvs,
                                             std::vector<std::string>& warnings, Work work,
                                             bool with_metallic_roughness = false);

/// Decodes an image that a mesh names or contains. Throws Error and OverMemory, and passes
/// exceptions of options.poll on.
DecodedImage decode_texture_image(const TextureImage& image, const ImageOptions& options);

/// Returns options that count memory in `work` and throw Cancelled when it is cancelled.
ImageOptions image_options(Work work);

}  // namespace voxdag
