#include "voxdag/mesh/surface/material_textures.hpp"

#include <atomic>
#include <compare>
#include <map>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/image/decode.hpp"

namespace voxdag {
namespace {

/// The images and settings that a texture is made from. Equal keys share a texture.
struct TextureKey {
  enum Kind { kColor, kTangentNormals, kHeights, kEither, kData };
  Kind kind = kColor;
  int image = -1, alpha_image = -1;
  float number = 0;         ///< Colour texture: the least visible alpha. Normals: their scale.
  bool is_implied = false;  ///< AlphaMode::kImpliedMask.
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;

  // NOLINTNEXTLINE(modernize-use-nullptr): false positive in the generated code
  friend auto operator<=>(const TextureKey&, const TextureKey&) = default;
};

struct LoadedTexture {
  std::shared_ptr<const Texture> texture;
  std::vector<std::string> warnings;
  bool is_over_memory = false;  ///< Did not fit with the images that were decoded at the same time.
};

/// Returns the least alpha at which a material is visible; 0 if it is always visible.
float least_alpha(const Material& material) {
  switch (material.alpha_mode) {
    case AlphaMode::kMask:
    case AlphaMode::kImpliedMask:
      return material.alpha_cutoff;
    case AlphaMode::kBlend:
      return kBlendCutoff;
    default:
      return 0;
  }
}

bool has_masked_texels(const Texture& texture) {
  return texture.bounds({0, 0}, {1, 1}).lo[3] < 65535;
}

bool is_invisible(const Texture& texture) { return texture.bounds({0, 0}, {1, 1}).hi[3] == 0; }

class Loader {
 public:
  Loader(const Appearance& appearance, bool has_uvs, ImageOptions options,
         bool with_metallic_roughness)
      : appearance_(appearance),
        has_uvs_(has_uvs),
        options_(std::move(options)),
        with_metallic_roughness_(with_metallic_roughness) {}

  std::vector<ResolvedMaterial> load(std::vector<std::string>& warnings, Work work) {
    for (const Material& material : appearance_.materials) {
      request(color_key(material));
      request(emission_key(material));
      request(normal_key(material));
      if (!with_metallic_roughness_) continue;
      request(data_key(material.metallic_map));
      request(data_key(material.roughness_map));
    }
    std::vector<std::pair<const TextureKey, LoadedTexture>*> entries;
    for (auto& entry : textures_) entries.push_back(&entry);
    std::atomic<std::size_t> done{0};
    const auto make_entry = [&](std::size_t i) {
      work.poll();
      make(entries[i]->first, entries[i]->second);
      const std::size_t count = ++done;
      work.report_done("textures", count, entries.size());
    };
    parallel_for(entries.size(), [&](std::size_t i) {
      try {
        make_entry(i);
      } catch (const OverMemory&) {
        entries[i]->second.is_over_memory = true;
      }
    });
    // An image may fit if it is decoded alone.
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (entries[i]->second.is_over_memory) {
        entries[i]->second = {};
        make_entry(i);
      }
    add_warnings(warnings);
    std::vector<ResolvedMaterial> resolved;
    for (const Material& material : appearance_.materials) resolved.push_back(resolve(material));
    if (!has_uvs_ && has_unused_textures_)
      warnings.emplace_back(
          "the mesh has textures but no texture coordinates: the materials' colours replace them");
    return resolved;
  }

 private:
  /// Adds the warnings of all textures. A scan without its folder of textures may have hundreds.
  void add_warnings(std::vector<std::string>& warnings) const {
    constexpr std::size_t kMost = 8;
    std::size_t count = 0;
    for (const auto& [key, loaded] : textures_)
      for (const std::string& warning : loaded.warnings)
        if (++count <= kMost) warnings.push_back(warning);
    if (count > kMost)
      warnings.push_back("there are " + std::to_string(count - kMost) +
                         " more warnings about textures");
  }

