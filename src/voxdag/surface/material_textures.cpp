#include "voxdag/surface/material_textures.hpp"

#include <atomic>
#include <compare>
#include <map>

#include "voxdag/image/decode.hpp"
#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// The inputs of a decoded texture. Materials with equal recipes share one texture.
struct Recipe {
  enum Kind { kColor, kTangentNormals, kHeights, kEither };
  Kind kind = kColor;
  int image = -1, alpha_image = -1;
  float number = 0;  ///< The smallest visible alpha, or the scale of normals.
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;

  // NOLINTNEXTLINE(modernize-use-nullptr): misfires on the defaulted operator
  friend auto operator<=>(const Recipe&, const Recipe&) = default;
};

struct DecodedTexture {
  std::shared_ptr<const Texture> texture;
  std::vector<std::string> warnings;
};

/// Returns the smallest alpha at which a material is visible; 0: it is always visible.
float least_alpha(const Material& material) {
  switch (material.alpha_mode) {
    case AlphaMode::kMask:
      return material.alpha_cutoff;
    case AlphaMode::kBlend:
      return kBlendCutoff;
    default:
      return 0;
  }
}

bool has_cut_texels(const Texture& texture) { return texture.bounds({0, 0}, {1, 1}).lo[3] < 65535; }

class Loader {
 public:
  Loader(const Appearance& appearance, bool has_uvs, ImageOptions options)
      : appearance_(appearance), has_uvs_(has_uvs), options_(std::move(options)) {}

  std::vector<MaterialLook> load(std::vector<std::string>& warnings, Progress* progress) {
    for (const Material& material : appearance_.materials) {
      ask(color_recipe(material));
      ask(normal_recipe(material));
    }
    std::vector<std::pair<const Recipe, DecodedTexture>*> pending;
    for (auto& entry : decoded_) pending.push_back(&entry);
    std::atomic<std::size_t> done{0};
    parallel_for(pending.size(), [&](std::size_t i) {
      if (progress != nullptr) progress->throw_if_cancelled();
      make(pending[i]->first, pending[i]->second);
      const std::size_t count = ++done;
      if (progress != nullptr)
        progress->report("textures",
                         static_cast<double>(count) / static_cast<double>(pending.size()), count);
    });
    for (const auto& [recipe, result] : decoded_)
      warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
    std::vector<MaterialLook> looks;
    for (const Material& material : appearance_.materials) looks.push_back(look(material));
    if (!has_uvs_ && asked_without_uvs_)
      warnings.emplace_back(
          "the mesh has textures but no texture coordinates: its materials' colours stand in");
    return looks;
  }

 private:
  static Recipe color_recipe(const Material& material) {
    const TextureUse& use = material.color_map.exists() ? material.color_map : material.alpha_map;
    Recipe recipe{Recipe::kColor, material.color_map.image, -1, 0, use.wrap_u, use.wrap_v};
    const float least = least_alpha(material);
    if (least > 0) {
      // No texel passes a threshold over 1.
      recipe.number = material.alpha > 0 ? std::min(least / material.alpha, 2.0f) : 2.0f;
      if (material.alpha_map.image != material.color_map.image)
        recipe.alpha_image = material.alpha_map.image;
    }
    return recipe;
  }

  static Recipe normal_recipe(const Material& material) {
    const TextureUse& use = material.normal_map;
    const Recipe::Kind kind = material.normal_kind == NormalMapKind::kTangentSpace
                                  ? Recipe::kTangentNormals
                              : material.normal_kind == NormalMapKind::kHeights ? Recipe::kHeights
                                                                                : Recipe::kEither;
    return {kind, use.image, -1, material.normal_scale, use.wrap_u, use.wrap_v};
  }

  void ask(const Recipe& recipe) {
    if (recipe.image < 0 && recipe.alpha_image < 0) return;
    if (has_uvs_)
      decoded_[recipe];
    else
      asked_without_uvs_ = true;
  }

  const TextureImage& image(int index) const {
    return appearance_.images[static_cast<std::size_t>(index)];
  }

