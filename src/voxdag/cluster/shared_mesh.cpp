#include "voxdag/cluster/shared_mesh.hpp"

#include <algorithm>
#include <bit>
#include <mutex>

#include "voxdag/cluster/mailboxes.hpp"
#include "voxdag/cluster/missing_files.hpp"
#include "voxdag/cluster/unique_records.hpp"
#include "voxdag/core/float_origin.hpp"
#include "voxdag/core/io/mapped_arrays.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/formats/readers/used_vertices.hpp"
#include "voxdag/mesh/mesh_memory.hpp"
#include "voxdag/mesh/vertex_table.hpp"

namespace voxdag {
namespace {

/// The least number of chunks in a task; about the most tasks of a mesh.
constexpr std::uint64_t kMinChunks = 64, kMaxTasks = 1024;

/// The pages of the mesh are dropped from memory after so many triangles.
constexpr std::uint64_t kReleaseTriangles = std::uint64_t{1} << 20;

constexpr const char *kCounts = "mesh/counts", *kVertices = "vertices", *kTriangles = "triangles",
                     *kOrigin = "mesh/origin";
constexpr const char *kFolder = "mesh/", *kNearFolder = "mesh/near/";

}  // namespace

SharedMesh::SharedMesh(Ranks& ranks, const WorkFolder& folder, const std::filesystem::path& path,
                       const ReadOptions& reading, std::size_t chunk_bytes)
    : ranks_(ranks),
      folder_(folder),
      path_(path),
      work_(reading.work),
      quiet_(work_.progress),
      reading_(reading) {
  reading_.work.progress = &quiet_;
  // Rank 0 reports a malformed header alone.
  if (ranks.rank() == 0) chunks_ = open_mesh_chunks(path, reading_, chunk_bytes);
  ranks.barrier();
  if (ranks.rank() != 0) chunks_ = open_mesh_chunks(path, reading_, chunk_bytes);
  if (chunks_) {
    chunks_per_task_ = std::max(kMinChunks, chunks_->count() / kMaxTasks);
    tasks_ = (chunks_->count() + chunks_per_task_ - 1) / chunks_per_task_;
    count_chunks();
  }
  if (!chunks_) {
    read_alone();
    open(kFolder);
    origin_ = folder_.open_seen(kOrigin, work_).values<Vec3d>()[0];
    return;
  }
  read_chunks(kFolder);
  open(kFolder);
  const Vec3d origin = float_origin(used_vertices().first);
  if (origin == Vec3d{}) return;
  origin_ = origin;
  chunks_->set_origin(origin);
  read_chunks(kNearFolder);
  open(kNearFolder);
}

void SharedMesh::open(const std::string& folder) {
  vertices_.emplace(folder_, folder + kVertices, tasks_, work_);
  triangles_.emplace(folder_, folder + kTriangles, tasks_, work_);
}

template <class Body>
void SharedMesh::for_each_missing(JobCounter counter, const std::string& name, const Body& body) {
  const auto name_of = [&name](std::uint64_t task) { return numbered_name(name, task); };
  make_missing(ranks_, folder_, {counter, tasks_, name_of, "read"}, work_, [&](std::uint64_t task) {
    WorkFileWriter file = folder_.create(name_of(task));
    body(task, file);
    file.commit();
  });
}

std::uint64_t SharedMesh::first_chunk(std::uint64_t task) const {
  return std::min(task * chunks_per_task_, chunks_->count());
}

/// Counts all chunks. Sets chunks_ to null if the file needs read_mesh(), or if read_mesh() reports
/// its error better.
void SharedMesh::count_chunks() {
  for_each_missing(kMeshCountsCounter, kCounts, [&](std::uint64_t task, WorkFileWriter& file) {
    const std::uint64_t first = first_chunk(task);
    std::vector<std::optional<ChunkCounts>> counts(first_chunk(task + 1) - first);
    parallel_for(counts.size(), [&](std::size_t i) { counts[i] = chunks_->counts(first + i); });
    if (std::find(counts.begin(), counts.end(), std::nullopt) != counts.end()) return;
    for (const std::optional<ChunkCounts>& of_chunk : counts) file.write_value(*of_chunk);
  });
  starts_ = {{}};
  for (std::uint64_t task = 0; task < tasks_; ++task) {
    const WorkFile file = folder_.open_seen(numbered_name(kCounts, task), work_);
    for (const ChunkCounts& counts : file.values<ChunkCounts>())
      starts_.push_back(
          {starts_.back().vertices + counts.vertices, starts_.back().triangles + counts.triangles});
  }
  constexpr std::uint64_t kMaxVertices = 0xFFFFFFFE;
  const bool is_readable = starts_.size() == chunks_->count() + 1 && starts_.back().triangles > 0 &&
                           starts_.back().vertices <= kMaxVertices;
  if (is_readable) return;
  chunks_.reset();
  tasks_ = 1;
}

void SharedMesh::read_chunks(const std::string& folder) {
  const std::string vertices_name = folder + kVertices, triangles_name = folder + kTriangles;
  for_each_missing(kMeshVerticesCounter, vertices_name,
                   [&](std::uint64_t task, WorkFileWriter& file) {
                     write_values<Vec3f>(task, &ChunkCounts::vertices, file,
                                         [&](std::uint64_t chunk, std::span<Vec3f> vertices) {
                                           chunks_->read_vertices(chunk, vertices);
                                         });
                   });
  const ArrayFiles<Vec3f> vertices(folder_, vertices_name, tasks_, work_);
  for_each_missing(
      kMeshTrianglesCounter, triangles_name, [&](std::uint64_t task, WorkFileWriter& file) {
        write_values<Triangle>(task, &ChunkCounts::triangles, file,
                               [&](std::uint64_t chunk, std::span<Triangle> triangles) {
                                 ArrayFiles<Vec3f>::Reader reader(vertices);
                                 chunks_->read_triangles(
                                     chunk,
                                     {starts_[chunk].vertices, vertices.size(),
                                      [&](std::uint32_t vertex) { return reader[vertex]; }},
                                     triangles);
                               });
        vertices.release();
      });
}

/// Reads a few chunks at a time, on all threads, and writes them in order.
template <class T, class Read>
void SharedMesh::write_values(std::uint64_t task, std::uint64_t ChunkCounts::*count,
                              WorkFileWriter& file, const Read& read) {
  const std::uint64_t last = first_chunk(task + 1);
  const auto step = 2 * thread_count();
  for (std::uint64_t first = first_chunk(task); first < last; first += step) {
    const std::uint64_t end = std::min(first + step, last), begin = starts_[first].*count;
    CountedVector<T> values(starts_[end].*count - begin, T{},
                            CountedAllocator<T>(reading_.work.memory));
    parallel_for(end - first, [&](std::size_t i) {
      const std::uint64_t chunk = first + i;
      read(chunk, std::span<T>(values).subspan(starts_[chunk].*count - begin,
                                               starts_[chunk + 1].*count - starts_[chunk].*count));
    });
    file.write_values<T>(values);
  }
}

void SharedMesh::read_alone() {
  const std::string vertices = numbered_name(std::string(kFolder) + kVertices, 0),
                    triangles = numbered_name(std::string(kFolder) + kTriangles, 0);
  if (ranks_.rank() == 0 && !(folder_.open(vertices, work_) && folder_.open(triangles, work_) &&
                              folder_.open(kOrigin, work_))) {
    MappedArrays arrays(folder_.file(vertices).parent_path());
    ReadOptions reading = reading_;
    reading.work = work_;
    reading.arrays = &arrays;
    const Mesh mesh = read_mesh(path_, reading);
    // read_mesh() left the bytes reserved; this releases them at the end.
    reading.work.memory->release(memory_bytes(mesh));
    const MemoryReservation held(reading.work.memory, memory_bytes(mesh));
    const auto write = [&](const std::string& name, std::span<const std::byte> bytes) {
      constexpr std::size_t kStep = std::size_t{16} << 20;
      WorkFileWriter file = folder_.create(name);
      for (std::size_t at = 0; at < bytes.size(); at += kStep) {
        work_.poll();
        file.write(bytes.subspan(at, std::min(kStep, bytes.size() - at)));
        arrays.release();
      }
      file.commit();
    };
    write(vertices, std::as_bytes(std::span<const Vec3f>(mesh.vertices)));
    write(triangles, std::as_bytes(std::span<const Triangle>(mesh.triangles)));
    write(kOrigin, std::as_bytes(std::span<const Vec3d, 1>(&mesh.origin, 1)));
  }
  ranks_.barrier();
}

void SharedMesh::release() const {
  vertices_->release();
  triangles_->release();
}

std::pair<Box3d, std::uint64_t> SharedMesh::used_vertices() {
  const auto rank = static_cast<std::uint64_t>(ranks_.rank()),
             count = static_cast<std::uint64_t>(ranks_.count());
  const std::uint64_t all = triangles_->size(),
                      steps = (all + kReleaseTriangles - 1) / kReleaseTriangles,
                      own = steps > rank ? (steps - rank - 1) / count + 1 : 0;
  std::mutex mutex;
  UsedVertices used;
  parallel_for(own, [&](std::size_t i) {
    work_.poll();
    ArrayFiles<Vec3f>::Reader vertices(*vertices_);
    ArrayFiles<Triangle>::Reader triangles(*triangles_);
    UsedVertices of_step;
    const std::uint64_t first = (rank + i * count) * kReleaseTriangles,
                        last = std::min(first + kReleaseTriangles, all);
    for (std::uint64_t t = first; t < last; ++t) {
      const auto [a, b, c] = triangles[t];
      of_step.add(stored(vertices[a]), stored(vertices[b]), stored(vertices[c]));
    }
    release();
    const std::lock_guard guard(mutex);
    used.add(of_step);
  });
  std::vector<std::uint64_t> mine = {used.bad_triangles};
  for (const Vec3f corner : {used.bounds.lo, used.bounds.hi})
    for (int axis = 0; axis < 3; ++axis) mine.push_back(std::bit_cast<std::uint32_t>(corner[axis]));
  const std::vector<std::uint64_t> gathered = ranks_.all_gather(mine);
  used = {};
  for (std::size_t r = 0; r < gathered.size(); r += mine.size()) {
    const auto number = [&](std::size_t i) {
      return std::bit_cast<float>(static_cast<std::uint32_t>(gathered[r + i]));
    };
    used.add({{{number(1), number(2), number(3)}, {number(4), number(5), number(6)}}, gathered[r]});
  }
  if (used.bounds.is_empty()) {
    if (ranks_.rank() == 0) throw Error(path_.string(), "", kNoGoodTriangle);
    ranks_.barrier();
  }
  return {{from_origin(origin(), used.bounds.lo), from_origin(origin(), used.bounds.hi)},
          used.bad_triangles};
}

void SharedMesh::move(const InputTransform& transform) {
  transform_ = transform;
  if (is_moved()) moved_origin_ = float_origin(used_vertices().first);
}

std::uint64_t SharedMesh::count_vertices() {
  if (!chunks_ || !chunks_->repeats_vertices()) return vertices_->size();
  // Sends each vertex to the mailbox that its hash decides, which counts different ones.
  constexpr std::uint64_t kVertexBytes = 64;  // with its slot in the table
  std::uint64_t wanted =
      mailboxes_of(ranks_, vertices_->size() * kVertexBytes, *reading_.work.memory);
  wanted = ranks_.all_gather({&wanted, 1})[0];
  const auto mailboxes = static_cast<std::uint32_t>(wanted);
  const std::string name = "mesh/different";
  {
    Mailboxes mail(ranks_, folder_, name, mailboxes, *reading_.work.memory);
    Mailboxes::Sender sender(mail);
    const auto rank = static_cast<std::uint64_t>(ranks_.rank()),
               count = static_cast<std::uint64_t>(ranks_.count());
    const std::uint64_t all = vertices_->size();
    ArrayFiles<Vec3f>::Reader vertices(*vertices_);
    for (std::uint64_t first = rank * kReleaseTriangles; first < all;
         first += count * kReleaseTriangles) {
      work_.poll();
      for (std::uint64_t v = first; v < std::min(first + kReleaseTriangles, all); ++v)
        sender.send_value(static_cast<std::uint32_t>((hash_bits(vertices[v]) >> 32) % mailboxes),
                          vertices[v]);
      vertices_->release();
    }
    sender.flush();
    mail.close();
  }
  std::mutex mutex;
  std::uint64_t mine = 0, sum = 0;
  for_each_own(ranks_, mailboxes, work_, [&](std::uint32_t box) {
    const WorkFile file = folder_.open_written(mailbox_name(name, box), work_);
    UniqueRecords different(reading_.work.memory);
    for (std::size_t at = 0; at < file.bytes().size(); at += sizeof(Vec3f)) {
      const auto record = file.bytes().subspan(at, sizeof(Vec3f));
      different.find_or_add(record, xxh3_64(record));
    }
    const std::lock_guard guard(mutex);
    mine += different.count();
  });
  for (const std::uint64_t of_rank : ranks_.all_gather({&mine, 1})) sum += of_rank;
  return sum;
}

}  // namespace voxdag
