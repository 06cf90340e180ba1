#pragma once
/// Textures: images prepared for filtered look-up.
#include "voxdag/image/image.hpp"
#include "voxdag/image/mip_pyramid.hpp"

namespace voxdag {

/// Colours: linear light, multiplied by alpha, and alpha. Normal maps: x, y and z of unit vectors
/// (level 0), each from -1 (0) to 1 (65535), y towards the image's upper edge; the mean of unit
/// vectors is shorter where they disagree.
using Texture = MipPyramid<4>;
/// Heights from 0 to 65535.
using HeightTexture = MipPyramid<1>;

struct TextureWraps {
  TextureWrap u = TextureWrap::kRepeat, v = TextureWrap::kRepeat;
};

/// From sRGB. Texels whose alpha is at least `visible_alpha` (0..1) become opaque, the others
/// nothing; at 0 all are opaque. So the mean alpha of a region is the part of it that is visible.
Texture make_color_texture(const ImageRgba16& image, float visible_alpha, TextureWraps wraps = {});

/// From tangent-space normals, x and y scaled.
Texture make_normal_texture(const ImageRgba16& image, float scale, TextureWraps wraps = {});

/// Normals of a height map whose heights span `scale` hundredths of the image's longer side.
Texture make_bump_texture(const ImageRgba16& image, float scale, TextureWraps wraps = {});

/// From grey values as they are, not decoded; of coloured pixels the mean of the channels.
HeightTexture make_height_texture(const ImageRgba16& image, TextureWraps wraps = {});

/// Whether an image holds tangent-space normals rather than heights.
bool looks_like_normal_map(const ImageRgba16& image);

/// `image` with the alpha of another image (its grey values if that has no alpha), which is
/// stretched to the same size, or `image` to its size if that is larger.
ImageRgba16 with_alpha_of(const ImageRgba16& image, const ImageRgba16& alpha);

/// Encoded value 0..65535 as a vector's component.
inline float unpack_component(float value) { return value * (2.0f / 65535) - 1; }

}  // namespace voxdag
