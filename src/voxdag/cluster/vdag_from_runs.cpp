#include "voxdag/cluster/vdag_from_runs.hpp"

#include <cstring>
#include <memory>
#include <optional>

#include "voxdag/cluster/shared_file.hpp"
#include "voxdag/core/bits.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/checksum.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/file/vdag_bytes.hpp"
#include "voxdag/file/vdag_format.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kStep = std::size_t{1} << 20;

/// Makes nodes of the plain layout from nodes with long pointers that fit into 32 bits.
class PlainNodes {
 public:
  /// `base` is the first word of the level below, which plain pointers count from.
  explicit PlainNodes(std::uint64_t base) : base_(static_cast<std::uint32_t>(base)) {}

  /// Returns the words that follow those of the last call; valid until the next.
  std::span<const std::byte> convert(std::span<const std::byte> bytes) {
    words_.resize(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(words_.data(), bytes.data(), bytes.size());
    for (std::uint32_t& word : words_) {
      if (pointers_ == 0) {
        pointers_ = popcount(word);
      } else {
        word += base_;
        --pointers_;
      }
    }
    return std::as_bytes(std::span<const std::uint32_t>(words_));
  }

 private:
  std::uint32_t base_;
  int pointers_ = 0;  ///< Of the current node, that are still to come.
  std::vector<std::uint32_t> words_;
};

/// Calls body(bytes) for the bytes of a run, some at a time, and drops their pages.
template <class Body>
void read_run(const MergeJob& job, const OrderedDag& dag, int level, std::uint32_t box,
              const Body& body) {
  const WorkFile file = job.folder.open_written(words_name(level, box), job.work);
  const std::span<const std::byte> bytes = file.bytes();
  std::optional<PlainNodes> plain;
  if (!dag.has_long_pointers && level + 1 < job.levels - 2)
    plain.emplace(dag.level_begin[static_cast<std::size_t>(level) + 1]);
  for (std::size_t at = 0; at < bytes.size(); at += kStep) {
    job.work.poll();
    const auto step = bytes.subspan(at, std::min(kStep, bytes.size() - at));
    body(plain ? plain->convert(step) : step);
    file.release(std::min(at + kStep, bytes.size()));
  }
}

/// Calls body(level, mailbox) for the runs of NODE, or of LEAF, in their order in the file.
template <class Body>
void for_each_run(const MergeJob& job, const OrderedDag& dag, bool is_leaf, const Body& body) {
  if (dag.leaf_blocks == 0) return;
  const int leaf_level = job.levels - 2;
  for (int level = is_leaf ? leaf_level : 0; level < (is_leaf ? leaf_level + 1 : leaf_level);
       ++level)
    for (std::uint32_t box = 0; box < job.mailboxes; ++box) body(level, box);
}

ChunkSummary summary_of(std::uint32_t id, std::span<const std::byte> bytes) {
  return {id, kVdagChunkRequired, bytes.size(), xxh3_64(bytes)};
}

ChunkSummary summary_of_runs(const MergeJob& job, const OrderedDag& dag, std::uint32_t id) {
  ChunkSummary summary{id, kVdagChunkRequired, 0, 0};
  Xxh3Stream checksum;
  for_each_run(job, dag, id == kChunkLeafBlocks, [&](int level, std::uint32_t box) {
    read_run(job, dag, level, box, [&](std::span<const std::byte> bytes) {
      checksum.add(bytes);
      summary.length += bytes.size();
    });
  });
  summary.checksum = checksum.digest();
  return summary;
}

/// The small parts of the file, and where its chunks begin.
struct Layout {
  std::string json;
  std::vector<std::byte> head;
  std::uint64_t meta = 0, levels = 0, nodes = 0, leaf_blocks = 0, end = 0;
};

std::span<const std::byte> level_bytes(const OrderedDag& dag) {
  return std::as_bytes(std::span<const std::uint64_t>(dag.level_begin));
}

Layout make_layout(const MergeJob& job, const OrderedDag& dag, const VdagMetadata& metadata) {
  Layout layout;
  layout.json = checked_metadata_json(metadata);
  const ChunkSummary chunks[] = {
      summary_of(kChunkMeta, std::as_bytes(std::span<const char>(layout.json))),
      summary_of(kChunkLevels, level_bytes(dag)),
      summary_of_runs(job, dag, dag.has_long_pointers ? kChunkLongNodes : kChunkNodes),
      summary_of_runs(job, dag, kChunkLeafBlocks)};
  layout.head = vdag_head(chunks);
  layout.meta = layout.head.size();
  layout.levels = layout.meta + vdag_align(chunks[0].length);
  layout.nodes = layout.levels + vdag_align(chunks[1].length);
  layout.leaf_blocks = layout.nodes + vdag_align(chunks[2].length);
  layout.end = layout.leaf_blocks + vdag_align(chunks[3].length);
  return layout;
}

/// Writes everything in order: the output can be a pipe.
void write_alone(const MergeJob& job, const OrderedDag& dag, const Layout& layout,
                 const std::filesystem::path& path) {
  AtomicFile file(path);
  const auto pad_to = [&](std::uint64_t offset) { file.write_zeros(offset - file.position()); };
  file.write(std::span<const std::byte>(layout.head));
  file.write(layout.json);
  pad_to(layout.levels);
  file.write(level_bytes(dag));
  pad_to(layout.nodes);
  for (const bool is_leaf : {false, true}) {
    for_each_run(job, dag, is_leaf, [&](int level, std::uint32_t box) {
      read_run(job, dag, level, box, [&](std::span<const std::byte> bytes) { file.write(bytes); });
    });
    pad_to(is_leaf ? layout.end : layout.leaf_blocks);
  }
  file.commit();
}

/// Returns the sizes of all runs of a level, in bytes, by mailbox. Collective.
std::vector<std::uint64_t> run_bytes(const MergeJob& job, int level) {
  const auto ranks = static_cast<std::uint32_t>(job.ranks.count());
  std::vector<std::uint64_t> mine((job.mailboxes + ranks - 1) / ranks);
  for (auto box = static_cast<std::uint32_t>(job.ranks.rank()); box < job.mailboxes; box += ranks)
    mine[box / ranks] = job.folder.open_written(words_name(level, box), job.work).bytes().size();
  const std::vector<std::uint64_t> all = job.ranks.all_gather(mine);
  std::vector<std::uint64_t> sizes(job.mailboxes);
  for (std::uint32_t box = 0; box < job.mailboxes; ++box)
    sizes[box] = all[box % ranks * mine.size() + box / ranks];
  return sizes;
}

void write_together(const MergeJob& job, const OrderedDag& dag, const Layout& layout,
                    const std::filesystem::path& path) {
  std::vector<std::uint64_t> places = {layout.nodes, layout.leaf_blocks, layout.end};
  places = job.ranks.all_gather(places);  // those of rank 0 come first
  SharedFile file(job.ranks, path, places[2]);
  if (job.ranks.rank() == 0) {
    file.write_at(0, layout.head);
    file.write_at(layout.meta, std::as_bytes(std::span<const char>(layout.json)));
    file.write_at(layout.levels, level_bytes(dag));
  }
  std::uint64_t offset = places[0];
  for (int level = 0; dag.leaf_blocks != 0 && level <= job.levels - 2; ++level) {
    if (level == job.levels - 2) offset = places[1];
    const std::vector<std::uint64_t> sizes = run_bytes(job, level);
    for (std::uint32_t box = 0; box < job.mailboxes; offset += sizes[box++]) {
      if (box % static_cast<std::uint32_t>(job.ranks.count()) !=
          static_cast<std::uint32_t>(job.ranks.rank()))
        continue;
      std::uint64_t at = offset;
      read_run(job, dag, level, box, [&](std::span<const std::byte> bytes) {
        file.write_at(at, bytes);
        at += bytes.size();
      });
    }
  }
  file.commit();
}

}  // namespace

void write_vdag_from_runs(const MergeJob& job, const OrderedDag& dag, const VdagMetadata& metadata,
                          const std::filesystem::path& path) {
  Layout layout;
  if (job.ranks.rank() == 0)
    layout = with_file_name(path.string(), [&] { return make_layout(job, dag, metadata); });
  if (job.ranks.count() == 1)
    write_alone(job, dag, layout, path);
  else
    write_together(job, dag, layout, path);
}

}  // namespace voxdag
