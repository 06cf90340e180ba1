#include "voxdag/formats/readers/assimp/assimp_reader.hpp"

#if VOXDAG_HAS_ASSIMP
#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "voxdag/core/io/confined_child.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/readers/named_files.hpp"
#include "voxdag/formats/readers/plain_colors.hpp"
#endif

namespace voxdag {

#if VOXDAG_HAS_ASSIMP

namespace {

/// Returns assimp's message on one line.
std::string reason(const Assimp::Importer& importer) {
  std::string text = importer.GetErrorString();
  if (text.find("Unrecognized file schema") != text.npos)
    return "of STEP files, only IFC is read: save a CAD model as a mesh, such as STL";
  if (text.empty()) return "cannot read this file, or a file that it names";
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
  return text.substr(0, 200);
}

/// Opens the mesh file and regular files inside its folder that it names.
class AllowedFiles : public Assimp::DefaultIOSystem {
 public:
  explicit AllowedFiles(const MeshSource& source) : source_(source), named_(source) {}

  bool Exists(const char* file) const override {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return is_allowed(file) && Exists(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
  }

 private:
  bool is_allowed(const char* file) const {
    if (file == source_.name) return true;
    const auto path = named_.existing({}, file, NamedFiles::ByBaseName::kNever);
    if (!path || *path != file) return false;
    named_.report(*path);
    return true;
  }

  const MeshSource& source_;
  NamedFiles named_;
};

void add_mesh(const MeshSource& source, const aiMesh& part, Mesh& mesh) {
  const std::size_t start = mesh.vertices.size();
  if (part.mNumVertices >= std::numeric_limits<std::uint32_t>::max() - start)
    throw source.error("the mesh has more than 4,294,967,294 vertices");
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    mesh.vertices.push_back(source.vertex(
        {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)}));
  }
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices != 3) continue;
    Triangle triangle{};
    for (unsigned c = 0; c < 3; ++c) {
      if (face.mIndices[c] >= part.mNumVertices)
        throw source.error("vertex index " + std::to_string(face.mIndices[c]) +
                           " is out of range: " + std::to_string(part.mNumVertices) + " vertices");
      triangle[c] = static_cast<std::uint32_t>(start) + face.mIndices[c];
    }
    mesh.triangles.push_back(triangle);
    mesh.triangle_materials.push_back(part.mMaterialIndex);
  }
}

/// Bytes that assimp may take for each byte of a file. Measured: 8 (AMF, XGL) to 24 (DXF). A file
/// of empty XML elements needs most.
constexpr std::uint64_t kBytesPerFileByte = 64;
/// Bytes that a confined child may take beyond that, for compressed arrays of FBX, if the limit on
/// memory leaves as many.
constexpr std::uint64_t kExtraMemory = std::uint64_t{256} << 20;
/// Processor seconds of a confined child, and those for each MiB of the file.
constexpr std::uint32_t kSeconds = 10, kSecondsPerMebibyte = 2;

/// A mesh whose materials have a name and a colour.
struct ImportedMesh {
  Mesh mesh;
  std::vector<Vec3f> colors;  ///< Of the materials: linear light.
  std::uint8_t has_textures = 0;
};

/// Reads a file with the importer that has the extension, or that knows the content.
ImportedMesh import(const MeshSource& source, const std::string& extension, bool in_confinement) {
  Assimp::Importer importer;
  if (!extension.empty() && !importer.IsExtensionSupported(extension))
    throw source.error("unknown mesh format '" + extension +
                       "': 'voxdag import' reads points, voxels and volumes");
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  constexpr unsigned kSteps =
      aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType;
  // The name of an unpacked file does not open its bytes.
  const bool by_name =
      !in_confinement && std::filesystem::path(source.name).extension() == extension;
  if (by_name)  // The importer deletes its files.
    importer.SetIOHandler(std::make_unique<AllowedFiles>(source).release());
  const aiScene* scene =
      by_name ? importer.ReadFile(source.name, kSteps)
              : importer.ReadFileFromMemory(source.bytes.data(), source.bytes.size(), kSteps,
                                            extension.empty() ? "" : extension.c_str() + 1);
  if (scene == nullptr || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0)
    throw source.error("assimp: " + reason(importer));
  ImportedMesh read;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) add_mesh(source, *scene->mMeshes[i], read.mesh);
  if (read.mesh.triangles.empty()) throw source.error("no triangles: there is no surface to read");
  for (unsigned i = 0; i < scene->mNumMaterials; ++i) {
    const aiMaterial& material = *scene->mMaterials[i];
    read.mesh.materials.emplace_back(material.GetName().C_Str());
    aiColor3D color;
    read.colors.push_back(
        material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS
            ? Vec3f{srgb_to_linear(color.r), srgb_to_linear(color.g), srgb_to_linear(color.b)}
            : kDefaultColor);
    if (material.GetTextureCount(aiTextureType_DIFFUSE) > 0) read.has_textures = 1;
  }
  return read;
}

/// The beginning of what the child writes. The arrays follow, then colour and name of each
/// material: its length, its bytes.
struct ChildHead {
  std::uint64_t error_bytes = 0;  ///< Of the reason why there is no mesh; it follows instead.
  std::uint64_t vertices = 0, triangles = 0, materials = 0;
  std::uint64_t has_textures = 0;
};

