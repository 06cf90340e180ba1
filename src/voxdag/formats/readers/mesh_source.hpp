#pragma once
/// The input of a mesh reader: the bytes of one file, in memory or mapped, and the options.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/formats/readers/read_options.hpp"

namespace voxdag {

enum class ReadParts { kMesh, kMeshAndAppearance };

struct MeshSource {
  std::string_view bytes;            ///< The whole file. Must stay valid while a reader runs.
  std::string name;                  ///< Names the file in error messages.
  std::filesystem::path folder;      ///< Relative names of other files start here.
  const MappedFile* file = nullptr;  ///< The mapping that `bytes` views. Null: plain memory.
  ReadOptions options;
  Vec3d origin{};  ///< Readers subtract it from each vertex, in double, before they round.

  const Work& work() const { return options.work; }

  /// Drops the mapped pages of `part` from memory after it has been read, and from time to time
  /// those of the mesh. Reports progress. Throws Cancelled.
  void done_with(std::string_view part, std::string_view stage) const {
    if (file != nullptr) file->release(part);
    count_work(part.size());
    work().poll();
    const auto end = static_cast<std::size_t>(part.data() + part.size() - bytes.data());
    work().report_done(stage, end, bytes.size());
  }

  /// Counts work on the arrays of the mesh: the bytes of input that were processed, or the bytes
  /// of the arrays themselves. Drops the arrays' pages from memory once per 64 MiB.
  void count_work(std::uint64_t work_bytes) const {
    if (options.arrays != nullptr) options.arrays->count_work(work_bytes);
  }
  /// Drops the pages of the mesh from memory at the end of a pass over it.
  void end_pass() const {
    if (options.arrays != nullptr) options.arrays->release();
  }

  /// Returns a point of the file as a vertex of the mesh.
  Vec3f vertex(Vec3d point) const { return static_cast<Vec3f>(point - origin); }

  Error error(const std::string& reason) const { return {name, "", reason}; }
  Error error_at_byte(std::size_t offset, const std::string& reason) const {
    return {name, "byte " + std::to_string(offset), reason};
  }
};

/// Polls cancellation once in 65,536 steps, for loops inside one very long line or array.
class CancelPoll {
 public:
  explicit CancelPoll(Work work) : work_(work) {}
  /// Counts one step; call it in each iteration. Throws Cancelled.
  void step() { work_.poll_seldom(++steps_); }

 private:
  Work work_;
  std::uint32_t steps_ = 0;
};

}  // namespace voxdag
