#pragma once
/// Reads a mesh file in chunks, so that processes can share the work.
///
/// The result is the surface of read_mesh(): the chunks' vertices one after the other, and their
/// triangles, in the order of read_mesh(). In binary STL, vertices repeat. A reader first counts
/// all chunks. Then each chunk's vertices can be read, and, when all vertices are known, its
/// triangles.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/face_writer.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// The contents of a chunk.
struct ChunkCounts {
  std::uint64_t vertices = 0, triangles = 0;
};

/// A mesh file in chunks. Threads may read chunks at the same time, in any order. The functions
/// throw Error with the line or byte at fault, OverMemory and Cancelled.
class MeshChunks {
 public:
  /// Reads the mapped bytes of the file at `path`.
  MeshChunks(MappedFile file, const std::filesystem::path& path, const ReadOptions& options);
  virtual ~MeshChunks() = default;
  MeshChunks(const MeshChunks&) = delete;
  MeshChunks& operator=(const MeshChunks&) = delete;

  /// Sets MeshSource::origin for the following calls.
  void set_origin(Vec3d origin) { source_.origin = origin; }
  /// Returns the number of chunks. It depends on the file and `chunk_bytes` alone.
  virtual std::uint64_t count() const = 0;
  /// Returns the contents of a chunk; nothing if only read_mesh() can read this file.
  virtual std::optional<ChunkCounts> counts(std::uint64_t chunk) const = 0;
  /// Reads a chunk's vertices; `vertices` has their number.
  virtual void read_vertices(std::uint64_t chunk, std::span<Vec3f> vertices) const = 0;
  /// Reads a chunk's triangles; `triangles` has their number. Every index is in range.
  virtual void read_triangles(std::uint64_t chunk, const AllVertices& vertices,
                              std::span<Triangle> triangles) const = 0;
  /// Returns whether vertices of different chunks with equal bits are one vertex of the mesh.
  virtual bool repeats_vertices() const { return false; }

 protected:
  const MeshSource& source() const { return source_; }
  /// Returns the index of the first of `items` that chunk `chunk` has, if all chunks share them.
  std::uint64_t first_item(std::uint64_t chunk, std::uint64_t items) const {
    return items / count() * chunk + items % count() * chunk / count();
  }
  /// Runs work() on a part of the file, makes errors of its faults, and drops the part's pages.
  template <class Work>
  void read(std::string_view part, char line_end, const Work& work) const {
    source_.work().poll();
    try {
      work();
    } catch (const Fault& fault) {
      throw_fault(source_, fault, line_end);
    }
    file_.release(part);
  }

 private:
  MappedFile file_;
  MeshSource source_;
};

/// Opens a mesh file in chunks of about `chunk_bytes` bytes. Returns null if its format, or an
/// error in it, needs read_mesh(). OBJ, binary PLY whose faces are triangles, and binary STL can be
/// read in chunks. `options.arrays` and `options.named_files` have no effect. Throws Error if the
/// file cannot be opened, or its header is malformed.
std::unique_ptr<MeshChunks> open_mesh_chunks(const std::filesystem::path& path,
                                             const ReadOptions& options,
                                             std::size_t chunk_bytes = kChunkBytes);

}  // namespace voxdag
