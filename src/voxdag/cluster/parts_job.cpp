#include "voxdag/cluster/parts_job.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <ctime>

#include "voxdag/cluster/build_part.hpp"
#include "voxdag/cluster/mailboxes.hpp"
#include "voxdag/cluster/mesh_triangles.hpp"
#include "voxdag/cluster/missing_files.hpp"
#include "voxdag/cluster/node_order.hpp"
#include "voxdag/cluster/part_merge.hpp"
#include "voxdag/cluster/part_plan.hpp"
#include "voxdag/cluster/parts_log.hpp"
#include "voxdag/cluster/vdag_from_runs.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag {
namespace {

constexpr const char* kPlan = "parts/plan";

/// Returns the checksum of a file, as text.
std::string checksum_of(const std::filesystem::path& path, Work work) {
  constexpr std::size_t kStep = std::size_t{16} << 20;
  const MappedFile file(path, MappedFile::Access::kSequential);
  const std::string_view text = file.text();
  Xxh3Stream checksum;
  for (std::size_t at = 0; at < text.size(); at += kStep) {
    const std::string_view part = text.substr(at, kStep);
    checksum.add(std::as_bytes(std::span<const char>(part)));
    file.release(part);
    work.poll();
    work.report_done("check", at, text.size());
  }
  return fmt::format("{:016x}", checksum.digest());
}

/// Returns the settings that shape the voxels, for the metadata of the output.
JobSettings build_settings(const PartsJob& job) {
  JobSettings settings = voxdag::settings_of(job.grid);
  add_settings(job.transform, settings);
  return settings;
}

/// Returns what the job is about. Collective.
JobSettings settings_of(const PartsJob& job, const std::string& program, Ranks& ranks, Work work) {
  std::string checksum;
  if (ranks.rank() == 0) checksum = checksum_of(job.mesh, work);
  std::vector<std::byte> bytes(checksum.size());
  std::memcpy(bytes.data(), checksum.data(), bytes.size());
  ranks.broadcast(bytes);
  checksum.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  JobSettings settings = {{"program", program},
                          {"mesh", job.mesh.filename().string()},
                          {"content of the mesh (checksum)", checksum},
                          {"number of parts", job.parts == 0 ? "any" : std::to_string(job.parts)}};
  for (const auto& [name, value] : build_settings(job)) settings[name] = value;
  if (job.grid.resolution) settings["resolution"] = std::to_string(*job.grid.resolution);
  if (job.grid.voxel_size) settings["voxel size"] = fmt::format("{}", *job.grid.voxel_size);
  if (job.grid.origin)
    settings["origin"] =
        fmt::format("{},{},{}", job.grid.origin->x, job.grid.origin->y, job.grid.origin->z);
  if (job.grid.bounds) {
    const Box3d& box = *job.grid.bounds;
    settings["bounds"] = fmt::format("{},{},{},{},{},{}", box.lo.x, box.lo.y, box.lo.z, box.hi.x,
                                     box.hi.y, box.hi.z);
  }
  return settings;
}

/// Adds the part to errors of memory.
template <class Work>
auto with_part_name(std::uint64_t part, const Work& work) {
  try {
    return work();
  } catch (const OverMemory& over) {
    throw OverMemory("part " + std::to_string(part) + ": " + over.reason());
  }
}

/// One run of a job on one rank.
class PartsRun {
 public:
  PartsRun(const PartsJob& job, Ranks& ranks, const WorkFolder& folder, Work work)
      : job_(job),
        ranks_(ranks),
        folder_(folder),
        work_(work),
        mesh_job_{ranks,
                  folder,
                  job.mesh,
                  job.grid,
                  job.reading,
                  job.chunk_bytes,
                  InputTransform(job.transform, mesh_custom(job.mesh, job.reading))},
        log_(folder, ranks.rank()) {
    mesh_job_.reading.work = work;
  }

