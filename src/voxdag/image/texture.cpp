#include "voxdag/image/texture.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "voxdag/core/srgb.hpp"

namespace voxdag {
namespace {

using Rgba = DecodedImage::Rgba;

/// Returns the linear light of each 16-bit sRGB code.
const std::vector<std::uint16_t>& linear_of_srgb() {
  static const std::vector<std::uint16_t> table = [] {
    std::vector<std::uint16_t> linear(65536);
    for (std::size_t code = 0; code < linear.size(); ++code)
      linear[code] = static_cast<std::uint16_t>(
          std::lround(srgb_to_linear(static_cast<float>(code) / 65535) * 65535));
    return linear;
  }();
  return table;
}

std::uint16_t pack_component(float value) {
  return static_cast<std::uint16_t>(std::lround((value * 0.5f + 0.5f) * 65535));
}

Texture::Texel pack_normal(float x, float y, float z) {
  const float length = std::sqrt(x * x + y * y + z * z);
  if (!(length > 0)) return {32768, 32768, 65535, 65535};
  return {pack_component(x / length), pack_component(y / length), pack_component(z / length),
          65535};
}

/// Clamps a scale of slopes, so that slopes stay in the range of floats.
float clamped_scale(float scale) { return std::clamp(scale, -1e6f, 1e6f); }

std::uint16_t grey(const Rgba& pixel) {
  return static_cast<std::uint16_t>((pixel[0] + pixel[1] + pixel[2]) / 3);
}

/// Returns whether an image has no alpha channel, or one that is 1 everywhere.
bool is_opaque(const DecodedImage& image, const ImageOptions& options) {
  for (int y = 0; image.has_alpha() && y < image.height(); ++y) {
    options.call_poll();
    for (int x = 0; x < image.width(); ++x)
      if (image.pixel(x, y)[3] != 65535) return false;
  }
  return true;
}

/// Makes a pyramid whose level 0 has the texels texel(x, y).
template <class Pyramid, class MakeTexel>
Pyramid make(const DecodedImage& image, TextureWraps wraps, const ImageOptions& options,
             const MakeTexel& texel) {
  typename Pyramid::Texels texels(options.memory);
  texels.reserve(static_cast<std::size_t>(image.width()) *
                 static_cast<std::size_t>(image.height()));
  const auto poll = [&] { options.call_poll(); };
  for (int y = 0; y < image.height(); ++y) {
    poll();
    for (int x = 0; x < image.width(); ++x) texels.push_back(texel(x, y));
  }
  return Pyramid(image.width(), image.height(), std::move(texels), wraps.u, wraps.v, poll);
}

/// Calls on_pixel(x, y, rgba) for an image stretched to `width` x `height` pixels.
template <class OnPixel>
void for_each_stretched(const DecodedImage& image, int width, int height,
                        const ImageOptions& options, const OnPixel& on_pixel) {
  if (image.width() == width && image.height() == height) {
    for (int y = 0; y < height; ++y) {
      options.call_poll();
      for (int x = 0; x < width; ++x) on_pixel(x, y, image.pixel(x, y));
    }
    return;
  }
  const auto pyramid =
      make_data_texture(image, {TextureWrap::kClamp, TextureWrap::kClamp}, options);
  for (int y = 0; y < height; ++y) {
    options.call_poll();
    for (int x = 0; x < width; ++x) {
      const Texture::Value value =
          pyramid.sample(0, {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                             (static_cast<float>(y) + 0.5f) / static_cast<float>(height)});
      Rgba rgba;
      for (std::size_t c = 0; c < 4; ++c) rgba[c] = static_cast<std::uint16_t>(value[c] + 0.5f);
      on_pixel(x, y, rgba);
    }
  }
}

}  // namespace

Texture make_color_texture(const DecodedImage& image, float visible_alpha, TextureWraps wraps,
                           const ImageOptions& options) {
  const std::vector<std::uint16_t>& linear = linear_of_srgb();
  const float least = visible_alpha * 65535 - 0.5f;
  return make<Texture>(image, wraps, options, [&](int x, int y) {
    const Rgba p = image.pixel(x, y);
    if (visible_alpha > 0 && static_cast<float>(p[3]) < least) return Texture::Texel{};
    return Texture::Texel{linear[p[0]], linear[p[1]], linear[p[2]], 65535};
  });
}

Texture make_data_texture(const DecodedImage& image, TextureWraps wraps,
                          const ImageOptions& options) {
  return make<Texture>(image, wraps, options,
                       [&](int x, int y) -> Texture::Texel { return image.pixel(x, y); });
}

Texture make_normal_texture(const DecodedImage& image, float scale, TextureWraps wraps,
                            const ImageOptions& options) {
  scale = clamped_scale(scale);
  return make<Texture>(image, wraps, options, [&](int x, int y) {
    const Rgba p = image.pixel(x, y);
    return pack_normal(scale * unpack_component(p[0]), scale * unpack_component(p[1]),
                       unpack_component(p[2]));
  });
}

Texture make_bump_texture(const DecodedImage& image, float scale, TextureWraps wraps,
                          const ImageOptions& options) {
  const HeightTexture heights = make_height_texture(image, wraps, options);
  const auto w = static_cast<float>(image.width()), h = static_cast<float>(image.height());
  const auto height = [&](int x, int y) {
    return heights.sample(
               0, {(static_cast<float>(x) + 0.5f) / w, (static_cast<float>(y) + 0.5f) / h})[0] /
           65535;
  };
  // Differences are taken over two texels.
  const float slope = clamped_scale(scale) * std::max(w, h) / 100 / 2;
  return make<Texture>(image, wraps, options, [&](int x, int y) {
    return pack_normal(slope * (height(x - 1, y) - height(x + 1, y)),
                       slope * (height(x, y + 1) - height(x, y - 1)), 1);
  });
}

HeightTexture make_height_texture(const DecodedImage& image, TextureWraps wraps,
                                  const ImageOptions& options) {
  return make<HeightTexture>(image, wraps, options, [&](int x, int y) {
    return HeightTexture::Texel{grey(image.pixel(x, y))};
  });
}

bool looks_like_normal_map(const DecodedImage& image, const ImageOptions& options) {
  std::size_t normals = 0;
  for (int row = 0; row < image.height(); ++row) {
    options.call_poll();
    for (int column = 0; column < image.width(); ++column) {
      const Rgba p = image.pixel(column, row);
      const float x = unpack_component(p[0]), y = unpack_component(p[1]),
                  z = unpack_component(p[2]);
      const float length2 = x * x + y * y + z * z;
      const bool is_grey = p[0] == p[1] && p[1] == p[2];
      normals += !is_grey && z > 0 && length2 > 0.7f && length2 < 1.3f;
    }
  }
  return normals >
         static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height()) / 2;
}

DecodedImage with_alpha_of(const DecodedImage& image, const DecodedImage& alpha,
                           const ImageOptions& options) {
  const int width = std::max(image.width(), alpha.width());
  const int height = std::max(image.height(), alpha.height());
  DecodedImage out(width, height, 4, 2, options.memory);
  for_each_stretched(image, width, height, options,
                     [&](int x, int y, const Rgba& rgba) { out.set_pixel(x, y, rgba); });
  const bool has_alpha = !is_opaque(alpha, options);
  for_each_stretched(alpha, width, height, options, [&](int x, int y, const Rgba& rgba) {
    Rgba pixel = out.pixel(x, y);
    pixel[3] = has_alpha ? rgba[3] : grey(rgba);
    out.set_pixel(x, y, pixel);
  });
  return out;
}

}  // namespace voxdag
