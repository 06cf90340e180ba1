#include "voxdag/formats/readers/ply/ply_attributes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/readers/named_files.hpp"
#include "voxdag/formats/readers/plain_colors.hpp"
#include "voxdag/formats/readers/ply/ply_color.hpp"
#include "voxdag/formats/readers/warnings.hpp"

namespace voxdag {
namespace {

using Slot = PlyRowValues::Slot;

void set_slots(PlyColumns& columns, const std::vector<int>& properties, Slot first) {
  for (std::size_t i = 0; i < properties.size(); ++i)
    columns.slots[properties[i]] = first + static_cast<int>(i);
}

void find_color(const PlyElement& element, PlyColumns& columns) {
  std::vector<int> found = find_ply_color(element);
  if (found.empty()) {
    found = find_splat_color(element);
    columns.is_splat = !found.empty();
  }
  set_slots(columns, found, Slot::kRed);
  columns.color_components = static_cast<int>(found.size());
}

void find_uv(const PlyElement& element, PlyColumns& columns) {
  for (const auto& names :
       {std::array{"s", "t"}, std::array{"u", "v"}, std::array{"texture_u", "texture_v"},
        std::array{"texture_s", "texture_t"}}) {
    const std::vector<int> found = find_ply_scalars(element, {names[0], names[1]});
    if (found.empty()) continue;
    set_slots(columns, found, Slot::kU);
    columns.has_uvs = true;
    return;
  }
}

void find_normal(const PlyElement& element, PlyColumns& columns) {
  const std::vector<int> found = find_ply_scalars(element, {"nx", "ny", "nz"});
  set_slots(columns, found, Slot::kNormalX);
  columns.has_normals = !found.empty();
}

/// Converts texture coordinates: in the file, v points up.
Vec2f to_uv(float u, float v) {
  return std::isfinite(u) && std::isfinite(v) ? Vec2f{u, 1 - v} : Vec2f{};
}

/// Returns whether programs write colours of this type both with its greatest value and with 255 as
/// white.
bool is_range_unsure(PlyType type) {
  return !is_integer(type) || type == PlyType::kInt16 || type == PlyType::kUint16;
}

}  // namespace

PlyAttributes::PlyAttributes(const MeshSource& source, const PlyHeader& header,
                             const PlyFields& fields, bool to_255)
    : source_(source),
      header_(header),
      vertex_colors_(source.work().memory),
      vertex_normals_(source.work().memory),
      vertex_uvs_(source.work().memory),
      memory_(source.work().memory, 0) {
  vertex_.slots.assign(fields.vertex.properties.size(), -1);
  face_.slots.assign(fields.face.properties.size(), -1);
  find_color(fields.vertex, vertex_);
  find_normal(fields.vertex, vertex_);
  find_uv(fields.vertex, vertex_);
  if (vertex_.color_components == 0) find_color(fields.face, face_);
  const int list = fields.face.find({"texcoord"});
  if (!vertex_.has_uvs && list >= 0 && fields.face.properties[list].count_type)
    face_.texcoord = list;
  const PlyElement& colored = vertex_.color_components > 0 ? fields.vertex : fields.face;
  const PlyColumns& columns = vertex_.color_components > 0 ? vertex_ : face_;
  for (std::size_t p = 0; p < columns.slots.size(); ++p)
    if (columns.slots[p] >= Slot::kRed && columns.slots[p] <= Slot::kAlpha) {
      const PlyType type = colored.properties[p].type;
      color_scales_[columns.slots[p]] = columns.is_splat ? static_cast<float>(kHarmonic)
                                        : to_255 && is_range_unsure(type) ? 1.0f / 255
                                                                          : ply_color_scale(type);
      if (columns.slots[p] == Slot::kRed) color_type_ = type;
    }
  if (columns.is_splat) color_offset_ = kSplatMiddle;
}

void PlyAttributes::resize_vertices(std::size_t count) {
  if (vertex_.color_components > 0) vertex_colors_.resize(count);
  if (vertex_.has_normals) vertex_normals_.resize(count);
  if (vertex_.has_uvs) vertex_uvs_.resize(count);
}

void PlyAttributes::resize_triangles(std::size_t count) {
  const bool has_colors = vertex_.color_components > 0 || face_.color_components > 0;
  const bool has_uvs = vertex_.has_uvs || face_.texcoord >= 0;
  memory_.resize(3 * count *
                 ((has_colors ? sizeof(Rgba16) : 0) + (vertex_.has_normals ? sizeof(Vec3f) : 0) +
                  (has_uvs ? sizeof(Vec2f) : 0)));
  if (has_colors) appearance_.colors.resize(3 * count);
  if (vertex_.has_normals) appearance_.normals.resize(3 * count);
  if (has_uvs) appearance_.uvs.resize(3 * count);
}

Rgba16 PlyAttributes::color_of(const PlyColumns& columns, const PlyRowValues& row) {
  std::array<float, 4> rgba{0, 0, 0, 1};
  for (std::size_t c = 0; c < static_cast<std::size_t>(columns.color_components); ++c)
    rgba[c] = row.scalars[c] * color_scales_[c] + color_offset_;
  if (is_range_unsure(color_type_)) {
    const float most = std::max({rgba[0], rgba[1], rgba[2]});
    float greatest = greatest_.load(std::memory_order_relaxed);
    while (most > greatest && !greatest_.compare_exchange_weak(greatest, most)) {
    }
  }
  return from_srgb({rgba[0], rgba[1], rgba[2]}, rgba[3]);
}

bool PlyAttributes::go_to_255() const {
  if (vertex_.is_splat || face_.is_splat) return false;
  if (!is_integer(color_type_)) return plain_color_scale(greatest_) != 1;
  return is_range_unsure(color_type_) && greatest_ > 0 &&
         greatest_ <= 255 * ply_color_scale(color_type_);
}

void PlyAttributes::take_vertex(std::size_t index, const PlyRowValues& row) {
  if (vertex_.color_components > 0) vertex_colors_[index] = color_of(vertex_, row);
  if (vertex_.has_normals) {
    const Vec3f n{row.scalars[Slot::kNormalX], row.scalars[Slot::kNormalY],
                  row.scalars[Slot::kNormalZ]};
    vertex_normals_[index] = normalized_or(n, {});
  }
  if (vertex_.has_uvs) vertex_uvs_[index] = to_uv(row.scalars[Slot::kU], row.scalars[Slot::kV]);
}

Rgba16 PlyAttributes::face_color(const PlyRowValues& row) {
  return face_.color_components > 0 ? color_of(face_, row) : Rgba16{};
}

void PlyAttributes::take_triangle(std::size_t index, const Triangle& corners, Rgba16 face_color,
                                  std::span<const float> texcoord) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (face_.color_components > 0) appearance_.colors[3 * index + c] = face_color;
    if (!texcoord.empty())
      appearance_.uvs[3 * index + c] =
          to_uv(texcoord[2 * corners[c]], texcoord[2 * corners[c] + 1]);
  }
}

