#include "voxdag/formats/readers/mesh_chunks.hpp"

#include <utility>

#include "voxdag/core/io/resolved_output.hpp"
#include "voxdag/core/io/unpacked_name.hpp"
#include "voxdag/formats/export_placement.hpp"
#include "voxdag/formats/readers/obj/obj_reader.hpp"
#include "voxdag/formats/readers/ply/ply_reader.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/formats/readers/stl/stl_reader.hpp"

namespace voxdag {

MeshChunks::MeshChunks(MappedFile file, const std::filesystem::path& path,
                       const ReadOptions& options)
    : file_(std::move(file)),
      source_{file_.text(), path.string(), path.parent_path(), &file_, options} {}

std::unique_ptr<MeshChunks> open_mesh_chunks(const std::filesystem::path& path,
                                             const ReadOptions& options, std::size_t chunk_bytes) {
  const std::string extension =
      options.format.empty() ? path.extension().string() : "." + options.format;
  // Only read_mesh() unpacks files.
  if (path == "-" || unpacked_name(path) != path || resolve_output(path).descriptor >= 0)
    return nullptr;
  MappedFile file(path, MappedFile::Access::kSequential);
  switch (detect_mesh_format(file.text(), extension)) {
    case MeshFormat::kObj:
      return open_obj_chunks(std::move(file), path, options, chunk_bytes);
    case MeshFormat::kPly:
      return open_ply_chunks(std::move(file), path, options, chunk_bytes);
    case MeshFormat::kStl:
      if (offset_beside(path) != Vec3d{}) return nullptr;
      return open_stl_chunks(std::move(file), path, options, chunk_bytes);
    default:
      return nullptr;
  }
}

}  // namespace voxdag
