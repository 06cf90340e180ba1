#include "voxdag/readers/read_appearance.hpp"

#include <algorithm>
#include <new>

#include "voxdag/readers/gltf/gltf_reader.hpp"
#include "voxdag/readers/obj/obj_appearance.hpp"
#include "voxdag/readers/obj/obj_reader.hpp"
#include "voxdag/readers/ply/ply_appearance.hpp"
#include "voxdag/readers/ply/ply_reader.hpp"
#include "voxdag/readers/read_mesh.hpp"

namespace voxdag {
namespace {

/// Of a format that gives names of materials at most.
Appearance grey(const Mesh& mesh) {
  Appearance appearance;
  appearance.materials.resize(std::max<std::size_t>(mesh.materials.size(), 1));
  for (Material& material : appearance.materials) material.base_color = kDefaultColor;
  for (std::size_t i = 0; i < mesh.materials.size(); ++i)
    appearance.materials[i].name = mesh.materials[i];
  return appearance;
}

}  // namespace

MeshWithAppearance read_mesh_with_appearance(const std::filesystem::path& path,
                                             Progress* progress) {
  const MappedFile file(path, MappedFile::Access::kSequential);
  const MeshBytes source{file.text(), path.string(), path.parent_path(), progress, &file};
  if (source.bytes.empty()) throw source.error("the file is empty");
  MeshWithAppearance result;
  try {
    switch (detect_mesh_format(source.bytes, path.extension().string())) {
      case MeshFormat::kObj:
        result.mesh = read_obj(source);
        result.appearance = read_obj_appearance(source, result.mesh, result.warnings);
        break;
      case MeshFormat::kPly:
        result.mesh = read_ply(source);
        result.appearance = read_ply_appearance(source, result.mesh, result.warnings);
        break;
      case MeshFormat::kGltf:
        result = read_gltf_with_appearance(source);
        break;
      case MeshFormat::kStl:
      case MeshFormat::kOff:
      case MeshFormat::kOther:
        result.mesh = read_mesh(path, progress);
        result.appearance = grey(result.mesh);
        break;
    }
  } catch (const std::bad_alloc&) {
    throw source.error("not enough memory for this mesh");
  }
  return result;
}

}  // namespace voxdag
