#include "voxdag/readers/gltf/gltf_materials.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {
namespace {

GltfValue transform_of(const GltfValue& texture_info) {
  return texture_info["extensions"]["KHR_texture_transform"];
}

std::uint64_t uv_set_of(const GltfValue& texture_info) {
  return transform_of(texture_info)["texCoord"].whole(texture_info["texCoord"].whole(0));
}

GltfValue color_texture(const GltfValue& material) {
  return material["pbrMetallicRoughness"]["baseColorTexture"];
}

std::uint64_t uv_set_of_material(const GltfValue& material) {
  const GltfValue color = color_texture(material);
  return uv_set_of(color.exists() ? color : material["normalTexture"]);
}

/// T * R * S of the extension's specification.
UvTransform uv_transform(const GltfValue& texture_info) {
  const GltfValue transform = transform_of(texture_info);
  const std::vector<double> offset = transform["offset"].numbers(2);
  const std::vector<double> scale = transform["scale"].numbers(2);
  const double sx = scale.empty() ? 1 : scale[0], sy = scale.empty() ? 1 : scale[1];
  const double angle = transform["rotation"].number(0);
  const double c = std::cos(angle), s = std::sin(angle);
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

class MaterialReader {
 public:
  MaterialReader(const MeshSource& source, const GltfFile& file, Appearance& appearance,
                 std::vector<std::string>& warnings)
      : source_(source), file_(file), appearance_(appearance), warnings_(warnings) {}

  void read(const Mesh& mesh) {
    const auto& materials = file_.array("materials");
    appearance_.materials.resize(std::max<std::size_t>(mesh.materials.size(), 1));
    read_images();
    for (std::size_t i = 0; i < materials.size(); ++i)
      attempt([&] { read_material(materials[i], appearance_.materials[i]); }, "is left out");
  }

 private:
  template <class Body>
  void attempt(const Body& body, const char* otherwise) {
    try {
      body();
    } catch (const Error& error) {
      warnings_.push_back(std::string(error.what()) + ": " + otherwise);
    }
  }

  void read_images() {
    for (const GltfValue& image : file_.array("images")) {
      TextureImage& out = appearance_.images.emplace_back();
      attempt([&] { read_image(image, out); }, "the image is left out");
    }
  }

  void read_image(const GltfValue& image, TextureImage& out) {
    out.name = image.error("").what();
    out.name.resize(out.name.find_last_not_of(": ") + 1);
    const std::string uri = image["uri"].text();
    if (uri.empty()) {
      const GltfValue& view = file_.item("bufferViews", image["bufferView"].whole(), image);
      const std::uint64_t index = view["buffer"].whole();
      file_.item("buffers", index, view);
      const std::string_view bytes = file_.buffer(index).bytes;
      const std::uint64_t offset = view["byteOffset"].whole(0), size = view["byteLength"].whole();
      if (offset > bytes.size() || size > bytes.size() - offset)
        throw view.error("buffer view goes beyond its buffer");
      const std::string_view part = bytes.substr(offset, size);
      out.bytes.assign(part.begin(), part.end());
    } else if (uri.starts_with("data:")) {
      const auto decoded = GltfFile::decode_data_uri(uri);
      if (!decoded) throw image.error("malformed data URI");
      out.bytes.assign(decoded->begin(), decoded->end());
    } else {
      if (uri.find("://") != uri.npos) throw image.error("image in another place than a file");
      out.path = source_.folder / GltfFile::decode_uri(uri);
      out.name = out.path.string();
    }
  }

  void read_material(const GltfValue& value, Material& material) {
    material.name = value["name"].text();
    const GltfValue pbr = value["pbrMetallicRoughness"];
    const std::vector<double> factor = pbr["baseColorFactor"].numbers(4);
    for (int c = 0; c < 3 && !factor.empty(); ++c)
      material.base_color[c] =
          static_cast<float>(std::clamp(factor[static_cast<std::size_t>(c)], 0.0, 1.0));
    if (!factor.empty()) material.alpha = static_cast<float>(std::clamp(factor[3], 0.0, 1.0));
    material.texture_tint = material.base_color;
    const std::string mode = value["alphaMode"].text("OPAQUE");
    material.alpha_mode = mode == "MASK"    ? AlphaMode::kMask
                          : mode == "BLEND" ? AlphaMode::kBlend
                                            : AlphaMode::kOpaque;
    material.alpha_cutoff = static_cast<float>(value["alphaCutoff"].number(0.5));
    attempt([&] { material.color_map = use(color_texture(value), value); },
            "the material's colour stands in");
    const GltfValue normal = value["normalTexture"];
    attempt([&] { material.normal_map = use(normal, value); }, "normals go without it");
    material.normal_scale = static_cast<float>(normal["scale"].number(1));
  }

  TextureUse use(const GltfValue& info, const GltfValue& material) const {
    TextureUse use;
    if (!info.exists()) return use;
    if (uv_set_of(info) != uv_set_of_material(material))
      throw info.error("uses other texture coordinates than the colour texture");
    const GltfValue& texture = file_.item("textures", info["index"].whole(), info);
    const std::uint64_t image = texture["source"].whole();
    file_.item("images", image, texture);
    use.image = static_cast<int>(image);
    use.uv = uv_transform(info);
    if (!texture["sampler"].exists()) return use;
    const GltfValue& sampler = file_.item("samplers", texture["sampler"].whole(), texture);
    use.wrap_u = wrap_of(sampler["wrapS"]);
    use.wrap_v = wrap_of(sampler["wrapT"]);
    return use;
  }

  const MeshSource& source_;
  const GltfFile& file_;
  Appearance& appearance_;
  std::vector<std::string>& warnings_;
};

}  // namespace

std::uint64_t gltf_uv_set(const GltfFile& file, const GltfValue& primitive) {
  const GltfValue index = primitive["material"];
  if (!index.exists()) return 0;
  try {
    return uv_set_of_material(file.item("materials", index.whole(), primitive));
  } catch (const Error&) {
    return 0;  // read_gltf_materials says what is wrong.
  }
}

void read_gltf_materials(const MeshSource& source, const GltfFile& file, const Mesh& mesh,
                         Appearance& appearance, std::vector<std::string>& warnings) {
  MaterialReader(source, file, appearance, warnings).read(mesh);
}

}  // namespace voxdag
