#include "voxdag/render/film/picture_pass.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "voxdag/core/vec.hpp"
#include "voxdag/image/color.hpp"
#include "voxdag/image/dither.hpp"
#include "voxdag/image/exr.hpp"
#include "voxdag/image/png.hpp"
#include "voxdag/stored/attributes/material_colors.hpp"

namespace voxdag {
namespace {

/// Returns the display colour (sRGB, 0 to 1) for a value from 0 to 1. Source: D. A. Green, "A
/// colour scheme for the display of astronomical intensity images", 2011 ("cubehelix"), here from
/// black over blue, red and yellow to white.
Vec3f heat_color(float value) {
  constexpr float kStart = 0.5f, kRotations = -1.2f, kHue = 1.3f,
                  kTwoPi = 2 * std::numbers::pi_v<float>;
  const float v = value > 0 ? (value < 1 ? value : 1.0f) : 0.0f;
  const float angle = kTwoPi * (kStart / 3 + 1 + kRotations * v);
  const float spread = kHue * v * (1 - v) / 2;
  const float c = std::cos(angle) * spread, s = std::sin(angle) * spread;
  const auto clamped = [](float x) { return x < 0 ? 0.0f : x > 1 ? 1.0f : x; };
  return {clamped(v - 0.14861f * c + 1.78277f * s), clamped(v - 0.29227f * c - 0.90649f * s),
          clamped(v + 1.97294f * c)};
}

template <std::vector<float> RenderedImage::*kValues>
ImageF scalars(const RenderedImage& image) {
  ImageF out(image.width, image.height, 1);
  out.pixels = image.*kValues;
  return out;
}

template <std::vector<Vec3f> RenderedImage::*kValues>
ImageF vectors(const RenderedImage& image) {
  ImageF out(image.width, image.height, 3);
  const std::vector<Vec3f>& values = image.*kValues;
  for (std::size_t i = 0; i < values.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) out.pixels[3 * i + axis] = values[i][axis];
  return out;
}

std::uint8_t nearest_code(float value, int, int) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f);
}

/// Returns a picture of all values. color(value) is the display colour, from 0 to 1; to_code()
/// rounds it.
template <class Value, class Color>
ImageRgb8 colored(const RenderedImage& image, const std::vector<Value>& values, const Color& color,
                  std::uint8_t (*to_code)(float value, int x, int y) = nearest_code) {
  ImageRgb8 png(image.width, image.height);
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, ++i) {
      const Vec3f rgb = color(values[i]);
      for (int axis = 0; axis < 3; ++axis) png.pixels[3 * i + axis] = to_code(rgb[axis], x, y);
    }
  return png;
}

Vec3f grey(float value) { return {value, value, value}; }

Vec3f encoded(Vec3f linear) {
  Vec3f rgb;
  for (int axis = 0; axis < 3; ++axis)
    rgb[axis] = linear_to_srgb(std::clamp(linear[axis], 0.0f, 1.0f));
  return rgb;
}

template <std::vector<Vec3f> RenderedImage::*kValues>
ImageRgb8 light(const RenderedImage& image) {
  return colored(image, image.*kValues, encoded, dithered_code);
}

template <std::vector<float> RenderedImage::*kValues>
ImageRgb8 greys(const RenderedImage& image) {
  return colored(image, image.*kValues, grey);
}

/// Returns a picture of grey values that are linear in 1 / depth.
ImageRgb8 depths(const RenderedImage& image) {
  float nearest = HUGE_VALF, farthest = 0;
  for (const float d : image.depth) {
    if (!std::isfinite(d)) continue;
    nearest = std::min(nearest, d);
    farthest = std::max(farthest, d);
  }
  return colored(image, image.depth, [nearest, farthest](float d) {
    if (!std::isfinite(d)) return Vec3f{};
    const float range = 1 / nearest - 1 / farthest;
    const float near = range > 0 ? (1 / d - 1 / farthest) / range : 1.0f;
    return grey(0.15f + 0.85f * near);
  });
}

ImageRgb8 normals(const RenderedImage& image) {
  return colored(image, image.normal, [](Vec3f n) { return n * 0.5f + Vec3f{0.5f, 0.5f, 0.5f}; });
}

ImageRgb8 heat(const RenderedImage& image) {
  const float most = *std::max_element(image.steps.begin(), image.steps.end());
  return colored(image, image.steps, [most](float steps) { return heat_color(steps / most); });
}

/// Returns a picture of grey steps: white is 64, as in Figure 9 of Laine and Karras 2010.
ImageRgb8 grey_steps(const RenderedImage& image) {
  return colored(image, image.steps, [](float steps) { return grey(steps / 64); });
}

