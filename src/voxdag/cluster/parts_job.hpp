#pragma once
/// Builds the DAG of a mesh in parts, by one process or by many. The file is that of a plain build,
/// to the byte.
///
/// The steps lie in a work folder, which all ranks see, so that a job that ended early goes on
/// where it was:
///
///   triangles   the ranks read the mesh, each some ranges of its file, and write its triangles in
///               segments, with an index of the coarse cells that each meets
///   parts       the grid is cut into parts; each rank takes one after the other and builds its DAG
///   merge       equal nodes of the parts become one, level by level
///   number      the nodes get their canonical order
///   write       the ranks write the output
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "voxdag/builders/voxelize/grid_request.hpp"
#include "voxdag/cluster/part_merge.hpp"
#include "voxdag/cluster/ranks.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/read_options.hpp"
#include "voxdag/mesh/input_transform.hpp"

namespace voxdag {

struct PartsJob {
  std::filesystem::path mesh, work_folder, output;
  GridRequest grid;
  /// Least number of parts, if the mesh meets enough cells; 0: a number that fits the ranks and
  /// their memory.
  std::uint64_t parts = 0;
  ReadOptions reading;  ///< The job sets `work`.
  /// Bytes of the mesh file that a thread reads at once. All runs of a job need the same number.
  std::size_t chunk_bytes = kChunkBytes;
  /// A DAG with more node words gets long pointers (stored/svdag/long_svdag.hpp). For tests.
  std::uint64_t most_plain_words = kMaxPlainWords;
  TransformRequest transform = {};  ///< Moves the mesh before the grid is placed.
  /// Returns how the voxels of a file are to be seen. All ranks call it for the same file. Empty:
  /// not known.
  std::function<Presentation(const std::filesystem::path&)> present = {};
};

enum class PartsStep { kTriangles, kParts, kMerge, kNumber, kWrite };
inline constexpr std::array kPartsSteps = {"triangles", "parts", "merge", "number", "write"};

/// The result and the costs of a job. All ranks get equal values, but for the seconds.
struct PartsReport {
  VdagMetadata metadata;
  std::array<double, kPartsSteps.size()> seconds{};      ///< Wall-clock, per step.
  std::array<double, kPartsSteps.size()> cpu_seconds{};  ///< Of the threads of all ranks, per step.
  std::array<std::uint64_t, kPartsSteps.size()> bytes_sent{};  ///< Between ranks, per step.
  std::uint64_t bad_triangles = 0;  ///< Left out: they have a vertex that is not finite.
  double rounding = 0;              ///< Largest error of a vertex in float32, in world units.
  std::uint64_t parts = 0;
  std::uint64_t built = 0;  ///< Parts that this run built; the others were whole already.
  std::uint32_t mailboxes = 0;
  std::uint64_t peak_bytes = 0;                  ///< Most resident memory of a rank.
  std::uint64_t node_bytes = 0, leaf_bytes = 0;  ///< Of the DAG in the paper's layout.
};

/// Runs the job, and removes all but the log from the work folder. Collective. The budget of `work`
/// limits the memory of this rank; mapped files do not count. Throws Error, OverMemory and
/// Cancelled; the work folder then holds what is done, and the same call goes on with it.
PartsReport build_in_parts(const PartsJob& job, const std::string& program, Ranks& ranks,
                           Work work);

}  // namespace voxdag