  void make(const Recipe& recipe, DecodedTexture& result) const {
    const TextureImage& named = image(recipe.image >= 0 ? recipe.image : recipe.alpha_image);
    try {
      if (recipe.kind == Recipe::kColor)
        make_color(recipe, result);
      else
        make_normals(recipe, result);
    } catch (const OverMemory& error) {
      if (!error.file().empty()) throw;
      throw OverMemory(named.name, "", error.reason());
    }
  }

  /// Decodes an image. If it cannot be read, adds a warning that ends with `stand_in`, and returns
  /// an empty image.
  DecodedImage decode(int index, const char* stand_in, DecodedTexture& result) const {
    try {
      return decode_texture_image(image(index), options_);
    } catch (const Cancelled&) {
      throw;
    } catch (const OverMemory&) {
      throw;
    } catch (const Error& error) {
      result.warnings.push_back(std::string(error.what()) + stand_in);
      return {};
    }
  }

  void make_normals(const Recipe& recipe, DecodedTexture& result) const {
    const TextureWraps wraps{recipe.wrap_u, recipe.wrap_v};
    const DecodedImage pixels =
        decode(recipe.image, ": the mesh's own normals stand in for the normal map", result);
    if (pixels.is_empty()) return;
    const bool is_heights =
        recipe.kind == Recipe::kHeights ||
        (recipe.kind == Recipe::kEither && !looks_like_normal_map(pixels, options_));
    result.texture = std::make_shared<Texture>(
        is_heights ? make_bump_texture(pixels, recipe.number, wraps, options_)
                   : make_normal_texture(pixels, recipe.number, wraps, options_));
  }

  void make_color(const Recipe& recipe, DecodedTexture& result) const {
    DecodedImage pixels;
    if (recipe.image >= 0)
      pixels = decode(recipe.image, ": the material's colour stands in for the texture", result);
    if (recipe.alpha_image >= 0) {
      const DecodedImage alpha =
          decode(recipe.alpha_image, ": the material is opaque without its alpha map", result);
      if (!alpha.is_empty()) {
        if (pixels.is_empty()) {
          pixels = DecodedImage(1, 1, 4, 2, options_.memory);
          pixels.set_pixel(0, 0, {65535, 65535, 65535, 65535});
        }
        pixels = with_alpha_of(pixels, alpha, options_);
      }
    }
    if (!pixels.is_empty())
      result.texture = std::make_shared<Texture>(
          make_color_texture(pixels, recipe.number, {recipe.wrap_u, recipe.wrap_v}, options_));
  }

  MaterialLook look(const Material& material) const {
    MaterialLook look;
    look.color = material.base_color;
    const Recipe color = color_recipe(material);
    if (const auto found = decoded_.find(color); found != decoded_.end())
      look.color_texture = found->second.texture;
    const float least = least_alpha(material);
    if (look.color_texture) {
      if (color.image >= 0) look.color = material.texture_tint;
      look.color_uv = color.image >= 0 ? material.color_map.uv : material.alpha_map.uv;
      look.is_alpha_textured = has_cut_texels(*look.color_texture);
    }
    // Texture alpha and corner alpha are tested separately, so that texels can be tested in
    // advance.
    if (least > 0) look.least_corner_alpha = material.alpha > 0 ? least / material.alpha : 2;
    if (const auto found = decoded_.find(normal_recipe(material)); found != decoded_.end()) {
      look.normal_texture = found->second.texture;
      look.normal_uv = material.normal_map.uv;
    }
    return look;
  }

  const Appearance& appearance_;
  const bool has_uvs_;
  const ImageOptions options_;
  bool asked_without_uvs_ = false;
  std::map<Recipe, DecodedTexture> decoded_;
};

}  // namespace

std::vector<MaterialLook> load_material_looks(const Appearance& appearance, bool has_uvs,
                                              std::vector<std::string>& warnings,
                                              Progress* progress, MemoryBudget* memory) {
  return Loader(appearance, has_uvs, image_options(progress, memory)).load(warnings, progress);
}

DecodedImage decode_texture_image(const TextureImage& image, const ImageOptions& options) {
  if (!image.path.empty()) return read_image(image.path, options);
  return decode_image(image.bytes, image.name, options);
}

ImageOptions image_options(Progress* progress, MemoryBudget* memory) {
  ImageOptions options{memory, {}};
  if (progress != nullptr) options.poll = [progress] { progress->throw_if_cancelled(); };
  return options;
}

}  // namespace voxdag
