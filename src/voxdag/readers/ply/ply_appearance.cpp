/// One sequential pass over the rows of vertices and faces. The reader of the mesh has checked them
/// all.
#include "voxdag/readers/ply/ply_appearance.hpp"

#include <array>
#include <bit>

#include "voxdag/image/color.hpp"
#include "voxdag/readers/ply/ply_layout.hpp"
#include "voxdag/readers/ply/ply_rows.hpp"

namespace voxdag {
namespace {

/// The properties of an element that hold one attribute, in order; empty if any is missing.
std::vector<std::size_t> find_all(const PlyElement& element,
                                  std::initializer_list<std::string_view> names) {
  std::vector<std::size_t> found;
  for (const std::string_view name : names) {
    const int property = element.find({name});
    if (property < 0 || element.properties[static_cast<std::size_t>(property)].count_type)
      return {};
    found.push_back(static_cast<std::size_t>(property));
  }
  return found;
}

std::vector<std::size_t> find_color(const PlyElement& element) {
  for (const auto& names :
       {std::array{"red", "green", "blue", "alpha"},
        std::array{"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
        std::array{"r", "g", "b", "a"}}) {
    std::vector<std::size_t> found = find_all(element, {names[0], names[1], names[2]});
    if (found.empty()) continue;
    const std::vector<std::size_t> alpha = find_all(element, {names[3]});
    found.insert(found.end(), alpha.begin(), alpha.end());
    return found;
  }
  return {};
}

std::vector<std::size_t> find_uv(const PlyElement& element) {
  for (const auto& names :
       {std::array{"s", "t"}, std::array{"u", "v"}, std::array{"texture_u", "texture_v"},
        std::array{"texture_s", "texture_t"}}) {
    std::vector<std::size_t> found = find_all(element, {names[0], names[1]});
    if (!found.empty()) return found;
  }
  return {};
}

/// What turns a colour's component into 0..1.
float color_scale(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1.0f / 255;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 1.0f / 65535;
    default:
      return is_integer(type) ? 1.0f / 255 : 1.0f;
  }
}

class PlyAppearanceReader {
 public:
  PlyAppearanceReader(const MeshBytes& source, const Mesh& mesh, std::vector<std::string>& warnings)
      : source_(source),
        mesh_(mesh),
        warnings_(warnings),
        header_(parse_ply_header(source)),
        fields_(header_),
        colors_(find_color(fields_.vertex)),
        normals_(find_all(fields_.vertex, {"nx", "ny", "nz"})),
        uvs_(find_uv(fields_.vertex)),
        face_colors_(colors_.empty() ? find_color(fields_.face) : std::vector<std::size_t>()) {
    const int list = fields_.face.find({"texcoord"});
    if (uvs_.empty() && list >= 0 &&
        fields_.face.properties[static_cast<std::size_t>(list)].count_type)
      face_uvs_ = list;
  }

  Appearance read() {
    read_materials();
    const bool reads_vertices = !colors_.empty() || !normals_.empty() || !uvs_.empty();
    const bool reads_faces = !face_colors_.empty() || face_uvs_ >= 0;
    if (!reads_vertices && !reads_faces) return std::move(appearance_);
    if (!colors_.empty()) vertex_colors_.resize(mesh_.vertices.size());
    if (!normals_.empty()) vertex_normals_.resize(mesh_.vertices.size());
    if (!uvs_.empty()) vertex_uvs_.resize(mesh_.vertices.size());
    const std::size_t corners = 3 * mesh_.triangles.size();
    if (!colors_.empty() || !face_colors_.empty()) appearance_.colors.resize(corners);
    if (!normals_.empty()) appearance_.normals.resize(corners);
    if (!uvs_.empty() || face_uvs_ >= 0) appearance_.uvs.resize(corners);
    for_each_row([this](const PlyElement& element, std::size_t row, const auto& values) {
      if (&element == &fields_.vertex)
        take_vertex(row, values);
      else if (&element == &fields_.face)
        take_face(values);
    });
    ignore_alpha_that_hides_all();
    for (std::size_t c = 0; c < corners; ++c) {
      const std::uint32_t vertex = mesh_.triangles[c / 3][c % 3];
      if (!colors_.empty()) appearance_.colors[c] = vertex_colors_[vertex];
      if (!normals_.empty()) appearance_.normals[c] = vertex_normals_[vertex];
      if (!uvs_.empty()) appearance_.uvs[c] = vertex_uvs_[vertex];
    }
    return std::move(appearance_);
  }

