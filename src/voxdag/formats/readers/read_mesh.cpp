#include "voxdag/formats/readers/read_mesh.hpp"

#include <algorithm>
#include <new>

#include "voxdag/formats/input_file.hpp"
#include "voxdag/formats/readers/assimp/assimp_reader.hpp"
#include "voxdag/formats/readers/collada/collada_reader.hpp"
#include "voxdag/formats/readers/gltf/gltf_reader.hpp"
#include "voxdag/formats/readers/obj/obj_reader.hpp"
#include "voxdag/formats/readers/off/off_reader.hpp"
#include "voxdag/formats/readers/ply/ply_reader.hpp"
#include "voxdag/formats/readers/stl/stl_reader.hpp"
#include "voxdag/formats/readers/text_scan.hpp"
#include "voxdag/formats/readers/threemf/threemf_reader.hpp"
#include "voxdag/mesh/mesh_memory.hpp"

namespace voxdag {
namespace {

/// Returns the mesh with grey materials of its names: for formats without appearance.
MeshWithAppearance in_grey(Mesh mesh) {
  MeshWithAppearance result;
  std::vector<Material>& materials = result.appearance.materials;
  materials.resize(std::max<std::size_t>(mesh.materials.size(), 1));
  for (Material& material : materials) material.base_color = kDefaultColor;
  for (std::size_t i = 0; i < mesh.materials.size(); ++i) materials[i].name = mesh.materials[i];
  result.mesh = std::move(mesh);
  return result;
}

MeshWithAppearance read_format(const MeshSource& source, const std::string& extension,
                               ReadParts parts) {
  const auto finish = [&](Mesh mesh) {
    if (parts == ReadParts::kMesh) return MeshWithAppearance{std::move(mesh), {}, {}};
    const MemoryReservation materials(source.work().memory,
                                      mesh.materials.size() * sizeof(Material));
    return in_grey(std::move(mesh));
  };
  switch (detect_mesh_format(source.bytes, extension)) {
    case MeshFormat::kObj:
      return read_obj(source, parts);
    case MeshFormat::kPly:
      return read_ply(source, parts);
    case MeshFormat::kGltf:
      return read_gltf(source, parts);
    case MeshFormat::kStl:
      return finish(read_stl(source));
    case MeshFormat::kOff:
      return finish(read_off(source));
    case MeshFormat::k3mf:
      return read_3mf(source, parts);
    case MeshFormat::kCollada:
      return read_collada(source, parts);
    case MeshFormat::kOther:
      break;
  }
  return finish(read_with_assimp(source, extension));
}

MeshWithAppearance read(const std::filesystem::path& path, const ReadOptions& options,
                        ReadParts parts) {
  const InputFile input(path, options.work);
  const MappedFile file(input.path(), MappedFile::Access::kSequential);
  const MeshSource source{file.text(), path.string(), path.parent_path(), &file, options};
  if (source.bytes.empty()) throw source.error("the file is empty");
  const std::string extension =
      options.format.empty() ? input.name().extension().string() : "." + options.format;
  try {
    MeshWithAppearance result = read_format(source, extension, parts);
    source.end_pass();
    if (options.work.memory != nullptr)
      options.work.memory->reserve(memory_bytes(result.mesh) + memory_bytes(result.appearance));
    return result;
  } catch (const OverMemory& over) {
    if (!over.file().empty()) throw;
    throw OverMemory(source.name, "", over.reason());
  } catch (const std::bad_alloc&) {
    throw source.error("not enough memory for this mesh");
  }
}

}  // namespace

MeshFormat detect_mesh_format(std::string_view bytes, std::string_view extension) {
  std::string ext(extension);
  std::transform(ext.begin(), ext.end(), ext.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return MeshFormat::kPly;
  if (bytes.starts_with("glTF")) return MeshFormat::kGltf;
  const std::string_view head = without_byte_order_mark(bytes).substr(0, 65536);
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first != head.npos && head[first] == '{' && head.find("\"asset\"") != head.npos)
    return MeshFormat::kGltf;
  if (ext == ".obj") return MeshFormat::kObj;
  if (ext == ".ply") return MeshFormat::kPly;
  if (ext == ".gltf" || ext == ".glb") return MeshFormat::kGltf;
  if (ext == ".stl" || is_exact_binary_stl(bytes) || is_ascii_stl(bytes)) return MeshFormat::kStl;
  if (ext == ".off" || is_off(bytes)) return MeshFormat::kOff;
  if (ext == ".3mf") return MeshFormat::k3mf;
  if (ext == ".dae") return MeshFormat::kCollada;
  return MeshFormat::kOther;
}

Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
  return read(path, options, ReadParts::kMesh).mesh;
}

MeshWithAppearance read_mesh_with_appearance(const std::filesystem::path& path,
                                             const ReadOptions& options) {
  return read(path, options, ReadParts::kMeshAndAppearance);
}

}  // namespace voxdag
