#pragma once
/// What a mesh file says of the look of its surface: normals, texture coordinates, colours,
/// materials. Values are kept per corner: corner c of triangle t has index 3 * t + c.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "voxdag/core/texture_wrap.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// A colour in linear light, straight (not premultiplied) alpha; 65535 is 1.
struct Rgba16 {
  std::uint16_t r = 65535, g = 65535, b = 65535, a = 65535;

  Vec3f color() const {
    return {static_cast<float>(r) / 65535, static_cast<float>(g) / 65535,
            static_cast<float>(b) / 65535};
  }
  float alpha() const { return static_cast<float>(a) / 65535; }
  friend bool operator==(const Rgba16&, const Rgba16&) = default;
};

/// Rounds to the nearest Rgba16. Values outside [0,1] are clamped, NaN becomes 0.
inline Rgba16 to_rgba16(Vec3f color, float alpha) {
  const auto code = [](float x) {
    return static_cast<std::uint16_t>(x > 0 ? (x < 1 ? std::lround(x * 65535) : 65535) : 0);
  };
  return {code(color.x), code(color.y), code(color.z), code(alpha)};
}

/// Maps uv to (xx * u + xy * v + x, yx * u + yy * v + y).
struct UvTransform {
  float xx = 1, xy = 0, yx = 0, yy = 1, x = 0, y = 0;

  Vec2f operator()(Vec2f uv) const { return linear(uv) + Vec2f{x, y}; }
  /// Maps a difference of texture coordinates.
  Vec2f linear(Vec2f uv) const { return {xx * uv.x + xy * uv.y, yx * uv.x + yy * uv.y}; }
  friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

/// How a material uses an image. Texture coordinates run to the right and DOWN from the
/// image's upper left corner, (1,1) being the lower right one.
struct TextureUse {
  int image = -1;  ///< Index into Appearance::images; -1: no texture.
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
  UvTransform uv;  ///< From the corners' texture coordinates to those of the image.

  bool exists() const { return image >= 0; }
  friend bool operator==(const TextureUse&, const TextureUse&) = default;
};

/// An image file, or the bytes of one inside the mesh file (or its data URI).
struct TextureImage {
  std::string name;  ///< For messages: the file's path, or the mesh file's and the image's place.
  std::filesystem::path path;       ///< Empty where `bytes` hold the image.
  std::vector<std::uint8_t> bytes;  ///< Encoded, as in a file.
};

enum class AlphaMode : std::uint8_t {
  kOpaque,  ///< Alpha is ignored.
  kMask,    ///< Visible where alpha >= alpha_cutoff.
  kBlend    ///< Translucent. Voxels are opaque, so it is visible where alpha >= kBlendCutoff.
};
inline constexpr float kBlendCutoff = 0.1f;

/// The colour of materials that nothing describes: sRGB 0.8.
inline constexpr Vec3f kDefaultColor{0.603827f, 0.603827f, 0.603827f};

/// What Material::normal_map holds.
enum class NormalMapKind : std::uint8_t {
  kTangentSpace,  ///< Normals, green towards the image's upper edge (OpenGL, glTF).
  kHeights,       ///< Heights from black to white.
  kEither         ///< The content decides: OBJ files use map_Bump for both.
};

struct Material {
  std::string name;
  Vec3f base_color{1, 1, 1};    ///< Linear light. Where there is no texture, or it cannot be read.
  Vec3f texture_tint{1, 1, 1};  ///< Linear light; multiplies the colour texture.
  float alpha = 1;              ///< Multiplies the alpha of texture and corners.
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
  TextureUse color_map;  ///< sRGB; its alpha channel is alpha unless there is an alpha_map.
  TextureUse alpha_map;  ///< Alpha: the image's alpha channel if it has one, else its grey.
  TextureUse normal_map;
  NormalMapKind normal_kind = NormalMapKind::kTangentSpace;
  float normal_scale = 1;       ///< Multiplies x and y of tangent-space normals, or heights.
  TextureUse displacement_map;  ///< Heights from black (0) to white (1).
  float displacement_base = 0;  ///< World units along the normal at height 0 ...
  float displacement_gain = 1;  ///< ... and what height 1 adds to that.
};

struct Appearance {
  std::vector<Vec3f> normals;  ///< Per corner, or empty. Unit, or zero where the file gives none.
  std::vector<Vec2f> uvs;      ///< Per corner, or empty. See TextureUse; (0,0) where there is none.
  std::vector<Rgba16> colors;  ///< Per corner, or empty. They multiply the material's colour.
  std::vector<Material> materials;  ///< By Mesh::triangle_materials; never empty after reading.
  std::vector<TextureImage> images;

  /// Returns the index of a triangle's material: 0 if the mesh has none.
  static std::uint32_t material_index(const Mesh& mesh, std::size_t triangle) {
    return mesh.triangle_materials.empty() ? 0 : mesh.triangle_materials[triangle];
  }
};

/// What reading a mesh file with its appearance gives.
struct MeshWithAppearance {
  Mesh mesh;
  Appearance appearance;
  std::vector<std::string> warnings;  ///< One line each: what is missing, and what replaces it.
};

}  // namespace voxdag