  static TextureKey color_key(const Material& material) {
    const TextureUse& use = material.color_map.exists() ? material.color_map : material.alpha_map;
    TextureKey key{TextureKey::kColor,
                   material.color_map.image,
                   -1,
                   0,
                   material.alpha_mode == AlphaMode::kImpliedMask,
                   use.wrap_u,
                   use.wrap_v};
    const float least = least_alpha(material);
    if (least > 0) {
      // If no texel can pass, any threshold above 1 works.
      key.number = material.alpha > 0 ? std::min(least / material.alpha, 2.0f) : 2.0f;
      if (material.alpha_map.image != material.color_map.image)
        key.alpha_image = material.alpha_map.image;
    }
    return key;
  }

  static TextureKey emission_key(const Material& material) {
    const TextureUse& use = material.emission_map;
    return {TextureKey::kColor, use.image, -1, 0, false, use.wrap_u, use.wrap_v};
  }

  static TextureKey normal_key(const Material& material) {
    const TextureUse& use = material.normal_map;
    const TextureKey::Kind kind =
        material.normal_kind == NormalMapKind::kTangentSpace ? TextureKey::kTangentNormals
        : material.normal_kind == NormalMapKind::kHeights    ? TextureKey::kHeights
                                                             : TextureKey::kEither;
    return {kind, use.image, -1, material.normal_scale, false, use.wrap_u, use.wrap_v};
  }

  static TextureKey data_key(const TextureUse& use) {
    return {TextureKey::kData, use.image, -1, 0, false, use.wrap_u, use.wrap_v};
  }

  void request(const TextureKey& key) {
    if (key.image < 0 && key.alpha_image < 0) return;
    if (has_uvs_)
      textures_[key];
    else
      has_unused_textures_ = true;
  }

  const TextureImage& image(int index) const { return appearance_.images[index]; }

  void make(const TextureKey& key, LoadedTexture& loaded) const {
    const TextureImage& named = image(key.image >= 0 ? key.image : key.alpha_image);
    try {
      if (key.kind == TextureKey::kColor)
        make_color(key, loaded);
      else if (key.kind == TextureKey::kData)
        make_data(key, loaded);
      else
        make_normals(key, loaded);
    } catch (const OverMemory& error) {
      if (!error.file().empty()) throw;
      throw OverMemory(named.name, "", error.reason());
    }
  }

  /// Decodes an image. If it cannot be read, adds a warning that ends with `stand_in` and returns
  /// an empty image.
  DecodedImage decode(int index, const char* stand_in, LoadedTexture& loaded) const {
    try {
      return decode_texture_image(image(index), options_);
    } catch (const Cancelled&) {
      throw;
    } catch (const OverMemory&) {
      throw;
    } catch (const Error& error) {
      loaded.warnings.push_back(std::string(error.what()) + stand_in);
      return {};
    }
  }

  void make_normals(const TextureKey& key, LoadedTexture& loaded) const {
    const TextureWraps wraps{key.wrap_u, key.wrap_v};
    const DecodedImage pixels =
        decode(key.image, ": the mesh's own normals replace the normal map", loaded);
    if (pixels.is_empty()) return;
    const bool is_heights =
        key.kind == TextureKey::kHeights ||
        (key.kind == TextureKey::kEither && !looks_like_normal_map(pixels, options_));
    loaded.texture = std::make_shared<Texture>(
        is_heights ? make_bump_texture(pixels, key.number, wraps, options_)
                   : make_normal_texture(pixels, key.number, wraps, options_));
  }

  void make_data(const TextureKey& key, LoadedTexture& loaded) const {
    const DecodedImage pixels =
        decode(key.image, ": the material's metallic and roughness replace the texture", loaded);
    if (!pixels.is_empty())
      loaded.texture =
          std::make_shared<Texture>(make_data_texture(pixels, {key.wrap_u, key.wrap_v}, options_));
  }

