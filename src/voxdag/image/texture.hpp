#pragma once
/// Textures: images prepared for filtered look-up.
#include "voxdag/image/decoded_image.hpp"
#include "voxdag/image/mip_pyramid.hpp"

namespace voxdag {

/// A texture of 16-bit values. A colour texture holds linear light, premultiplied by alpha, and
/// alpha. A data texture holds the image's numbers. A normal map holds x, y and z: 0 stands for -1
/// and 65535 for 1, and y points to the image's upper edge. The vectors of level 0 have unit
/// length; coarser levels hold means, which are shorter where the vectors differ.
using Texture = MipPyramid<4>;
/// Holds heights from 0 to 65535.
using HeightTexture = MipPyramid<1>;

struct TextureWraps {
  TextureWrap u = TextureWrap::kRepeat, v = TextureWrap::kRepeat;
};

// Every function below reserves the memory of its result from options.memory (16 bytes per pixel
// for a Texture, 4 for a HeightTexture) and throws OverMemory. It calls options.poll once per row
// of pixels and passes its exceptions on.

/// Makes a colour texture from sRGB. Texels whose alpha is at least `visible_alpha` (0..1) become
/// opaque, the others transparent black; with 0 all become opaque. So the mean alpha of a region is
/// the fraction of it that is visible.
Texture make_color_texture(const DecodedImage& image, float visible_alpha, TextureWraps wraps = {},
                           const ImageOptions& options = {});

/// Makes a texture of an image's red, green, blue and alpha as they are.
Texture make_data_texture(const DecodedImage& image, TextureWraps wraps = {},
                          const ImageOptions& options = {});

/// Makes a normal map from tangent-space normals, whose x and y are multiplied by `scale`.
Texture make_normal_texture(const DecodedImage& image, float scale, TextureWraps wraps = {},
                            const ImageOptions& options = {});

/// Makes a normal map from heights, which span `scale` hundredths of the image's longer side.
Texture make_bump_texture(const DecodedImage& image, float scale, TextureWraps wraps = {},
                          const ImageOptions& options = {});

/// Makes heights from grey values, which it takes as linear. The height of a coloured pixel is the
/// mean of its channels.
HeightTexture make_height_texture(const DecodedImage& image, TextureWraps wraps = {},
                                  const ImageOptions& options = {});

/// Returns whether an image seems to hold tangent-space normals rather than heights: most of its
/// pixels are unit vectors that point out of the surface.
bool looks_like_normal_map(const DecodedImage& image, const ImageOptions& options = {});

/// Returns `image` with the alpha channel of the image `alpha`, or with its grey values if that
/// image has no alpha channel or is opaque everywhere. The smaller image is stretched to the size
/// of the larger.
DecodedImage with_alpha_of(const DecodedImage& image, const DecodedImage& alpha,
                           const ImageOptions& options = {});

/// Converts a stored value 0..65535 to a vector's component.
inline float unpack_component(float value) { return value * (2.0f / 65535) - 1; }

}  // namespace voxdag