void write_import(const MeshSource& source, const std::string& extension,
                  const ConfinedChild::Write& write) {
  try {
    const ImportedMesh read = import(source, extension, true);
    const Mesh& mesh = read.mesh;
    const ChildHead head{0, mesh.vertices.size(), mesh.triangles.size(), mesh.materials.size(),
                         read.has_textures};
    write(&head, sizeof head);
    write(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3f));
    write(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
    write(mesh.triangle_materials.data(), mesh.triangles.size() * sizeof(std::uint32_t));
    for (std::size_t i = 0; i < read.colors.size(); ++i) {
      const std::string name = mesh.materials[i].substr(0, kLongestName);
      const auto size = static_cast<std::uint32_t>(name.size());
      write(&read.colors[i], sizeof(Vec3f));
      write(&size, sizeof size);
      write(name.data(), size);
    }
  } catch (const Error& error) {
    const ChildHead head{error.reason().size(), 0, 0, 0, 0};
    write(&head, sizeof head);
    write(error.reason().data(), error.reason().size());
  }
}

/// Reads in a confined child.
ImportedMesh import_confined(const MeshSource& source, const std::string& extension) {
  MemoryBudget* const memory = source.work().memory;
  const std::uint64_t least = kBytesPerFileByte * source.bytes.size();
  // Half of what the budget leaves remains for the mesh.
  const std::uint64_t left = memory == nullptr ? 2 * kExtraMemory : memory->left();
  const std::uint64_t extra = std::min(kExtraMemory, (left - std::min(left, least)) / 2);
  const MemoryReservation child_memory(memory, least + extra);
  const ChildLimits limits{
      least + extra,
      kSeconds + kSecondsPerMebibyte * static_cast<std::uint32_t>(source.bytes.size() >> 20)};
  MeshSource in_child = source;
  in_child.options.arrays = nullptr;  // A child must not write to the arrays of its parent.
  ConfinedChild child(
      limits, [&](const ConfinedChild::Write& write) { write_import(in_child, extension, write); });
  const auto take = [&](auto& array, std::uint64_t size) {
    array.resize(size);
    child.read(array.data(), size * sizeof(array[0]), source.work());
  };
  ChildHead head;
  child.read(&head, sizeof head, source.work());
  if (head.error_bytes > 0) {
    std::string reason;
    take(reason, std::min<std::uint64_t>(head.error_bytes, 1000));
    throw source.error(printable(reason, 1000));
  }
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (head.vertices > kMost || head.triangles > kMost || head.materials > kMost)
    throw source.error("assimp: the mesh has more than 4,294,967,294 vertices or triangles");
  const MemoryReservation mesh_memory(
      memory, source.options.counted(head.vertices * sizeof(Vec3f) +
                                     head.triangles * (sizeof(Triangle) + sizeof(std::uint32_t))) +
                  head.materials * (sizeof(std::string) + sizeof(Vec3f) + kLongestName));
  ImportedMesh read{empty_mesh(source.options.arrays), {}, head.has_textures != 0};
  take(read.mesh.vertices, head.vertices);
  take(read.mesh.triangles, head.triangles);
  take(read.mesh.triangle_materials, head.triangles);
  for (std::uint64_t i = 0; i < head.materials; ++i) {
    std::uint32_t size = 0;
    child.read(&read.colors.emplace_back(), sizeof(Vec3f), source.work());
    child.read(&size, sizeof size, source.work());
    take(read.mesh.materials.emplace_back(), std::min<std::size_t>(size, kLongestName));
  }
  return read;
}

/// Checks what a crashed importer or a hostile child may have made wrong.
void check_indices(const MeshSource& source, const Mesh& mesh) {
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t corner : triangle)
      if (corner >= mesh.vertices.size()) throw source.error("vertex index is out of range");
  for (const std::uint32_t material : mesh.triangle_materials)
    if (material >= mesh.materials.size()) throw source.error("material index is out of range");
}

}  // namespace

MeshWithAppearance read_with_assimp(const MeshSource& source, const std::string& extension,
                                    ReadParts parts) {
  ImportedMesh read;
  if (source.options.any_assimp_importer) {
    const MemoryReservation import_memory(source.work().memory,
                                          kBytesPerFileByte * source.bytes.size());
    read = import(source, extension, false);
  } else {
    try {
      read = import_confined(source, extension);
    } catch (const OverMemory&) {
      throw;
    } catch (const Error& error) {
      if (!error.file().empty()) throw;
      throw source.error("assimp " + error.reason());
    }
  }
  check_indices(source, read.mesh);
  MeshWithAppearance result{std::move(read.mesh), {}, {}};
  if (parts != ReadParts::kMeshAndAppearance) return result;
  add_plain_materials(source, result);
  for (std::size_t i = 0; i < read.colors.size(); ++i)
    result.appearance.materials[i].base_color = to_rgba16(read.colors[i], 1).color();
  if (read.has_textures != 0)
    result.warnings.push_back(source.name +
                              ": textures are left out: assimp's formats have the colours of "
                              "their materials");
  return result;
}

#else

MeshWithAppearance read_with_assimp(const MeshSource& source, const std::string& extension,
                                    ReadParts /*parts*/) {
  throw source.error("mesh format '" + extension +
                     "' needs assimp, which this program was built without");
}

#endif

}  // namespace voxdag
