#pragma once
/// Textures: images prepared for filtered look-up.
#include "voxdag/image/decoded_image.hpp"
#include "voxdag/image/mip_pyramid.hpp"

namespace voxdag {

/// A colour texture holds linear light, multiplied by alpha, and alpha. A normal map holds x, y and
/// z of unit vectors (level 0), each from -1 (0) to 1 (65535), y towards the image's upper edge;
/// the mean of unit vectors is shorter where they disagree.
using Texture = MipPyramid<4>;
/// Holds heights from 0 to 65535.
using HeightTexture = MipPyramid<1>;

struct TextureWraps {
  TextureWrap u = TextureWrap::kRepeat, v = TextureWrap::kRepeat;
};

// Every function below takes memory for its result from options.memory before it fills it (16
// bytes per pixel for a Texture, 4 for a HeightTexture) and throws OverMemory; it calls
// options.poll once per row of pixels and throws what that throws.

/// Makes a colour texture from sRGB. Texels whose alpha is at least `visible_alpha` (0..1) become
/// opaque, the others transparent black; at 0 all become opaque. So the mean alpha of a region is
/// the visible part of it.
Texture make_color_texture(const DecodedImage& image, float visible_alpha, TextureWraps wraps = {},
                           const ImageOptions& options = {});

/// Makes a normal map from tangent-space normals, whose x and y are multiplied by `scale`.
Texture make_normal_texture(const DecodedImage& image, float scale, TextureWraps wraps = {},
                            const ImageOptions& options = {});

/// Makes a normal map from heights, which span `scale` hundredths of the image's longer side.
Texture make_bump_texture(const DecodedImage& image, float scale, TextureWraps wraps = {},
                          const ImageOptions& options = {});

/// Makes heights from grey values, taken as linear; from the mean of a coloured pixel's channels.
HeightTexture make_height_texture(const DecodedImage& image, TextureWraps wraps = {},
                                  const ImageOptions& options = {});

/// Returns whether an image holds tangent-space normals rather than heights: whether most pixels
/// are unit vectors that point out of the surface.
bool looks_like_normal_map(const DecodedImage& image, const ImageOptions& options = {});

/// Returns `image` with the alpha of another image, or with its grey values if that has no alpha.
/// The smaller image is stretched to the size of the larger.
DecodedImage with_alpha_of(const DecodedImage& image, const DecodedImage& alpha,
                           const ImageOptions& options = {});

/// Converts a stored value 0..65535 to a vector's component.
inline float unpack_component(float value) { return value * (2.0f / 65535) - 1; }

}  // namespace voxdag