  PartsReport run(const std::string& program) {
    const MeshFacts facts = mesh_facts(mesh_job_);
    const std::vector<CellRange> parts = plan(facts);
    end(PartsStep::kTriangles);
    build(facts, parts);
    report_.parts = parts.size();
    end(PartsStep::kParts);

    PartFiles files(folder_, parts.size(), work_);
    report_.mailboxes = mailboxes(files);
    const MergeJob merge{
        ranks_, folder_, facts.grid.levels, files, report_.mailboxes, work_, job_.most_plain_words};
    const MergedNodes merged = merge_parts(merge);
    end(PartsStep::kMerge);
    const OrderedDag dag = order_nodes(merge, merged);
    end(PartsStep::kNumber);

    VdagMetadata& metadata = report_.metadata;
    metadata.grid = facts.grid;
    metadata.source = {job_.mesh.filename().string(), facts.vertices,
                       facts.triangles - facts.bad_triangles};
    report_.bad_triangles = facts.bad_triangles;
    report_.rounding = facts.rounding;
    metadata.program = program;
    metadata.build = build_settings(job_);
    metadata.counts = dag.counts;
    report_.node_bytes = dag.level_begin.back() * 4;
    report_.leaf_bytes = dag.leaf_blocks * 8;
    work_.report("write", 0);
    if (job_.present) {
      // The view depends on the finished DAG. So the file is written twice, first as a draft.
      const std::filesystem::path draft = job_.work_folder / "draft.vdag";
      write_vdag_from_runs(merge, dag, metadata, draft);
      ranks_.barrier();
      metadata.presentation = job_.present(draft);
      ranks_.barrier();
      if (ranks_.rank() == 0) std::filesystem::remove(draft);
    }
    write_vdag_from_runs(merge, dag, metadata, job_.output);
    end(PartsStep::kWrite);
    const std::uint64_t peak = peak_resident_bytes();
    for (const std::uint64_t of_rank : ranks_.all_gather({&peak, 1}))
      report_.peak_bytes = std::max(report_.peak_bytes, of_rank);
    return report_;
  }

 private:
  /// Returns the parts: those of the folder, or new ones. Collective.
  std::vector<CellRange> plan(const MeshFacts& facts) {
    const std::uint64_t has_plan = ranks_.rank() == 0 && folder_.open(kPlan, work_) ? 1 : 0;
    if (ranks_.all_gather({&has_plan, 1})[0] == 0) {
      const std::vector<TriangleSegment> segments = mesh_segments(mesh_job_, facts);
      if (ranks_.rank() == 0) write_plan(facts, segments);
    }
    ranks_.barrier();
    const WorkFile file = folder_.open_written(kPlan, work_);
    const auto stored = file.values<CellRange>();
    return std::vector<CellRange>(stored.begin(), stored.end());
  }

  void write_plan(const MeshFacts& facts, std::span<const TriangleSegment> segments) {
    // Removes the parts of an older plan, which have other cells.
    for (const char* folder : {"parts", "done"}) folder_.remove(folder);
    folder_.remove(kMergeFolder);
    const int level = segment_cell_level(facts.grid.levels);
    CountedVector<CellLoad> loads(std::size_t{1} << (3 * level), CellLoad{},
                                  CountedAllocator<CellLoad>(work_.memory));
    for (const TriangleSegment& segment : segments) add_loads(segment, loads);
    double sum = 0;
    for (const CellLoad& load : loads) sum += load.bytes();
    const double memory =
        static_cast<double>(std::min(work_.memory->left(), std::uint64_t{1} << 40));
    // Eight parts per rank, so that all ranks finish at about one time.
    const double count = job_.parts != 0 ? static_cast<double>(job_.parts) : 8.0 * ranks_.count();
    double part_bytes = sum / count;
    if (job_.parts == 0) part_bytes = std::min(part_bytes, memory / 3);
    const std::vector<CellRange> parts = plan_parts(loads, level, part_bytes);
    WorkFileWriter file = folder_.create(kPlan);
    file.write(std::as_bytes(std::span<const CellRange>(parts)));
    file.commit();
  }