 private:
  /// The values of a row by property; lists after one another's items.
  using Row = std::vector<std::vector<float>>;

  void read_materials() {
    appearance_.materials.resize(std::max<std::size_t>(mesh_.materials.size(), 1));
    for (std::size_t i = 0; i < mesh_.materials.size(); ++i)
      appearance_.materials[i].name = mesh_.materials[i];
    const bool has_uvs = !uvs_.empty() || face_uvs_ >= 0;
    if (!header_.textures.empty() && !has_uvs)
      warnings_.push_back(source_.name + ": texture '" + header_.textures[0] +
                          "' is left out: there are no texture coordinates");
    if (header_.textures.size() > 1 && has_uvs)
      warnings_.push_back(source_.name + ": only the first of " +
                          std::to_string(header_.textures.size()) + " textures is used");
    const bool is_textured = has_uvs && !header_.textures.empty();
    if (is_textured) {
      const std::filesystem::path path = source_.folder / header_.textures[0];
      appearance_.images.push_back({path.string(), path, {}});
    }
    for (Material& material : appearance_.materials) {
      if (is_textured) material.color_map.image = 0;
      const std::size_t components = std::max(colors_.size(), face_colors_.size());
      if (components == 4) material.alpha_mode = AlphaMode::kBlend;
      if (components == 0) material.base_color = kDefaultColor;
    }
  }

  /// Calls body(element, row, values) for all rows up to the last that is needed.
  template <class Body>
  void for_each_row(const Body& body) {
    std::string_view rest = source_.bytes.substr(header_.body);
    const bool swap =
        (header_.format == PlyFormat::kBigEndian) != (std::endian::native == std::endian::big);
    const char* released = rest.data();
    for (const PlyElement& element : header_.elements) {
      Row values(element.properties.size());
      if (element.properties.empty()) continue;
      const RowLayout layout(element);
      for (std::size_t row = 0; row < element.count; ++row) {
        if (header_.format == PlyFormat::kAscii)
          take_text(element, rest, values);
        else
          take_binary(element, layout, swap, rest, values);
        body(element, row, values);
        if (static_cast<std::size_t>(rest.data() - released) < kChunkBytes) continue;
        source_.done_with({released, static_cast<std::size_t>(rest.data() - released)},
                          "read attributes");
        released = rest.data();
      }
    }
  }

  void take_text(const PlyElement& element, std::string_view& rest, Row& values) const {
    std::string_view line;
    while (!rest.empty() && trim(line = next_line(rest, header_.line_end)).empty()) {
    }
    for (std::size_t p = 0; p < values.size(); ++p) {
      std::int64_t items = 1;
      if (element.properties[p].count_type) parse_int(next_token(line), items);
      values[p].clear();
      for (; items > 0 && !line.empty(); --items) {
        float value = 0;
        parse_float(next_token(line), value);
        values[p].push_back(value);
      }
    }
  }

  static void take_binary(const PlyElement& element, const RowLayout& layout, bool swap,
                          std::string_view& rest, Row& values) {
    std::size_t p = 0;
    const char* const end = rest.data() + rest.size();
    const char* const row_end = layout.walk(
        rest.data(), end, swap, [&](std::size_t run, const char* fixed, std::size_t items) {
          for (; p < values.size() && layout.places[p].run == run; ++p) {
            const PlyProperty& property = element.properties[p];
            const char* at = fixed + layout.places[p].offset;
            if (property.count_type) at += size_of(*property.count_type);
            values[p].resize(property.count_type ? items : 1);
            for (float& value : values[p]) {
              value = load_float(property.type, at, swap);
              at += size_of(property.type);
            }
          }
        });
    rest.remove_prefix(static_cast<std::size_t>(row_end - rest.data()));
  }

