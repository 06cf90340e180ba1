#include "voxdag/formats/readers/read_mesh.hpp"

#include <algorithm>
#include <new>

#include "voxdag/core/float_origin.hpp"
#include "voxdag/core/io/unpacked_name.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/export_placement.hpp"
#include "voxdag/formats/input_file.hpp"
#include "voxdag/formats/readers/assimp/assimp_reader.hpp"
#include "voxdag/formats/readers/assimp/fbx_custom.hpp"
#include "voxdag/formats/readers/collada/collada_reader.hpp"
#include "voxdag/formats/readers/gltf/gltf_reader.hpp"
#include "voxdag/formats/readers/obj/obj_reader.hpp"
#include "voxdag/formats/readers/off/off_reader.hpp"
#include "voxdag/formats/readers/ply/ply_reader.hpp"
#include "voxdag/formats/readers/stl/stl_reader.hpp"
#include "voxdag/formats/readers/text_scan.hpp"
#include "voxdag/formats/readers/threemf/threemf_reader.hpp"
#include "voxdag/formats/readers/used_vertices.hpp"
#include "voxdag/mesh/mesh_memory.hpp"

namespace voxdag {
namespace {

/// Reads with the reader of the format. Subtracts source.origin from the vertices.
MeshWithAppearance read_format(const MeshSource& source, const std::string& extension,
                               ReadParts parts) {
  switch (detect_mesh_format(source.bytes, extension)) {
    case MeshFormat::kObj:
      return read_obj(source, parts);
    case MeshFormat::kPly:
      return read_ply(source, parts);
    case MeshFormat::kGltf:
      return read_gltf(source, parts);
    case MeshFormat::kStl:
      return read_stl(source, parts);
    case MeshFormat::kOff:
      return read_off(source, parts);
    case MeshFormat::k3mf:
      return read_3mf(source, parts);
    case MeshFormat::kCollada:
      return read_collada(source, parts);
    case MeshFormat::kOther:
      break;
  }
  if (extension.empty())
    throw source.error(
        "the content does not tell the format of the mesh: name it, such as --format obj");
  return read_with_assimp(source, extension, parts);
}

MeshWithAppearance read(const std::filesystem::path& path, const ReadOptions& options,
                        ReadParts parts) {
  const InputFile input(path, options.work);
  const MappedFile file(input.path(), MappedFile::Access::kSequential);
  MeshSource source{file.text(), path.string(), path.parent_path(), &file, options};
  if (source.bytes.empty()) throw source.error("the file is empty");
  const std::string extension =
      options.format.empty() ? input.name().extension().string() : "." + options.format;
  try {
    MeshWithAppearance result = read_format(source, extension, parts);
    UsedVertices used = used_vertices(source, result.mesh);
    source.origin =
        float_origin({static_cast<Vec3d>(used.bounds.lo), static_cast<Vec3d>(used.bounds.hi)});
    if (source.origin != Vec3d{}) {  // The mesh is far from 0: reads it again, from near by.
      result = {};
      result = read_format(source, extension, parts);
      result.mesh.origin = source.origin;
      used = used_vertices(source, result.mesh);
    }
    if (detect_mesh_format(source.bytes, extension) == MeshFormat::kStl)
      result.mesh.origin = result.mesh.origin + offset_beside(path);
    remove_bad_triangles(source, used.bad_triangles, result);
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

/// Returns the customs of an AMF file, whose root element has the unit.
FormatCustom amf_custom(std::string_view bytes) {
  FormatCustom custom = custom_of({}, "amf");
  custom.unit = "mm";  // By the specification, if there is none.
  const std::string_view head = bytes.substr(0, 4096);
  constexpr std::string_view kUnit = "unit=";
  const std::size_t at = head.find(kUnit, std::min(head.find("<amf"), head.size()));
  if (at == head.npos || at + kUnit.size() + 1 >= head.size()) return custom;
  const std::string_view name = head.substr(at + kUnit.size() + 1);
  custom.unit = "";
  constexpr std::pair<std::string_view, const char*> kUnits[] = {
      {"millimeter", "mm"}, {"meter", "m"}, {"inch", "in"}, {"feet", "ft"}, {"foot", "ft"}};
  for (const auto& [word, unit] : kUnits)
    if (name.starts_with(word)) custom.unit = unit;
  return custom;
}

}  // namespace

MeshFormat detect_mesh_format(std::string_view bytes, std::string_view extension) {
  const std::string ext = lower_case(extension);
  const std::string_view head = without_byte_order_mark(bytes).substr(0, 65536);
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return MeshFormat::kPly;
  if (bytes.starts_with("glTF")) return MeshFormat::kGltf;
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  if (first != head.npos && head[first] == '{' && head.find("\"asset\"") != head.npos)
    return MeshFormat::kGltf;
  if (is_exact_binary_stl(bytes) || is_ascii_stl(bytes)) return MeshFormat::kStl;
  if (is_off(bytes)) return MeshFormat::kOff;
  if (ext == ".obj") return MeshFormat::kObj;
  if (ext == ".ply") return MeshFormat::kPly;
  if (ext == ".gltf" || ext == ".glb") return MeshFormat::kGltf;
  if (ext == ".stl") return MeshFormat::kStl;
  if (ext == ".off") return MeshFormat::kOff;
  if (ext == ".3mf") return MeshFormat::k3mf;
  if (ext == ".dae") return MeshFormat::kCollada;
  // Other formats are in XML and ZIP, too, so the extension counts if there is one.
  if (!ext.empty()) return MeshFormat::kOther;
  if (first != head.npos && head[first] == '<' && head.find("<COLLADA") != head.npos)
    return MeshFormat::kCollada;
  if (is_3mf(bytes)) return MeshFormat::k3mf;
  return MeshFormat::kOther;
}

FormatCustom mesh_custom(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string ending = lower_case(
      options.format.empty() ? unpacked_name(path).extension().string() : "." + options.format);
  const auto is_one_of = [&](std::initializer_list<std::string_view> endings) {
    return std::find(endings.begin(), endings.end(), ending) != endings.end();
  };
  // The content may be STL. Unpacking a file to see that would take too long.
  const bool may_be_stl = is_one_of({".obj", ".ply", ".off", ".gltf", ".glb"}) &&
                          options.format.empty() && unpacked_name(path) == path;
  if (!ending.empty() && !may_be_stl && !is_one_of({".dae", ".fbx", ".amf"}))
    return custom_of({}, ending.substr(1));
  const InputFile input(path, options.work);
  const MappedFile file(input.path(), MappedFile::Access::kSequential);
  const MeshSource source{file.text(), path.string(), path.parent_path(), &file, options};
  if (ending == ".fbx") return fbx_custom(source.bytes);
  if (ending == ".amf") return amf_custom(source.bytes);
  switch (detect_mesh_format(source.bytes, ending)) {
    case MeshFormat::kGltf:
      return custom_of({}, "glb");
    case MeshFormat::kStl:
      return custom_of({}, "stl");
    case MeshFormat::k3mf:
      return custom_of({}, "3mf");
    case MeshFormat::kCollada: {
      FormatCustom custom = custom_of({}, "dae");
      custom.up = collada_up_axis(source);
      return custom;
    }
    default:
      return custom_of({}, "obj");
  }
}

Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
  MeshWithAppearance result = read(path, options, ReadParts::kMesh);
  if (options.warnings != nullptr)
    options.warnings->insert(options.warnings->end(), result.warnings.begin(),
                             result.warnings.end());
  return std::move(result.mesh);
}

MeshWithAppearance read_mesh_with_appearance(const std::filesystem::path& path,
                                             const ReadOptions& options) {
  return read(path, options, ReadParts::kMeshAndAppearance);
}

}  // namespace voxdag
