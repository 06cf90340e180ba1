#include "inspect/verify_compact.hpp"

#include <algorithm>

#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/vdag_format.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/compact/compact_bytes.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"
#include "voxdag/stored/svdag/validate_svdag.hpp"

namespace voxdag::cli {
namespace {

/// Throws Error unless the compact form of `dag` is the one of the file.
void check_bytes(const Svdag& dag, const CompactContents& file, Work work) {
  const CompactSvdag again = encode_svdag(dag.view(), {}, work);
  const auto check = [](const char* chunk, std::span<const std::byte> expected,
                        std::span<const std::byte> found) {
    if (!std::equal(expected.begin(), expected.end(), found.begin(), found.end()))
      throw Error("", ErrorPlace::chunk(chunk), "has not the bytes that its voxels lead to");
  };
  const std::vector<std::byte> head = compact_head(again);
  check("CHED", head, chunk_bytes(file.chunks, kChunkCompactHead, 1));
  check("CSTR", std::as_bytes(again.words()), chunk_bytes(file.chunks, kChunkCompactStream, 1));
}

}  // namespace

VerifyReport verify_compact(const VdagContainer& file, Work work) {
  VerifyReport report;
  CompactContents contents;
  Svdag dag;
  // Cancelled is an Error, but no result of a check.
  const auto check = [&](const char* name, std::initializer_list<std::size_t> needed,
                         const auto& body) {
    run_check(report, name, needed, body);
    work.poll();
  };
  enum : std::size_t { kContainer, kChecksums, kMetadata, kStructure };
  check("container", {}, [&] { contents.chunks = read_vdag_chunks(file.bytes()); });
  check("checksums", {kContainer}, [&] { check_vdag_checksums(contents.chunks); });
  check("metadata", {kContainer}, [&] { contents.metadata = read_vdag_metadata(contents.chunks); });
  check("structure", {kContainer, kChecksums, kMetadata}, [&] {
    contents = parse_compact(file.bytes());
    dag = decode_svdag(contents.view(), work);
    validate_svdag(dag.view());
  });
  check("canonical", {kStructure}, [&] { check_bytes(dag, contents, work); });
  check("counts", {kStructure},
        [&] { compare_counts(contents.metadata.counts, count_svdag(dag.view())); });
  check("attributes", {kStructure}, [&] {
    CellIndex index;
    ExpandedChunks expanded;
    DagAttributesView stored;
    if (contents.has_attributes()) {
      index = build_cell_index(dag.view(), contents.metadata.attributes.level());
      stored = contents.attributes(index.view(), expanded);
    }
    if (!dag.view().is_empty()) compare_attributes(contents.metadata.attributes, stored);
  });
  return report;
}

}  // namespace voxdag::cli
