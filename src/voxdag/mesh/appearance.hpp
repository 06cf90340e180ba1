#pragma once
/// The appearance of a mesh's surface, as its file describes it: normals, texture coordinates,
/// colours, materials. Values are stored per corner: corner c of triangle t has index 3 * t + c.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "voxdag/core/metallic_roughness.hpp"
#include "voxdag/core/texture_wrap.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// A colour in linear light with straight (not premultiplied) alpha; 65535 stands for 1.
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
  /// Maps a difference of texture coordinates, without the translation.
  Vec2f linear(Vec2f uv) const { return {xx * uv.x + xy * uv.y, yx * uv.x + yy * uv.y}; }
  friend bool operator==(const UvTransform&, const UvTransform&) = default;
};

/// How a material uses an image. Texture coordinates are (0,0) at the image's upper left corner and
/// (1,1) at its lower right corner: v points DOWN.
struct TextureUse {
  int image = -1;  ///< Index into Appearance::images; -1: no texture.
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
  UvTransform uv;  ///< Maps the corners' texture coordinates to the image's.

  bool exists() const { return image >= 0; }
  friend bool operator==(const TextureUse&, const TextureUse&) = default;
};

/// An image: a file of its own, or bytes inside the mesh file or a data URI.
struct TextureImage {
  std::string name;                 ///< For messages: the path, or mesh file and place.
  std::filesystem::path path;       ///< Empty if `bytes` hold the image.
  std::vector<std::uint8_t> bytes;  ///< Encoded, as in a file.
};

enum class AlphaMode : std::uint8_t {
  kOpaque,  ///< Alpha is ignored.
  kMask,    ///< Visible where alpha >= alpha_cutoff.
  /// As kMask, but a colour texture that would be invisible everywhere is opaque: the file does not
  /// say that its alpha counts.
  kImpliedMask,
  kBlend  ///< Translucent. Voxels are opaque, so it is visible where alpha >= kBlendCutoff.
};
inline constexpr float kBlendCutoff = 0.1f;

/// The colour of a material without any description: sRGB 0.8.
inline constexpr Vec3f kDefaultColor{0.603827f, 0.603827f, 0.603827f};

/// The kind of values in Material::normal_map.
enum class NormalMapKind : std::uint8_t {
  kTangentSpace,  ///< Normals, green towards the image's upper edge (OpenGL, glTF).
  kHeights,       ///< Heights from black to white.
  kEither         ///< The content decides: OBJ files use map_Bump for both.
};

struct Material {
  std::string name;
  Vec3f base_color{1, 1, 1};    ///< Linear light. Used without a readable texture.
  Vec3f texture_tint{1, 1, 1};  ///< Linear light; multiplies the colour texture.
  float alpha = 1;              ///< Multiplies the alpha of texture and corners.
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;
  Vec3f emission{};         ///< Linear light that is added to the colour; multiplies emission_map.
  TextureUse emission_map;  ///< sRGB. If it cannot be read, nothing is added.
  TextureUse color_map;     ///< sRGB; its alpha channel is alpha unless there is an alpha_map.
  TextureUse alpha_map;     ///< Alpha: the image's alpha channel if it has one, else its grey.
  TextureUse normal_map;
  NormalMapKind normal_kind = NormalMapKind::kTangentSpace;
  float normal_scale = 1;       ///< Factor on x and y of tangent-space normals, or on heights.
  TextureUse displacement_map;  ///< Heights from black (0) to white (1).
  float displacement_base = 0;  ///< World units along the normal at height 0.
  float displacement_gain = 1;  ///< World units that height 1 adds.
  MetallicRoughness metallic_roughness;    ///< Used without a readable map.
  MetallicRoughness map_factors{1, 1};     ///< Multiply the maps.
  TextureUse metallic_map, roughness_map;  ///< Linear: blue is metallic, green is roughness.
};

struct Appearance {
  std::vector<Vec3f> normals;       ///< Per corner, or empty. Unit length; zero if unset.
  std::vector<Vec2f> uvs;           ///< Per corner, or empty. See TextureUse; (0,0) if unset.
  std::vector<Rgba16> colors;       ///< Per corner, or empty. They multiply the material's colour.
  std::vector<Material> materials;  ///< Mesh::triangle_materials has indices; never empty.
  std::vector<TextureImage> images;

  /// Returns the index of a triangle's material: 0 if the mesh has none.
  static std::uint32_t material_index(const Mesh& mesh, std::size_t triangle) {
    return mesh.triangle_materials.empty() ? 0 : mesh.triangle_materials[triangle];
  }
};

/// A mesh and its appearance, as read from a file.
struct MeshWithAppearance {
  Mesh mesh;
  Appearance appearance;
  std::vector<std::string> warnings;  ///< One line each: the missing part and its replacement.
};

}  // namespace voxdag
