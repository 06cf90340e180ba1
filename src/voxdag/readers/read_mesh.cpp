#include "voxdag/readers/read_mesh.hpp"

#include <algorithm>
#include <new>

#include "voxdag/readers/assimp/assimp_reader.hpp"
#include "voxdag/readers/gltf/gltf_reader.hpp"
#include "voxdag/readers/obj/obj_reader.hpp"
#include "voxdag/readers/off/off_reader.hpp"
#include "voxdag/readers/ply/ply_reader.hpp"
#include "voxdag/readers/stl/stl_reader.hpp"
#include "voxdag/readers/text_scan.hpp"

namespace voxdag {

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
  return MeshFormat::kOther;
}

Mesh read_mesh(const std::filesystem::path& path, Progress* progress) {
  const MappedFile file(path, MappedFile::Access::kSequential);
  const MeshBytes source{file.text(), path.string(), path.parent_path(), progress, &file};
  if (source.bytes.empty()) throw source.error("the file is empty");
  try {
    switch (detect_mesh_format(source.bytes, path.extension().string())) {
      case MeshFormat::kObj:
        return read_obj(source);
      case MeshFormat::kPly:
        return read_ply(source);
      case MeshFormat::kStl:
        return read_stl(source);
      case MeshFormat::kGltf:
        return read_gltf(source);
      case MeshFormat::kOff:
        return read_off(source);
      case MeshFormat::kOther:
        break;
    }
    return read_with_assimp(source, path.extension().string());
  } catch (const std::bad_alloc&) {
    throw source.error("not enough memory for this mesh");
  }
}

}  // namespace voxdag