  void make_color(const TextureKey& key, LoadedTexture& loaded) const {
    DecodedImage pixels;
    if (key.image >= 0)
      pixels = decode(key.image, ": the material's colour replaces the texture", loaded);
    if (key.alpha_image >= 0) {
      const DecodedImage alpha =
          decode(key.alpha_image, ": the material is opaque without its alpha map", loaded);
      if (!alpha.is_empty()) {
        if (pixels.is_empty()) {
          pixels = DecodedImage(1, 1, 4, 2, options_.memory);
          pixels.set_pixel(0, 0, {65535, 65535, 65535, 65535});
        }
        pixels = with_alpha_of(pixels, alpha, options_);
      }
    }
    if (pixels.is_empty()) return;
    const TextureWraps wraps{key.wrap_u, key.wrap_v};
    loaded.texture =
        std::make_shared<Texture>(make_color_texture(pixels, key.number, wraps, options_));
    if (!key.is_implied || !is_invisible(*loaded.texture)) return;
    loaded.texture = std::make_shared<Texture>(make_color_texture(pixels, 0, wraps, options_));
    loaded.warnings.push_back(image(key.image).name +
                              ": its alpha would hide the whole material: it is opaque");
  }

  ResolvedMaterial resolve(const Material& material) const {
    ResolvedMaterial resolved;
    resolved.color = material.base_color;
    const TextureKey color = color_key(material);
    if (const auto found = textures_.find(color); found != textures_.end())
      resolved.color_texture = found->second.texture;
    const float least = least_alpha(material);
    if (resolved.color_texture) {
      if (color.image >= 0) resolved.color = material.texture_tint;
      resolved.color_uv = color.image >= 0 ? material.color_map.uv : material.alpha_map.uv;
      resolved.is_alpha_textured = has_masked_texels(*resolved.color_texture);
    }
    // The alphas of texels and corners are tested separately, so that texels can be tested here.
    // Without colours, all corners have alpha 1.
    if (least > 0 && (least > material.alpha || !appearance_.colors.empty()))
      resolved.least_corner_alpha = material.alpha > 0 ? least / material.alpha : 2;
    if (const auto found = textures_.find(emission_key(material)); found != textures_.end()) {
      resolved.emission_texture = found->second.texture;
      resolved.emission_uv = material.emission_map.uv;
    }
    if (resolved.emission_texture || !material.emission_map.exists())
      resolved.emission = material.emission;
    if (const auto found = textures_.find(normal_key(material)); found != textures_.end()) {
      resolved.normal_texture = found->second.texture;
      resolved.normal_uv = material.normal_map.uv;
    }
    if (with_metallic_roughness_) resolve_metallic_roughness(material, resolved);
    return resolved;
  }

  void resolve_metallic_roughness(const Material& material, ResolvedMaterial& resolved) const {
    resolved.metallic_roughness = material.metallic_roughness;
    const auto take = [&](const TextureUse& use, std::shared_ptr<const Texture>& texture,
                          UvTransform& uv, float MetallicRoughness::*number) {
      const auto found = textures_.find(data_key(use));
      if (found == textures_.end() || !found->second.texture) return;
      texture = found->second.texture;
      uv = use.uv;
      resolved.metallic_roughness.*number = material.map_factors.*number;
    };
    take(material.metallic_map, resolved.metallic_texture, resolved.metallic_uv,
         &MetallicRoughness::metallic);
    take(material.roughness_map, resolved.roughness_texture, resolved.roughness_uv,
         &MetallicRoughness::roughness);
  }

  const Appearance& appearance_;
  const bool has_uvs_;
  const ImageOptions options_;
  const bool with_metallic_roughness_;
  bool has_unused_textures_ = false;
  std::map<TextureKey, LoadedTexture> textures_;
};

}  // namespace

std::vector<ResolvedMaterial> load_materials(const Appearance& appearance, bool has_uvs,
                                             std::vector<std::string>& warnings, Work work,
                                             bool with_metallic_roughness) {
  return Loader(appearance, has_uvs, image_options(work), with_metallic_roughness)
      .load(warnings, work);
}

DecodedImage decode_texture_image(const TextureImage& image, const ImageOptions& options) {
  if (!image.path.empty()) return read_image(image.path, options);
  return decode_image(image.bytes, image.name, options);
}

ImageOptions image_options(Work work) {
  ImageOptions options{work.memory, {}};
  if (work.progress != nullptr) options.poll = [work] { work.poll(); };
  return options;
}

}  // namespace voxdag
