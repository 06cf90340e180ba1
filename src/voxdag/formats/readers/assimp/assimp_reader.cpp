#include "voxdag/formats/readers/assimp/assimp_reader.hpp"

#if VOXDAG_HAS_ASSIMP
#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/formats/readers/named_files.hpp"
#endif

namespace voxdag {

#if VOXDAG_HAS_ASSIMP

namespace {

/// An importer of assimp that survived fuzzing. The fuzzing was coverage-guided, under
/// AddressSanitizer, with assimp 5.2.5 (the version of Debian 12), for 50 s and 4,000 to 65,000
/// inputs per importer. Those for Collada, FBX, 3DS, X, LWO, ASE, AC3D, MD3, MDL, NFF, RAW, SIB,
/// COB, 3MF, B3D, OpenGEX, SMD, HMP, Q3D, LWS, CSM and MD5 failed: they read or wrote outside their
/// memory, freed it twice, allocated gigabytes, ended the process, or took more than 8 s for at
/// most 60 KB. The other importers were not tested, or they read files that the mesh names with any
/// importer.
struct SafeImporter {
  std::string_view extensions;  ///< In assimp's form: they identify the importer.
  std::string_view extension;   ///< The extension that may be read.
};

constexpr std::array<SafeImporter, 7> kSafeImporters{{{"amf", ".amf"},
                                                      {"dxf", ".dxf"},
                                                      {"md2", ".md2"},
                                                      {"ms3d", ".ms3d"},
                                                      {"x3d x3db", ".x3d"},
                                                      {"xgl zgl", ".xgl"},
                                                      {"xml irrmesh", ".irrmesh"}}};

/// Returns whether the importer that lists these extensions is one of kSafeImporters.
bool is_safe_importer(std::string_view extensions) {
  return std::any_of(
      kSafeImporters.begin(), kSafeImporters.end(),
      [extensions](const SafeImporter& safe) { return safe.extensions == extensions; });
}

/// Returns whether files of this extension (".dxf", any case) may be read without --assimp any.
/// Files without an extension may be read too: then only safe importers inspect them.
bool is_safe_extension(std::string extension) {
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension.empty() ||
         std::any_of(kSafeImporters.begin(), kSafeImporters.end(),
                     [&](const SafeImporter& safe) { return safe.extension == extension; });
}

std::string upper_case(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

/// Returns assimp's message on one line.
std::string reason(const Assimp::Importer& importer) {
  std::string text = importer.GetErrorString();
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

/// Bytes that assimp's importers may take for each byte of a file. Measured: 8 (AMF, XGL) to 24
/// (DXF). A file of empty XML elements needs most.
constexpr std::uint64_t kAssimpBytesPerFileByte = 64;

/// Removes the importers that did not survive fuzzing. Assimp asks all others whether they know a
/// file's content.
void keep_safe_importers(Assimp::Importer& importer) {
  std::vector<Assimp::BaseImporter*> unsafe;
  for (std::size_t i = 0; i < importer.GetImporterCount(); ++i)
    if (!is_safe_importer(importer.GetImporterInfo(i)->mFileExtensions))
      unsafe.push_back(importer.GetImporter(i));
  for (Assimp::BaseImporter* loader : unsafe) {
    importer.UnregisterLoader(loader);
    delete loader;  // NOLINT(cppcoreguidelines-owning-memory): unregistering passes ownership
  }
}

}  // namespace

Mesh read_with_assimp(const MeshSource& source, const std::string& extension) {
  Assimp::Importer importer;
  if (!extension.empty() && !importer.IsExtensionSupported(extension))
    throw source.error("unknown mesh format '" + extension + "'");
  if (!source.options.any_assimp_importer) {
    if (!is_safe_extension(extension))
      throw source.error(upper_case(extension.substr(1)) +
                         " files are read only with --assimp any, because assimp's importer is not "
                         "safe for untrusted files");
    keep_safe_importers(importer);
  }
  const MemoryReservation import_memory(source.work().memory,
                                        kAssimpBytesPerFileByte * source.bytes.size());
  importer.SetIOHandler(
      std::make_unique<AllowedFiles>(source).release());  // The importer deletes it.
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  constexpr unsigned kSteps =
      aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType;
  // The name of an unpacked file does not open its bytes.
  const bool is_file = std::filesystem::path(source.name).extension() == extension;
  const aiScene* scene =
      is_file ? importer.ReadFile(source.name, kSteps)
              : importer.ReadFileFromMemory(source.bytes.data(), source.bytes.size(), kSteps,
                                            extension.empty() ? "" : extension.c_str() + 1);
  if (scene == nullptr || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0)
    throw source.error("assimp: " + reason(importer));
  std::uint64_t vertices = 0, faces = 0;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    vertices += scene->mMeshes[i]->mNumVertices;
    faces += scene->mMeshes[i]->mNumFaces;
  }
  const MemoryReservation mesh_memory(
      source.work().memory,
      source.options.counted(vertices * sizeof(Vec3f) +
                             faces * (sizeof(Triangle) + sizeof(std::uint32_t))));
  Mesh mesh = empty_mesh(source.options.arrays);
  mesh.vertices.reserve(vertices);
  mesh.triangles.reserve(faces);
  mesh.triangle_materials.reserve(faces);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) add_mesh(source, *scene->mMeshes[i], mesh);
  if (mesh.triangles.empty()) throw source.error("no triangles: there is no surface to read");
  for (unsigned i = 0; i < scene->mNumMaterials; ++i)
    mesh.materials.emplace_back(scene->mMaterials[i]->GetName().C_Str());
  for (const std::uint32_t material : mesh.triangle_materials)
    if (material >= mesh.materials.size()) throw source.error("material index is out of range");
  return mesh;
}

#else

Mesh read_with_assimp(const MeshSource& source, const std::string& extension) {
  throw source.error("mesh format '" + extension +
                     "' needs assimp, which this program was built without");
}

#endif

}  // namespace voxdag