ImageF cell_values(const RenderedImage& image) {
  ImageF out(image.width, image.height, 4);
  for (std::size_t i = 0; i < image.cells.size(); ++i) {
    const SeenCell& cell = image.cells[i];
    for (int axis = 0; axis < 3; ++axis)
      out.pixels[4 * i + static_cast<std::size_t>(axis)] = static_cast<float>(cell.voxel[axis]);
    out.pixels[4 * i + 3] = static_cast<float>(cell.level);
  }
  return out;
}

/// Returns the display colour of a material, or of any other id.
Vec3f id_color(std::uint32_t id) {
  const Value8 color = material_color(id);
  return Vec3f{static_cast<float>(color[0]), static_cast<float>(color[1]),
               static_cast<float>(color[2])} *
         (1.0f / 255);
}

ImageRgb8 cells(const RenderedImage& image) {
  return colored(image, image.cells, [](const SeenCell& cell) {
    if (cell.level < 0) return Vec3f{};
    std::uint32_t id = 0;
    for (int axis = 0; axis < 3; ++axis)
      id = hash_bits(id + static_cast<std::uint32_t>(cell.voxel[axis]));
    return id_color(id % kMaxMaterials);
  });
}

ImageRgb8 materials(const RenderedImage& image) {
  return colored(image, image.material, [](float id) {
    return id < 0 ? Vec3f{} : id_color(static_cast<std::uint32_t>(id));
  });
}

/// Returns the picture with alpha; the colours are multiplied by it, as EXR files have them.
ImageF with_alpha(const RenderedImage& image) {
  ImageF out(image.width, image.height, 4);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    for (int c = 0; c < 3; ++c) out.pixels[4 * i + c] = image.rgb[i][c] * image.coverage[i];
    out.pixels[4 * i + 3] = image.coverage[i];
  }
  return out;
}

bool has_extension(const std::string& path, const char* extension) {
  return std::filesystem::path(path).extension() == extension;
}

}  // namespace

std::span<const PictureKind> picture_kinds() {
  using Image = RenderedImage;
  static const std::array kKinds{
      PictureKind{"picture", {"R", "G", "B"}, vectors<&Image::rgb>, light<&Image::rgb>},
      PictureKind{"radiance", {"R", "G", "B"}, vectors<&Image::radiance>, light<&Image::radiance>},
      PictureKind{"depth", {"Z"}, scalars<&Image::depth>, depths},
      PictureKind{"normal",
                  {"N.X", "N.Y", "N.Z"},
                  vectors<&Image::normal>,
                  normals,
                  &RenderOptions::with_normal},
      PictureKind{"occlusion",
                  {"occlusion"},
                  scalars<&Image::occlusion>,
                  greys<&Image::occlusion>,
                  &RenderOptions::with_occlusion},
      PictureKind{"shadow",
                  {"shadow"},
                  scalars<&Image::shadow>,
                  greys<&Image::shadow>,
                  &RenderOptions::with_shadow},
      PictureKind{"albedo",
                  {"R", "G", "B"},
                  vectors<&Image::albedo>,
                  light<&Image::albedo>,
                  &RenderOptions::with_albedo},
      PictureKind{"voxel",
                  {"voxel.X", "voxel.Y", "voxel.Z", "voxel.level"},
                  cell_values,
                  cells,
                  &RenderOptions::with_cells},
      PictureKind{"material",
                  {"material"},
                  scalars<&Image::material>,
                  materials,
                  &RenderOptions::with_material},
      PictureKind{"steps", {"steps"}, scalars<&Image::steps>, heat, &RenderOptions::with_steps},
      PictureKind{
          "steps64", {"steps"}, scalars<&Image::steps>, grey_steps, &RenderOptions::with_steps}};
  return kKinds;
}

const PictureKind* find_picture_kind(std::string_view name) {
  for (const PictureKind& kind : picture_kinds())
    if (kind.name == name) return &kind;
  return nullptr;
}

bool is_picture_path(const std::string& path) {
  return has_extension(path, ".png") || has_extension(path, ".exr");
}

void write_pass(const PictureKind& kind, const std::string& path, const RenderedImage& image) {
  const bool is_exr = has_extension(path, ".exr");
  if (kind.name == "picture" && image.has_alpha) {
    if (is_exr) return write_exr(path, with_alpha(image), {"R", "G", "B", "A"});
    std::vector<std::uint8_t> alpha(image.coverage.size());
    for (std::size_t i = 0; i < alpha.size(); ++i) alpha[i] = nearest_code(image.coverage[i], 0, 0);
    return write_png(path, kind.shown(image), alpha);
  }
  if (is_exr) return write_exr(path, kind.values(image), kind.channels);
  write_png(path, kind.shown(image));
}

}  // namespace voxdag