  /// Returns the number of parts that are missing or damaged, and removes the damaged ones.
  /// Collective.
  std::uint64_t missing_parts(std::uint64_t parts) {
    std::uint64_t missing = 0;
    for (auto p = static_cast<std::uint64_t>(ranks_.rank()); p < parts;
         p += static_cast<std::uint64_t>(ranks_.count())) {
      if (folder_.open(part_name(p), work_)) continue;
      folder_.remove(part_name(p));
      ++missing;
    }
    std::uint64_t sum = 0;
    for (const std::uint64_t of_rank : ranks_.all_gather({&missing, 1})) sum += of_rank;
    return sum;
  }

  /// Builds the parts that are missing.
  void build(const MeshFacts& facts, const std::vector<CellRange>& parts) {
    report_.built = missing_parts(parts.size());
    if (report_.built == 0) return;
    if (ranks_.rank() == 0) {
      // Removes the merge of the older parts.
      folder_.remove(kMergeFolder);
      folder_.remove("done");
    }
    const std::vector<TriangleSegment> segments = mesh_segments(mesh_job_, facts);
    Progress quiet(work_.progress);
    // missing_parts() has checked the contents.
    const StepFiles files{kPartCounter, parts.size(), part_name, "parts", WorkFile::Check::kHeader};
    make_missing(ranks_, folder_, files, work_, [&](std::uint64_t p) {
      const auto timer = log_.start();
      WorkFileWriter file = folder_.create(part_name(p));
      const PartCounts counts = with_part_name(p, [&] {
        return build_part(segments, facts.grid.levels, parts[p], file, {work_.memory, &quiet});
      });
      const std::uint64_t bytes = file.size();
      file.commit();
      log_.part(timer, p, counts.triangles, counts.pieces, bytes);
    });
  }

  /// Returns the number of mailboxes: that of an unfinished merge, or a new one. Collective.
  std::uint32_t mailboxes(PartFiles& files) {
    const std::string name = std::string(kMergeFolder) + "/mailboxes";
    const std::uint32_t wanted = mailboxes_for(ranks_, files, *work_.memory);
    if (ranks_.rank() == 0 && !folder_.open(name, work_)) {
      folder_.remove(kMergeFolder);
      folder_.remove("done");
      WorkFileWriter file = folder_.create(name);
      file.write_value(wanted);
      file.commit();
    }
    ranks_.barrier();
    return folder_.open_written(name, work_).values<std::uint32_t>()[0];
  }

  void end(PartsStep step) {
    ranks_.barrier();
    const auto now = std::chrono::steady_clock::now();
    const auto index = static_cast<std::size_t>(step);
    report_.seconds[index] = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    const std::uint64_t sent = ranks_.bytes_sent();
    const std::clock_t cpu = std::clock();
    const std::uint64_t mine[] = {sent - sent_before_,
                                  static_cast<std::uint64_t>(cpu - cpu_before_)};
    const std::vector<std::uint64_t> all = ranks_.all_gather(mine);
    for (std::size_t r = 0; r < all.size(); r += 2) {
      report_.bytes_sent[index] += all[r];
      report_.cpu_seconds[index] += static_cast<double>(all[r + 1]) / CLOCKS_PER_SEC;
    }
    sent_before_ = ranks_.bytes_sent();
    cpu_before_ = cpu;
  }

  const PartsJob& job_;
  Ranks& ranks_;
  const WorkFolder& folder_;
  Work work_;
  MeshJob mesh_job_;
  PartsLog log_;
  PartsReport report_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::clock_t cpu_before_ = std::clock();
  std::uint64_t sent_before_ = 0;
};

}  // namespace

PartsReport build_in_parts(const PartsJob& job, const std::string& program, Ranks& ranks,
                           Work work) {
  const JobSettings settings = settings_of(job, program, ranks, work);
  std::optional<WorkFolder> folder;
  if (ranks.rank() == 0) folder.emplace(job.work_folder, settings, true);
  ranks.barrier();
  if (ranks.rank() != 0) folder.emplace(job.work_folder, settings, false);
  PartsReport report = PartsRun(job, ranks, *folder, work).run(program);
  ranks.barrier();
  if (ranks.rank() == 0) folder->remove_work();
  return report;
}

}  // namespace voxdag