  /// Some programs write an alpha of 0 everywhere and mean nothing by it.
  void ignore_alpha_that_hides_all() {
    const auto is_visible = [](Rgba16 color) { return color.alpha() >= kBlendCutoff; };
    if (std::any_of(vertex_colors_.begin(), vertex_colors_.end(), is_visible) ||
        (vertex_colors_.empty() &&
         std::any_of(appearance_.colors.begin(), appearance_.colors.end(), is_visible)))
      return;
    for (Material& material : appearance_.materials) material.alpha_mode = AlphaMode::kOpaque;
  }

  static float value_of(const Row& values, std::size_t property) {
    return values[property].empty() ? 0.0f : values[property][0];
  }

  static Rgba16 color_of(const PlyElement& element, const std::vector<std::size_t>& properties,
                         const Row& values) {
    std::array<float, 4> rgba{0, 0, 0, 1};
    for (std::size_t c = 0; c < properties.size(); ++c)
      rgba[c] =
          value_of(values, properties[c]) * color_scale(element.properties[properties[c]].type);
    return to_rgba16({srgb_to_linear(rgba[0]), srgb_to_linear(rgba[1]), srgb_to_linear(rgba[2])},
                     rgba[3]);
  }

  void take_vertex(std::size_t row, const Row& values) {
    if (!colors_.empty()) vertex_colors_[row] = color_of(fields_.vertex, colors_, values);
    if (!normals_.empty()) {
      const Vec3f n{value_of(values, normals_[0]), value_of(values, normals_[1]),
                    value_of(values, normals_[2])};
      vertex_normals_[row] = normalized_or(n, {});
    }
    if (!uvs_.empty())
      vertex_uvs_[row] = uv_of(value_of(values, uvs_[0]), value_of(values, uvs_[1]));
  }

  /// The file's v runs up.
  static Vec2f uv_of(float u, float v) {
    return std::isfinite(u) && std::isfinite(v) ? Vec2f{u, 1 - v} : Vec2f{};
  }

  void take_face(const Row& values) {
    const std::vector<float>& corners = values[static_cast<std::size_t>(fields_.indices)];
    const std::size_t count = corners.size() < 3 ? 0 : corners.size() - 2;
    for (std::size_t n = 0; n < count; ++n, ++triangle_) {
      for (std::size_t c = 0; c < 3 && !face_colors_.empty(); ++c)
        appearance_.colors[3 * triangle_ + c] = color_of(fields_.face, face_colors_, values);
      if (face_uvs_ < 0) continue;
      const std::vector<float>& uvs = values[static_cast<std::size_t>(face_uvs_)];
      // Polygons have been cut by now: only of triangles is it known which corner is which.
      if (count == 1 && uvs.size() == 6)
        for (std::size_t c = 0; c < 3; ++c)
          appearance_.uvs[3 * triangle_ + c] = uv_of(uvs[2 * c], uvs[2 * c + 1]);
    }
  }

  const MeshBytes& source_;
  const Mesh& mesh_;
  std::vector<std::string>& warnings_;
  const PlyHeader header_;
  const PlyFields fields_;
  std::vector<std::size_t> colors_, normals_, uvs_, face_colors_;  ///< Properties.
  int face_uvs_ = -1;
  std::vector<Rgba16> vertex_colors_;
  std::vector<Vec3f> vertex_normals_;
  std::vector<Vec2f> vertex_uvs_;
  std::size_t triangle_ = 0;
  Appearance appearance_;
};

}  // namespace

Appearance read_ply_appearance(const MeshBytes& source, const Mesh& mesh,
                               std::vector<std::string>& warnings) {
  return PlyAppearanceReader(source, mesh, warnings).read();
}

}  // namespace voxdag
