#include "voxdag/readers/assimp/assimp_reader.hpp"

#if VOXDAG_HAS_ASSIMP
#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <limits>
#include <memory>

#endif

namespace voxdag {

#if VOXDAG_HAS_ASSIMP

namespace {

/// Assimp's message on one line.
std::string reason(const Assimp::Importer& importer) {
  std::string text = importer.GetErrorString();
  if (text.empty()) return "cannot read it, or a file that it refers to";
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
  return text.substr(0, 200);
}

/// For the files beside the mesh, too: opening a named pipe would wait for its writer.
class RegularFiles : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Exists(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
  }
};

void add_mesh(const MeshSource& source, const aiMesh& part, Mesh& mesh) {
  const std::size_t start = mesh.vertices.size();
  if (part.mNumVertices >= std::numeric_limits<std::uint32_t>::max() - start)
    throw source.error("more than 4,294,967,294 vertices");
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& p = part.mVertices[i];
    mesh.vertices.push_back(
        {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
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
      if (!is_finite(mesh.vertices[triangle[c]]))
        throw source.error("a face uses a vertex that is not finite");
    }
    mesh.triangles.push_back(triangle);
    mesh.triangle_materials.push_back(part.mMaterialIndex);
  }
}

}  // namespace

Mesh read_with_assimp(const MeshSource& source, const std::string& extension) {
  Assimp::Importer importer;
  if (!extension.empty() && !importer.IsExtensionSupported(extension))
    throw source.error("unknown mesh format '" + extension + "'");
  importer.SetIOHandler(std::make_unique<RegularFiles>().release());  // The importer deletes it.
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(
      source.name, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType);
  if (scene == nullptr || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0)
    throw source.error("assimp: " + reason(importer));
  Mesh mesh;
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
