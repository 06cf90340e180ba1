#include "voxdag/formats/readers/gltf/gltf_materials.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/core/angles.hpp"

namespace voxdag {
namespace {

GltfValue transform_of(const GltfValue& texture_info) {
  return texture_info["extensions"]["KHR_texture_transform"];
}

std::uint64_t uv_set_of(const GltfValue& texture_info) {
  return transform_of(texture_info)["texCoord"].whole(texture_info["texCoord"].whole(0));
}

/// The colour of a material: of its metallic-roughness model, else of its specular-glossiness one.
struct ColorValues {
  GltfValue factor, texture;
};

ColorValues color_of(const GltfValue& material) {
  const GltfValue pbr = material["pbrMetallicRoughness"];
  const ColorValues color{pbr["baseColorFactor"], pbr["baseColorTexture"]};
  const GltfValue diffuse = material["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  if (color.factor.exists() || color.texture.exists() || !diffuse.exists()) return color;
  return {diffuse["diffuseFactor"], diffuse["diffuseTexture"]};
}

std::uint64_t uv_set_of_material(const GltfValue& material) {
  for (const GltfValue& texture :
       {color_of(material).texture, material["normalTexture"], material["emissiveTexture"]})
    if (texture.exists()) return uv_set_of(texture);
  return uv_set_of(material["pbrMetallicRoughness"]["metallicRoughnessTexture"]);
}

/// Returns the transform T * R * S of the extension KHR_texture_transform.
UvTransform uv_transform(const GltfValue& texture_info) {
  const GltfValue transform = transform_of(texture_info);
  const std::vector<double> offset = transform["offset"].numbers(2);
  const std::vector<double> scale = transform["scale"].numbers(2);
  const double sx = scale.empty() ? 1 : scale[0], sy = scale.empty() ? 1 : scale[1];
  const auto [s, c] = sine_and_cosine(transform["rotation"].number(0));
  const auto f = [](double x) { return static_cast<float>(x); };
  return {f(c * sx),
          f(s * sy),
          f(-s * sx),
          f(c * sy),
          f(offset.empty() ? 0 : offset[0]),
          f(offset.empty() ? 0 : offset[1])};
}

TextureWrap wrap_of(const GltfValue& mode) {
  constexpr std::uint64_t kClampToEdge = 33071, kMirroredRepeat = 33648;
  const std::uint64_t value = mode.whole(0);
  return value == kClampToEdge      ? TextureWrap::kClamp
         : value == kMirroredRepeat ? TextureWrap::kMirror
                                    : TextureWrap::kRepeat;
}

/// Returns the name of an image's file; empty if the image is inside the glTF file. Throws Error.
std::string file_name_of(const GltfFile& file, const GltfValue& image) {
  std::string unescaped;
  const std::string_view uri = image["uri"].text_view(unescaped);
  if (uri.empty() || is_data_uri(uri)) return "";
  return file.file_name(image, uri);
}

class MaterialReader {
 public:
  MaterialReader(const GltfFile& file, Appearance& appearance, Warnings& warnings)
      : file_(file),
        appearance_(appearance),
        warnings_(warnings),
        memory_(file.source().work().memory, 0),
        poll_(file.source().work()) {}

  void read(const Mesh& mesh) {
    const GltfItems& materials = file_.array(GltfArray::kMaterials);
    const std::size_t count = std::max<std::size_t>(mesh.materials.size(), 1);
    std::uint64_t bytes = count * sizeof(Material);
    for (const std::string& name : mesh.materials) bytes += name.size() + 1;
    add_memory(bytes);
    appearance_.materials.resize(count);
    read_images();
    // Triangles without a material have glTF's default material.
    for (Material& material : appearance_.materials) material.metallic_roughness = {1, 1};
    for (std::size_t i = 0; i < materials.size(); ++i) {
      poll_.step();
      attempt([&] { read_material(materials[i], appearance_.materials[i]); },
              "the rest of the material is ignored");
    }
  }

 private:
  void add_memory(std::uint64_t bytes) { memory_.resize(memory_.bytes() + bytes); }

  /// Runs body(). If it finds malformed data, adds a warning that names `replacement`.
  template <class Body>
  void attempt(const Body& body, const char* replacement) {
    try {
      body();
    } catch (const OverMemory&) {
      throw;
    } catch (const Error& error) {
      warnings_.add(std::string(error.what()) + ": " + replacement);
    }
  }

  void read_images() {
    const GltfItems& images = file_.array(GltfArray::kImages);
    add_memory(images.size() * sizeof(TextureImage));
    appearance_.images.reserve(images.size());
    for (const GltfValue image : images) {
      poll_.step();
      TextureImage& out = appearance_.images.emplace_back();
      out.name = file_.source().name + ": " + image.path();
      std::string file_name;
      attempt(
          [&] {
            file_name = file_name_of(file_, image);
            if (file_name.empty()) return copy_image(image, out);
            const std::filesystem::path& folder = file_.source().folder;
            out.path =
                file_.named_files().find(folder, file_name, {file_.source().name, image.path()});
            out.name = printable_path(folder, file_name);
          },
          "the image is ignored");
      add_memory(out.name.size() + 3 * out.path.native().size());
    }
  }

  /// Copies the bytes of an image inside the file.
  void copy_image(const GltfValue& image, TextureImage& out) {
    std::string unescaped;
    const std::string_view uri = image["uri"].text_view(unescaped);
    if (is_data_uri(uri)) {
      const auto decoded = decode_data_uri(uri, file_.source().work());
      if (!decoded) throw image.error("malformed data URI");
      set_bytes(decoded->bytes, out);
    } else if (uri.empty()) {
      std::optional<GltfValue> view;
      const std::string_view bytes = file_.view_bytes(image, view);
      // Images may share a buffer view, but a small file must not ask for many copies of a large
      // one.
      copied_bytes_ += bytes.size();
      if (copied_bytes_ / kMaxCopies > file_.buffer_bytes())
        throw image.error("the images in buffer views have " + std::to_string(copied_bytes_) +
                          " bytes, more than " + std::to_string(kMaxCopies) +
                          " times the bytes of all buffers");
      set_bytes(bytes, out);
    }
  }

  void set_bytes(std::string_view bytes, TextureImage& out) {
    add_memory(bytes.size());
    out.bytes.assign(bytes.begin(), bytes.end());
  }

  void read_material(const GltfValue& value, Material& material) {
    material.name = value["name"].text();
    const ColorValues color = color_of(value);
    const std::vector<double> factor = color.factor.numbers(4);
    for (int c = 0; c < 3 && !factor.empty(); ++c)
      material.base_color[c] = static_cast<float>(std::clamp(factor[c], 0.0, 1.0));
    if (!factor.empty()) material.alpha = static_cast<float>(std::clamp(factor[3], 0.0, 1.0));
    material.texture_tint = material.base_color;
    const std::string mode = value["alphaMode"].text("OPAQUE");
    material.alpha_mode = mode == "MASK"    ? AlphaMode::kMask
                          : mode == "BLEND" ? AlphaMode::kBlend
                                            : AlphaMode::kOpaque;
    material.alpha_cutoff = static_cast<float>(value["alphaCutoff"].number(0.5));
    attempt([&] { material.color_map = use(color.texture, value); },
            "the material's colour replaces the texture");
    const GltfValue normal = value["normalTexture"];
    attempt([&] { material.normal_map = use(normal, value); }, "the normal texture is ignored");
    material.normal_scale = static_cast<float>(normal["scale"].number(1));
    const std::vector<double> emissive = value["emissiveFactor"].numbers(3);
    const double strength =
        value["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"].number(1);
    for (int c = 0; c < 3 && !emissive.empty(); ++c)
      material.emission[c] = static_cast<float>(std::clamp(emissive[c] * strength, 0.0, 1e6));
    if (material.emission != Vec3f{})
      attempt([&] { material.emission_map = use(value["emissiveTexture"], value); },
              "the material does not emit");
    if (value["emissiveTexture"].exists() && !material.emission_map.exists())
      material.emission = {};
    material.metallic_roughness = {};
    attempt([&] { read_metallic_roughness(value, material); }, "the material is dull");
  }

  /// Materials of KHR_materials_pbrSpecularGlossiness alone have no such values: they are dull.
  void read_metallic_roughness(const GltfValue& value, Material& material) {
    const GltfValue pbr = value["pbrMetallicRoughness"];
    if (!pbr.exists() && value["extensions"]["KHR_materials_pbrSpecularGlossiness"].exists())
      return;
    const auto factor = [&](const char* name) {
      return static_cast<float>(std::clamp(pbr[name].number(1), 0.0, 1.0));
    };
    material.metallic_roughness = {factor("metallicFactor"), factor("roughnessFactor")};
    material.map_factors = material.metallic_roughness;
    attempt(
        [&] {
          material.metallic_map = material.roughness_map =
              use(pbr["metallicRoughnessTexture"], value);
        },
        "the material's metallicFactor and roughnessFactor replace the texture");
  }

  TextureUse use(const GltfValue& info, const GltfValue& material) const {
    TextureUse use;
    if (!info.exists()) return use;
    if (uv_set_of(info) != uv_set_of_material(material))
      throw info.error("uses other texture coordinates than the colour texture");
    const GltfValue texture = file_.item(GltfArray::kTextures, info["index"].whole(), info);
    const GltfValue webp = texture["extensions"]["EXT_texture_webp"]["source"];
    const std::uint64_t image = (webp.exists() ? webp : texture["source"]).whole();
    file_.item(GltfArray::kImages, image, texture);
    // An image that is left out had its warning.
    if (const TextureImage& named = appearance_.images[image];
        named.path.empty() && named.bytes.empty())
      return use;
    use.image = static_cast<int>(image);
    use.uv = uv_transform(info);
    if (!texture["sampler"].exists()) return use;
    const GltfValue sampler = file_.item(GltfArray::kSamplers, texture["sampler"].whole(), texture);
    use.wrap_u = wrap_of(sampler["wrapS"]);
    use.wrap_v = wrap_of(sampler["wrapT"]);
    return use;
  }

  static constexpr std::uint64_t kMaxCopies = 4;  ///< Limit on copies, in sizes of all buffers.

  const GltfFile& file_;
  Appearance& appearance_;
  Warnings& warnings_;
  MemoryReservation memory_;
  CancelPoll poll_;
  std::uint64_t copied_bytes_ = 0;
};

}  // namespace

std::uint64_t gltf_uv_set(const GltfFile& file, const GltfValue& primitive) {
  const GltfValue index = primitive["material"];
  if (!index.exists()) return 0;
  try {
    return uv_set_of_material(file.item(GltfArray::kMaterials, index.whole(), primitive));
  } catch (const Error&) {
    return 0;  // read_gltf_materials() adds a warning.
  }
}

void read_gltf_materials(const GltfFile& file, const Mesh& mesh, Appearance& appearance,
                         Warnings& warnings) {
  MaterialReader(file, appearance, warnings).read(mesh);
}

void report_gltf_images(const GltfFile& file) {
  if (file.source().options.named_files == nullptr) return;
  for (const GltfValue image : file.array(GltfArray::kImages)) try {
      const std::string name = file_name_of(file, image);
      if (!name.empty()) file.named_files().find(file.source().folder, name, {"", ""});
    } catch (const Error&) {  // The name of the file is unknown.
    }
}

}  // namespace voxdag