Appearance PlyAttributes::finish(const Mesh& mesh, std::vector<std::string>& warnings) {
  read_materials(mesh, warnings);
  if (vertex_.is_used() || face_.is_used()) ignore_alpha_that_hides_all();
  if (vertex_.is_used())
    parallel_for(mesh.triangles.size(), 65536, [&](std::size_t t) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t vertex = mesh.triangles[t][c];
        if (!vertex_colors_.empty()) appearance_.colors[3 * t + c] = vertex_colors_[vertex];
        if (!vertex_normals_.empty()) appearance_.normals[3 * t + c] = vertex_normals_[vertex];
        if (!vertex_uvs_.empty()) appearance_.uvs[3 * t + c] = vertex_uvs_[vertex];
      }
    });
  return std::move(appearance_);
}

void PlyAttributes::read_materials(const Mesh& mesh, std::vector<std::string>& warnings) {
  std::vector<Material>& materials = appearance_.materials;
  const std::size_t count = std::max<std::size_t>(mesh.materials.size(), 1);
  std::uint64_t bytes = memory_.bytes() + count * sizeof(Material);
  for (const std::string& name : mesh.materials) bytes += name.size() + 1;
  memory_.resize(bytes);
  materials.resize(count);
  for (std::size_t i = 0; i < mesh.materials.size(); ++i) materials[i].name = mesh.materials[i];

  const bool has_uvs = vertex_.has_uvs || face_.texcoord >= 0;
  if (!header_.textures.empty() && !has_uvs)
    warnings.push_back(source_.name + ": texture " + name_in_quotes(header_.textures[0]) +
                       " is ignored: the mesh has no texture coordinates");
  const bool by_number = header_.has_texture_numbers && !mesh.triangle_materials.empty();
  if (header_.textures.size() > 1 && has_uvs && !by_number)
    warnings.push_back(source_.name + ": only the first of " +
                       std::to_string(header_.textures.size()) + " textures is used");
  if (bad_textures_ > 0)
    warnings.push_back(source_.name + ": " + counted(bad_textures_, "face") +
                       " with the number of a texture that does not exist: without a texture");
  const std::size_t used = !has_uvs || header_.textures.empty() ? 0
                           : by_number                          ? header_.textures.size()
                                                                : 1;
  std::vector<int> images(used, -1);  // by texture
  const NamedFiles files(source_);
  for (std::size_t i = 0; i < used; ++i) try {
      const std::string_view name = header_.textures[i];
      const std::filesystem::path path =
          files.find(source_.folder, name, {source_.name, "comment TextureFile"});
      images[i] = static_cast<int>(appearance_.images.size());
      appearance_.images.push_back({printable_path(source_.folder, name), path, {}});
    } catch (const Error& error) {
      warnings.push_back(std::string(error.what()) + ": the texture is ignored");
    }
  if (auto warning = files.warning(source_.name)) warnings.push_back(std::move(*warning));
  const int components = std::max(vertex_.color_components, face_.color_components);
  for (Material& material : materials) {
    const auto number = by_number ? static_cast<std::size_t>(&material - materials.data()) : 0;
    if (number < used) material.color_map.image = images[number];
    if (components == 4) material.alpha_mode = AlphaMode::kBlend;
    if (components == 0) material.base_color = kDefaultColor;
  }
}

/// Makes all materials opaque if every colour would be invisible: some programs write an alpha of 0
/// everywhere without meaning it.
void PlyAttributes::ignore_alpha_that_hides_all() {
  const auto is_visible = [](Rgba16 color) { return color.alpha() >= kBlendCutoff; };
  if (std::any_of(vertex_colors_.begin(), vertex_colors_.end(), is_visible) ||
      (vertex_colors_.empty() &&
       std::any_of(appearance_.colors.begin(), appearance_.colors.end(), is_visible)))
    return;
  for (Material& material : appearance_.materials) material.alpha_mode = AlphaMode::kOpaque;
}

}  // namespace voxdag
