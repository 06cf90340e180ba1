#include "voxdag/image/texture.hpp"

#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

/// Linear light of each 16-bit sRGB code.
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

/// Scales of slopes beyond this are no steeper; floats stay in their range.
float in_range(float scale) { return std::clamp(scale, -1e6f, 1e6f); }

std::uint16_t grey(const std::uint16_t* pixel) {
  return static_cast<std::uint16_t>((pixel[0] + pixel[1] + pixel[2]) / 3);
}

/// Texels made one by one: texel(x, y).
template <class Pyramid, class MakeTexel>
Pyramid make(const ImageRgba16& image, TextureWraps wraps, const MakeTexel& texel) {
  std::vector<typename Pyramid::Texel> texels;
  texels.reserve(image.pixels.size() / 4);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) texels.push_back(texel(x, y));
  return Pyramid(image.width, image.height, std::move(texels), wraps.u, wraps.v);
}

ImageRgba16 stretch(const ImageRgba16& image, int width, int height) {
  if (image.width == width && image.height == height) return image;
  ImageRgba16 out(width, height);
  out.has_alpha = image.has_alpha;
  const auto pyramid =
      make<Texture>(image, {TextureWrap::kClamp, TextureWrap::kClamp}, [&](int x, int y) {
        const std::uint16_t* p = image.pixel(x, y);
        return Texture::Texel{p[0], p[1], p[2], p[3]};
      });
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Texture::Value value =
          pyramid.sample(0, {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                             (static_cast<float>(y) + 0.5f) / static_cast<float>(height)});
      for (std::size_t c = 0; c < 4; ++c)
        out.pixel(x, y)[c] = static_cast<std::uint16_t>(value[c] + 0.5f);
    }
  return out;
}

}  // namespace

Texture make_color_texture(const ImageRgba16& image, float visible_alpha, TextureWraps wraps) {
  const std::vector<std::uint16_t>& linear = linear_of_srgb();
  const float least = visible_alpha * 65535 - 0.5f;
  return make<Texture>(image, wraps, [&](int x, int y) {
    const std::uint16_t* p = image.pixel(x, y);
    if (visible_alpha > 0 && static_cast<float>(p[3]) < least) return Texture::Texel{};
    return Texture::Texel{linear[p[0]], linear[p[1]], linear[p[2]], 65535};
  });
}

Texture make_normal_texture(const ImageRgba16& image, float scale, TextureWraps wraps) {
  scale = in_range(scale);
  return make<Texture>(image, wraps, [&](int x, int y) {
    const std::uint16_t* p = image.pixel(x, y);
    return pack_normal(scale * unpack_component(p[0]), scale * unpack_component(p[1]),
                       unpack_component(p[2]));
  });
}

Texture make_bump_texture(const ImageRgba16& image, float scale, TextureWraps wraps) {
  const HeightTexture heights = make_height_texture(image, wraps);
  const auto w = static_cast<float>(image.width), h = static_cast<float>(image.height);
  const auto height = [&](int x, int y) {
    return heights.sample(
               0, {(static_cast<float>(x) + 0.5f) / w, (static_cast<float>(y) + 0.5f) / h})[0] /
           65535;
  };
  const float slope = in_range(scale) * std::max(w, h) / 100 / 2;  // of differences over two texels
  return make<Texture>(image, wraps, [&](int x, int y) {
    return pack_normal(slope * (height(x - 1, y) - height(x + 1, y)),
                       slope * (height(x, y + 1) - height(x, y - 1)), 1);
  });
}

HeightTexture make_height_texture(const ImageRgba16& image, TextureWraps wraps) {
  return make<HeightTexture>(
      image, wraps, [&](int x, int y) { return HeightTexture::Texel{grey(image.pixel(x, y))}; });
}

bool looks_like_normal_map(const ImageRgba16& image) {
  // Most of its pixels are unit vectors that point out of the surface.
  std::size_t normals = 0, count = image.pixels.size() / 4;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t* p = image.pixels.data() + 4 * i;
    const float x = unpack_component(p[0]), y = unpack_component(p[1]), z = unpack_component(p[2]);
    const float length2 = x * x + y * y + z * z;
    const bool is_grey = p[0] == p[1] && p[1] == p[2];
    normals += !is_grey && z > 0 && length2 > 0.7f && length2 < 1.3f;
  }
  return normals > count / 2;
}

ImageRgba16 with_alpha_of(const ImageRgba16& image, const ImageRgba16& alpha) {
  const int width = std::max(image.width, alpha.width);
  const int height = std::max(image.height, alpha.height);
  ImageRgba16 out = stretch(image, width, height);
  const ImageRgba16 from = stretch(alpha, width, height);
  for (std::size_t i = 0; i < out.pixels.size(); i += 4)
    out.pixels[i + 3] = from.has_alpha ? from.pixels[i + 3] : grey(from.pixels.data() + i);
  out.has_alpha = true;
  return out;
}

}  // namespace voxdag
