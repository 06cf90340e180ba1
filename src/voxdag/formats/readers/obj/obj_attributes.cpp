#include "voxdag/formats/readers/obj/obj_attributes.hpp"

#include <array>
#include <cmath>
#include <span>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/formats/readers/plain_colors.hpp"

namespace voxdag {
namespace {

/// Parses the finite numbers at the start of a line and returns how many there are.
std::size_t parse_numbers(std::string_view line, std::span<float> numbers) {
  std::size_t count = 0;
  while (count < numbers.size() && parse_float(next_token(line), numbers[count]) &&
         std::isfinite(numbers[count]))
    ++count;
  return count;
}

/// Returns the index that a reference names, or kNone. `seen` values precede it in the file,
/// `total` are in the file.
std::uint32_t resolve(std::string_view reference, std::size_t seen, std::size_t total) {
  std::int64_t index = 0;
  if (!parse_int(reference, index)) return ObjReferences::kNone;
  if (index < 0) index += static_cast<std::int64_t>(seen) + 1;
  const bool exists = index >= 1 && static_cast<std::uint64_t>(index) <= total;
  return exists ? static_cast<std::uint32_t>(index - 1) : ObjReferences::kNone;
}

}  // namespace

ObjAttributes::ObjAttributes(const MeshSource& source, const ObjCounts& totals, bool has_colors)
    : source_(source),
      totals_(totals),
      uvs_(source.work().memory),
      normals_(source.work().memory),
      colors_(source.work().memory),
      uv_references_(source.work().memory),
      normal_references_(source.work().memory),
      results_(source.work().memory, 0) {
  if (std::max(totals.uvs, totals.normals) >= ObjReferences::kNone)
    throw source.error("the mesh has more than 4,294,967,294 texture coordinates or normals");
  uvs_.resize(totals.uvs);
  normals_.resize(totals.normals);
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  if (has_colors) colors_.resize(totals.vertices, {kNone, kNone, kNone});
  if (!uvs_.empty()) uv_references_.resize(3 * totals.triangles);
  if (!normals_.empty()) normal_references_.resize(3 * totals.triangles);
}

void ObjAttributes::set_uv(std::size_t index, std::string_view numbers) {
  std::array<float, 2> uv{};
  if (parse_numbers(numbers, uv) < 1) return;
  if (!std::isfinite(uv[1])) uv[1] = 0;
  uvs_[index] = {uv[0], 1 - uv[1]};  // In the file, v points up.
}

void ObjAttributes::set_normal(std::size_t index, std::string_view numbers) {
  std::array<float, 3> n{};
  if (parse_numbers(numbers, n) < 3) return;
  normals_[index] = normalized_or(Vec3f{n[0], n[1], n[2]}, {});
}

void ObjAttributes::set_color(std::size_t vertex, std::string_view numbers) {
  std::array<float, 3> rgb{};
  if (parse_numbers(numbers, rgb) == 3) colors_[vertex] = {rgb[0], rgb[1], rgb[2]};
}

ObjReferences ObjAttributes::parse_references(std::string_view corner, const ObjCounts& seen) {
  const auto take_part = [&corner] {
    const std::size_t size = corner.find('/');
    const std::string_view part = corner.substr(0, size);
    corner.remove_prefix(size == corner.npos ? corner.size() : size + 1);
    return part;
  };
  take_part();  // the vertex
  const std::string_view uv = take_part(), normal = take_part();
  const ObjReferences references{resolve(uv, seen.uvs, totals_.uvs),
                                 resolve(normal, seen.normals, totals_.normals)};
  if ((references.uv == ObjReferences::kNone && !uv.empty()) ||
      (references.normal == ObjReferences::kNone && !normal.empty()))
    bad_references_.fetch_add(1, std::memory_order_relaxed);
  return references;
}

void ObjAttributes::set_references(std::size_t triangle, const ObjReferences& a,
                                   const ObjReferences& b, const ObjReferences& c) {
  const ObjReferences* corners[] = {&a, &b, &c};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!uvs_.empty()) uv_references_[3 * triangle + i] = corners[i]->uv;
    if (!normals_.empty()) normal_references_[3 * triangle + i] = corners[i]->normal;
  }
}

template <class T>
void ObjAttributes::look_up(CountedVector<std::uint32_t>& references, CountedVector<T>& values,
                            std::vector<T>& result) {
  if (values.empty()) return;
  results_.resize(results_.bytes() + references.size() * sizeof(T));
  result.resize(references.size());
  parallel_for(references.size(), 65536, [&](std::size_t i) {
    if (references[i] != ObjReferences::kNone) result[i] = values[references[i]];
  });
  references = CountedVector<std::uint32_t>(source_.work().memory);
  values = CountedVector<T>(source_.work().memory);
}

void ObjAttributes::finish(Appearance& appearance) {
  look_up(uv_references_, uvs_, appearance.uvs);
  look_up(normal_references_, normals_, appearance.normals);
}

void ObjAttributes::join_colors(const Mesh& mesh, MeshWithAppearance& read) {
  float greatest = 0;
  for (const Vec3f color : colors_)
    for (int channel = 0; channel < 3; ++channel) greatest = std::max(greatest, color[channel]);
  const float scale = plain_color_scale(greatest);
  if (scale != 1) read.warnings.push_back(colors_to_255_warning(source_.name));
  parallel_for(colors_.size(), 65536, [&](std::size_t v) {
    const Vec3f srgb = colors_[v] * scale;
    colors_[v] = {srgb_to_linear(srgb.x), srgb_to_linear(srgb.y), srgb_to_linear(srgb.z)};
  });
  const auto has_color = [&](std::uint32_t vertex) { return !std::isnan(colors_[vertex].x); };
  std::vector<Material>& materials = read.appearance.materials;
  std::vector<Rgba16>& colors = read.appearance.colors;
  std::vector<char> is_colored(materials.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const std::uint32_t vertex : mesh.triangles[t])
      if (has_color(vertex)) is_colored[Appearance::material_index(mesh, t)] = 1;
  results_.resize(results_.bytes() + 3 * mesh.triangles.size() * sizeof(Rgba16));
  colors.resize(3 * mesh.triangles.size());
  parallel_for(mesh.triangles.size(), 65536, [&](std::size_t t) {
    const std::uint32_t m = Appearance::material_index(mesh, t);
    // Colours multiply the material's colour, which becomes white below.
    const bool replaces_base = is_colored[m] != 0 && !materials[m].color_map.exists();
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t vertex = mesh.triangles[t][c];
      if (has_color(vertex))
        colors[3 * t + c] = to_rgba16(colors_[vertex], 1);
      else if (replaces_base)
        colors[3 * t + c] = to_rgba16(materials[m].base_color, 1);
    }
  });
  for (std::size_t m = 0; m < materials.size(); ++m)
    if (is_colored[m] != 0) materials[m].base_color = {1, 1, 1};
}

}  // namespace voxdag
