#include "voxdag/file/verify_vdag.hpp"

#include <algorithm>

#include "voxdag/core/error.hpp"
#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/esvo_parse.hpp"
#include "voxdag/file/vdag_parse.hpp"
#include "voxdag/file/wire_chunks.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"
#include "voxdag/stored/svdag/validate_svdag.hpp"

namespace voxdag {
namespace {

using Result = VerifyCheck::Result;

void compare(const std::string& name, std::uint64_t stated, std::uint64_t counted) {
  if (stated != counted)
    throw Error("", ErrorPlace::chunk("META") / ("counts." + name),
                "is " + std::to_string(stated) + ", but the DAG has " + std::to_string(counted));
}

void compare_levels(const std::string& name, const std::vector<std::uint64_t>& stated,
                    const std::vector<std::uint64_t>& counted) {
  for (std::size_t level = 0; level < counted.size(); ++level)
    compare(name + '[' + std::to_string(level) + ']', stated[level], counted[level]);
}

}  // namespace

void compare_counts(const SvdagCounts& stated, const SvdagCounts& counted) {
  compare("voxels", stated.voxels, counted.voxels);
  compare_levels("svo_nodes_per_level", stated.svo_nodes_per_level, counted.svo_nodes_per_level);
  compare_levels("dag_nodes_per_level", stated.dag_nodes_per_level, counted.dag_nodes_per_level);
}

void compare_attributes(const AttributesMetadata& stated, const DagAttributesView& stored) {
  const auto fail = [](const char* key, const std::string& reason) {
    throw Error("", ErrorPlace::chunk("META") / key, reason);
  };
  const auto compare_values = [&](const char* key, const char* chunk, bool is_stated,
                                  bool is_stored) {
    if (is_stated && !is_stored)
      fail(key, std::string("describes the chunk ") + chunk + ", which is missing");
    if (is_stored && !is_stated)
      fail(key, std::string("is missing, but the file has the chunk ") + chunk);
  };
  if (stated.resolution == 0 && !stored.is_empty())
    fail("attributes", "is missing, but the file has attributes");
  compare_values("attributes.color", "COLR", stated.colors.has_value(), stored.has_colors());
  compare_values("attributes.normal", "NRML", stated.normals.has_value(), stored.has_normals());
  compare_values("attributes.material", "MTID", stated.materials.has_value(),
                 stored.has_materials());
  if (stored.has_materials() && stated.materials->size() != stored.materials.materials)
    fail("attributes.material.names",
         "has " + std::to_string(stated.materials->size()) + " names, but the chunk MTID has " +
             std::to_string(stored.materials.materials) + " materials");
  const std::int64_t resolution = std::int64_t{1} << stored.index.finest_level;
  if (!stored.is_empty() && stated.resolution != resolution)
    fail("attributes.resolution", "is " + std::to_string(stated.resolution) +
                                      ", but the chunk CIDX has " + std::to_string(resolution));
}

namespace {

VerifyReport verify_esvo(std::span<const std::byte> file) {
  VerifyReport report;
  EsvoContents contents;
  enum : std::size_t { kContainer, kChecksums, kMetadata };
  run_check(report, "container", {}, [&] { contents.chunks = read_vdag_chunks(file); });
  run_check(report, "checksums", {kContainer}, [&] { check_vdag_checksums(contents.chunks); });
  run_check(report, "metadata", {kContainer},
            [&] { contents.metadata = read_esvo_metadata(contents.chunks); });
  run_check(report, "structure", {kContainer, kMetadata}, [&] {
    contents.directory = read_esvo_directory(contents.chunks);
    contents.view = read_esvo_view(contents.chunks, contents.metadata);
    check_esvo_contents(contents);
  });
  return report;
}

VerifyReport verify_long(std::span<const std::byte> file) {
  VerifyReport report;
  std::vector<VdagChunk> chunks;
  VdagMetadata metadata;
  LongSvdagView dag;
  enum : std::size_t { kContainer, kChecksums, kMetadata, kStructure };
  run_check(report, "container", {}, [&] { chunks = read_vdag_chunks(file); });
  run_check(report, "checksums", {kContainer}, [&] { check_vdag_checksums(chunks); });
  run_check(report, "metadata", {kContainer}, [&] { metadata = read_vdag_metadata(chunks); });
  run_check(report, "structure", {kContainer, kMetadata}, [&] {
    dag = read_vdag_long_svdag(chunks, metadata.grid.levels);
    check_vdag_svdag(dag, validate_svdag);
  });
  run_check(report, "canonical order", {kStructure},
            [&] { check_vdag_svdag(dag, check_canonical); });
  run_check(report, "minimality", {kStructure}, [&] { check_vdag_svdag(dag, check_minimal); });
  run_check(report, "counts", {kStructure, kMetadata},
            [&] { compare_counts(metadata.counts, count_svdag(dag)); });
  run_check(report, "attributes", {kStructure}, [&] {
    if (!dag.is_empty()) compare_attributes(metadata.attributes, {});
  });
  return report;
}

}  // namespace

bool VerifyReport::passed() const {
  return std::all_of(checks.begin(), checks.end(),
                     [](const VerifyCheck& check) { return check.result == Result::kPassed; });
}

VerifyReport verify_vdag(const std::filesystem::path& path) {
  return verify_vdag(VdagContainer(path));
}

VerifyReport verify_vdag(const VdagContainer& file) {
  if (file.is(VdagKind::kLong)) return verify_long(file.bytes());
  if (file.is(VdagKind::kEsvo)) return verify_esvo(file.bytes());
  VerifyReport report;
  VdagContents contents;
  enum : std::size_t { kContainer, kChecksums, kMetadata, kStructure };
  run_check(report, "container", {}, [&] { contents.chunks = read_vdag_chunks(file.bytes()); });
  run_check(report, "checksums", {kContainer}, [&] { check_vdag_checksums(contents.chunks); });
  run_check(report, "metadata", {kContainer},
            [&] { contents.metadata = read_vdag_metadata(contents.chunks); });
  run_check(report, "structure", {kContainer, kMetadata}, [&] {
    contents.view = read_vdag_svdag(contents.chunks, contents.metadata.grid.levels);
    check_vdag_svdag(contents.view, validate_svdag);
  });
  run_check(report, "canonical order", {kStructure},
            [&] { check_vdag_svdag(contents.view, check_canonical); });
  run_check(report, "minimality", {kStructure},
            [&] { check_vdag_svdag(contents.view, check_minimal); });
  run_check(report, "counts", {kStructure, kMetadata},
            [&] { compare_counts(contents.metadata.counts, count_svdag(contents.view)); });
  run_check(report, "attributes", {kStructure}, [&] {
    expand_wire_chunks(contents.chunks, contents.expanded);
    const DagAttributesView stored = read_attribute_chunks(contents.chunks, contents.view);
    if (!contents.view.is_empty()) compare_attributes(contents.metadata.attributes, stored);
  });
  return report;
}

}  // namespace voxdag
