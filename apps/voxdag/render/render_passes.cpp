#include "render/render_passes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "voxdag/image/color.hpp"
#include "voxdag/image/dither.hpp"
#include "voxdag/image/exr.hpp"
#include "voxdag/image/png.hpp"
#include "voxdag/render/heat_map.hpp"

namespace voxdag {
namespace {

const std::vector<std::string> kPassNames = {"picture",   "radiance", "depth", "normal",
                                             "occlusion", "shadow",   "steps"};

bool has_extension(const std::string& path, std::string_view extension) {
  return std::filesystem::path(path).extension() == extension;
}

ImageF to_image(const RenderedImage& image, const std::vector<float>& values) {
  ImageF out(image.width, image.height, 1);
  out.pixels = values;
  return out;
}

ImageF to_image(const RenderedImage& image, const std::vector<Vec3f>& values) {
  ImageF out(image.width, image.height, 3);
  for (std::size_t i = 0; i < values.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) out.pixels[3 * i + axis] = values[i][axis];
  return out;
}

std::uint8_t nearest_code(float value, int, int) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f);
}

/// `color(value)` is what the display is to show, as codes from 0 to 1, which `to_code` rounds.
template <class Value, class Color>
void write_colors(const RenderPass& pass, const RenderedImage& image,
                  const std::vector<Value>& values, const Color& color,
                  std::uint8_t (*to_code)(float value, int x, int y) = nearest_code) {
  ImageRgb8 png(image.width, image.height);
  std::size_t i = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, ++i) {
      const Vec3f rgb = color(values[i]);
      for (int axis = 0; axis < 3; ++axis) png.pixels[3 * i + axis] = to_code(rgb[axis], x, y);
    }
  write_png(pass.path, png);
}

Vec3f grey(float value) { return {value, value, value}; }

Vec3f encoded(Vec3f linear) {
  Vec3f rgb;
  for (int axis = 0; axis < 3; ++axis)
    rgb[axis] = linear_to_srgb(std::clamp(linear[axis], 0.0f, 1.0f));
  return rgb;
}

/// From white for the nearest to dark grey for the farthest, even in 1 / depth.
std::function<Vec3f(float)> depth_colors(const std::vector<float>& depth) {
  float nearest = HUGE_VALF, farthest = 0;
  for (const float d : depth) {
    if (!std::isfinite(d)) continue;
    nearest = std::min(nearest, d);
    farthest = std::max(farthest, d);
  }
  return [nearest, farthest](float d) {
    if (!std::isfinite(d)) return Vec3f{};
    const float range = 1 / nearest - 1 / farthest;
    const float near = range > 0 ? (1 / d - 1 / farthest) / range : 1.0f;
    return grey(0.15f + 0.85f * near);
  };
}

void write_as_exr(const RenderPass& pass, const RenderedImage& image) {
  if (pass.name == "picture")
    return write_exr(pass.path, to_image(image, image.rgb), {"R", "G", "B"});
  if (pass.name == "radiance")
    return write_exr(pass.path, to_image(image, image.radiance), {"R", "G", "B"});
  if (pass.name == "depth") return write_exr(pass.path, to_image(image, image.depth), {"Z"});
  if (pass.name == "normal")
    return write_exr(pass.path, to_image(image, image.normal), {"N.X", "N.Y", "N.Z"});
  if (pass.name == "steps") return write_exr(pass.path, to_image(image, image.steps), {pass.name});
  write_exr(pass.path, to_image(image, pass.name == "shadow" ? image.shadow : image.occlusion),
            {pass.name});
}

void write_as_png(const RenderPass& pass, const RenderedImage& image) {
  if (pass.name == "picture") return write_colors(pass, image, image.rgb, encoded, dithered_code);
  if (pass.name == "radiance")
    return write_colors(pass, image, image.radiance, encoded, dithered_code);
  if (pass.name == "depth")
    return write_colors(pass, image, image.depth, depth_colors(image.depth));
  if (pass.name == "normal")
    return write_colors(pass, image, image.normal, [](Vec3f n) {
      return n * 0.5f + Vec3f{0.5f, 0.5f, 0.5f};
    });
  if (pass.name == "steps") {
    const float most = *std::max_element(image.steps.begin(), image.steps.end());
    return write_colors(pass, image, image.steps,
                        [most](float steps) { return heat_color(steps / most); });
  }
  write_colors(pass, image, pass.name == "shadow" ? image.shadow : image.occlusion, grey);
}

}  // namespace

RenderPass parse_pass(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw std::invalid_argument("needs NAME=FILE");
  RenderPass pass{text.substr(0, equals), text.substr(equals + 1)};
  if (std::find(kPassNames.begin(), kPassNames.end(), pass.name) == kPassNames.end())
    throw std::invalid_argument(
        fmt::format("\"{}\" is none of {}", pass.name, fmt::join(kPassNames, ", ")));
  check_picture_path(pass.path);
  return pass;
}

void check_picture_path(const std::string& path) {
  if (!has_extension(path, ".png") && !has_extension(path, ".exr"))
    throw std::invalid_argument(fmt::format("\"{}\" does not end in .png or .exr", path));
}

void write_pass(const RenderPass& pass, const RenderedImage& image) {
  if (has_extension(pass.path, ".exr")) return write_as_exr(pass, image);
  write_as_png(pass, image);
}

}  // namespace voxdag
