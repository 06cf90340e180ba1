#pragma once
/// The vertices and triangles of a mesh, in files of the work folder that all ranks see.
///
/// The mesh file is read in chunks (formats/readers/mesh_chunks.hpp). A task is a run of chunks;
/// the ranks take one after the other. Formats that cannot be read in chunks make one task, for
/// rank 0.
///
///   mesh/counts-T      ChunkCounts of each chunk of task T; nothing if rank 0 must read the mesh
///   mesh/vertices-T    Vec3f of each vertex, from Mesh::origin
///   mesh/triangles-T   Triangle: three indices into all vertices
///   mesh/origin        Mesh::origin, if rank 0 has read the mesh
///   mesh/near/         the same of a mesh that is far from 0, read again from its origin
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "voxdag/cluster/missing_files.hpp"
#include "voxdag/cluster/ranks.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/core/box.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/formats/readers/mesh_chunks.hpp"
#include "voxdag/mesh/input_transform.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// The files NAME-0, NAME-1, ... that ranks have written, as one array, mapped into memory.
template <class T>
class ArrayFiles {
 public:
  /// Opens `count` files. Throws Error if one is missing, and Cancelled.
  ArrayFiles(const WorkFolder& folder, const std::string& name, std::uint64_t count, Work work) {
    for (std::uint64_t i = 0; i < count; ++i) {
      files_.push_back(folder.open_seen(numbered_name(name, i), work));
      firsts_.push_back(firsts_.back() + files_.back().values<T>().size());
    }
  }

  std::uint64_t size() const { return firsts_.back(); }

  /// Reads elements with indices below size(); fast if they are near each other. For one thread.
  class Reader {
   public:
    explicit Reader(const ArrayFiles& array) : array_(array) {}
    const T& operator[](std::uint64_t index) {
      if (index - first_ >= run_.size()) {
        const auto file = static_cast<std::size_t>(
            std::upper_bound(array_.firsts_.begin(), array_.firsts_.end(), index) -
            array_.firsts_.begin() - 1);
        first_ = array_.firsts_[file];
        run_ = array_.files_[file].template values<T>();
      }
      return run_[index - first_];
    }

   private:
    const ArrayFiles& array_;
    std::uint64_t first_ = 0;  ///< Index of the first element of `run_`.
    std::span<const T> run_;
  };

  /// Drops the pages of all files from this process's memory. Thread-safe.
  void release() const {
    for (const WorkFile& file : files_) file.release(file.bytes().size());
  }

 private:
  std::vector<WorkFile> files_;
  std::vector<std::uint64_t> firsts_{0};  ///< First element of each file, and number of all.
};

/// The folder of the mesh, within the work folder. It can be removed when the segments are written.
inline constexpr std::string_view kMeshFolder = "mesh";

class SharedMesh {
 public:
  /// Reads the mesh, or what the folder lacks of it. Chunks have about `chunk_bytes` bytes, equally
  /// many in all runs of a job. Collective. `reading` has the budget and the progress. Throws the
  /// errors of read_mesh(), OverMemory and Cancelled. An error of the mesh names one of its faults,
  /// not always the first.
  SharedMesh(Ranks& ranks, const WorkFolder& folder, const std::filesystem::path& path,
             const ReadOptions& reading, std::size_t chunk_bytes);

  /// Moves the mesh as move_mesh() does: position() and used_vertices() return moved vertices, the
  /// files keep theirs. Collective.
  void move(const InputTransform& transform);
  /// Returns the Mesh::origin of the moved mesh.
  Vec3d origin() const { return is_moved() ? moved_origin_ : origin_; }
  /// Returns the position of a vertex of vertices(), moved, in world units.
  Vec3d position(Vec3f vertex) const { return from_origin(origin(), stored(vertex)); }

  const ArrayFiles<Vec3f>& vertices() const { return *vertices_; }
  const ArrayFiles<Triangle>& triangles() const { return *triangles_; }
  /// Returns the number of vertices that read_mesh() gives: vertices() can repeat some. Collective.
  std::uint64_t count_vertices();
  /// Returns the box of the vertices that triangles use, in world units, without triangles that
  /// have a vertex that is not finite, and the number of those triangles. Collective.
  std::pair<Box3d, std::uint64_t> used_vertices();

  /// Drops the pages of the mesh from this process's memory. Thread-safe.
  void release() const;

 private:
  /// Calls body(task, file) for the tasks that lack their file, shared among the ranks. Collective.
  template <class Body>
  void for_each_missing(JobCounter counter, const std::string& name, const Body& body);
  void count_chunks();
  void read_chunks(const std::string& folder);
  void read_alone();
  void open(const std::string& folder);
  bool is_moved() const { return !transform_.is_identity(); }
  /// Returns a vertex as the moved Mesh has it.
  Vec3f stored(Vec3f vertex) const {
    return is_moved() ? transform_.vertex(from_origin(origin_, vertex), moved_origin_) : vertex;
  }
  /// Calls read(chunk, values) for the chunks of a task and writes the values. `count` is the
  /// number of them in ChunkCounts.
  template <class T, class Read>
  void write_values(std::uint64_t task, std::uint64_t ChunkCounts::*count, WorkFileWriter& file,
                    const Read& read);
  std::uint64_t first_chunk(std::uint64_t task) const;

  Ranks& ranks_;
  const WorkFolder& folder_;
  std::filesystem::path path_;
  Work work_;
  Progress quiet_;
  ReadOptions reading_;                 ///< The caller's options, with quiet_ as the progress.
  std::unique_ptr<MeshChunks> chunks_;  ///< Null if rank 0 reads the mesh alone.
  std::uint64_t tasks_ = 1, chunks_per_task_ = 1;
  std::vector<ChunkCounts> starts_;  ///< Contents of all chunks before each; then of all.
  std::optional<ArrayFiles<Vec3f>> vertices_;
  std::optional<ArrayFiles<Triangle>> triangles_;
  Vec3d origin_{};  ///< Of the vertices in the files.
  InputTransform transform_;
  Vec3d moved_origin_{};  ///< Mesh::origin after transform_, which the files do not have.
};

}  // namespace voxdag
