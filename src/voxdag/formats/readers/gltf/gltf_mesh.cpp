#include "voxdag/formats/readers/gltf/gltf_mesh.hpp"

#include <map>

#include "voxdag/formats/readers/gltf/gltf_materials.hpp"

namespace voxdag {
namespace {

std::uint64_t triangle_count(std::uint64_t mode, std::uint64_t corners) {
  if (mode == kGltfTriangles) return corners / 3;
  return corners < 3 ? 0 : corners - 2;
}

/// Returns an attribute of a primitive; null if there is none or a malformed one.
const GltfAccessor* find_attribute(const GltfFile& file, const GltfPrimitive& primitive,
                                   const std::string& name, GltfAccessors& accessors,
                                   int components, int or_components, const char* what,
                                   Warnings& warnings) {
  try {
    const GltfValue index = primitive.value["attributes"][name.c_str()];
    if (!index.exists()) return nullptr;
    const GltfValue accessor = file.item(GltfArray::kAccessors, index.whole(), primitive.value);
    if (gltf_count(accessor) != primitive.positions->size())
      throw accessor.error(name + " of " + std::to_string(gltf_count(accessor)) + " elements for " +
                           std::to_string(primitive.positions->size()) + " vertices");
    return &accessors.attributes(index.whole(), primitive.value, components, or_components, what);
  } catch (const OverMemory&) {
    throw;
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    warnings.add(std::string(error.what()) + ": " + name + " is ignored");
    return nullptr;
  }
}

void find_attributes(const GltfFile& file, GltfPrimitive& primitive, GltfAccessors& accessors,
                     Warnings& warnings) {
  primitive.normals =
      find_attribute(file, primitive, "NORMAL", accessors, 3, 3, "normals", warnings);
  const std::string set = "TEXCOORD_" + std::to_string(gltf_uv_set(file, primitive.value));
  primitive.uvs =
      find_attribute(file, primitive, set, accessors, 2, 2, "texture coordinates", warnings);
  primitive.colors =
      find_attribute(file, primitive, "COLOR_0", accessors, 3, 4, "colours", warnings);
}

/// Returns whether an accessor has no elements, which is not allowed and means an empty primitive.
bool is_empty(const GltfFile& file, const GltfValue& primitive, const GltfValue& index) {
  return index.exists() &&
         file.item(GltfArray::kAccessors, index.whole(), primitive)["count"].whole(1) == 0;
}

/// The accessors that decide the positions of a primitive's vertices. Equal ones share them.
using VertexArrays = std::array<std::uint64_t, 3>;

VertexArrays vertices_of(const GltfValue& primitive) {
  constexpr std::uint64_t kNone = ~std::uint64_t{0};
  const GltfItems targets = primitive["targets"].items();
  return {primitive["attributes"]["POSITION"].whole(),
          primitive["attributes"]["JOINTS_0"].whole(kNone),
          targets.empty() ? kNone : targets[0]["POSITION"].whole(kNone)};
}

std::uint32_t material_of(const GltfFile& file, const GltfValue& primitive) {
  const GltfValue material = primitive["material"];
  if (!material.exists())
    return static_cast<std::uint32_t>(file.array(GltfArray::kMaterials).size());
  file.item(GltfArray::kMaterials, material.whole(), primitive);
  return static_cast<std::uint32_t>(material.whole());
}

}  // namespace

GltfMesh compile_gltf_mesh(const GltfFile& file, const GltfValue& mesh, GltfAccessors& accessors,
                           Warnings* warnings) {
  using Start = std::pair<const VertexArrays, std::uint32_t>;
  MemoryBudget* const memory = file.source().work().memory;
  std::map<VertexArrays, std::uint32_t, std::less<>, CountedAllocator<Start>> starts(
      (CountedAllocator<Start>(memory)));
  GltfMesh result(memory);
  CancelPoll poll(file.source().work());
  for (const GltfValue value : mesh["primitives"].items()) {
    poll.step();
    GltfPrimitive primitive{.value = value};
    primitive.mode = value["mode"].whole(kGltfTriangles);
    if (primitive.mode > kGltfFan)
      throw value.error("mode " + std::to_string(primitive.mode) +
                        " is unknown: the modes are 0 to 6");
    const GltfValue position = value["attributes"]["POSITION"];
    if (primitive.mode < kGltfTriangles || !position.exists()) continue;
    if (is_empty(file, value, position) || is_empty(file, value, value["indices"])) continue;
    const std::uint64_t index = position.whole();
    accessors.decode_draco(value);
    primitive.positions = &accessors.positions(index, value);
    const auto [start, is_new] =
        starts.try_emplace(vertices_of(value), static_cast<std::uint32_t>(result.vertices));
    primitive.first_vertex = start->second;
    primitive.adds_vertices = is_new;
    const GltfValue indices = value["indices"];
    if (indices.exists()) primitive.indices = &accessors.indices(indices.whole(), value);
    const GltfAccessor& corners = indices.exists() ? *primitive.indices : *primitive.positions;
    primitive.triangles = triangle_count(primitive.mode, corners.size());
    primitive.material = material_of(file, value);
    result.has_default_material |= !value["material"].exists();
    if (!primitive.adds_vertices && primitive.triangles == 0) continue;
    if (warnings != nullptr && primitive.triangles > 0)
      find_attributes(file, primitive, accessors, *warnings);
    if (is_new) result.vertices += primitive.positions->size();
    result.triangles += primitive.triangles;
    if (result.vertices >= 0xFFFFFFFF)
      throw file.source().error("the mesh has more than 4,294,967,294 vertices");
    result.primitives.push_back(primitive);
  }
  return result;
}

}  // namespace voxdag
