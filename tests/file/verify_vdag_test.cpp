#include "voxdag/file/verify_vdag.hpp"

#include <gtest/gtest.h>

#include "support/number_colors.hpp"
#include "support/vdag_bytes.hpp"

namespace voxdag {
namespace {

/// Returns a summary: "container checksums! metadata -structure ...". "!" marks failed checks, "-"
/// skipped ones.
std::string summary(const VerifyReport& report) {
  std::string text;
  for (const VerifyCheck& check : report.checks) {
    if (!text.empty()) text += ", ";
    if (check.result == VerifyCheck::Result::kSkipped) text += "-";
    text += check.name;
    if (check.result == VerifyCheck::Result::kFailed) text += "! " + check.detail;
  }
  return text;
}

std::string verify(const std::string& bytes) {
  const TempDir dir;
  write_text(dir / "a.vdag", bytes);
  const VerifyReport report = verify_vdag(dir / "a.vdag");
  EXPECT_EQ(report.passed(), summary(report).find_first_of("!-") == std::string::npos);
  return summary(report);
}

TEST(VerifyVdag, AValidFilePassesEveryCheck) {
  for (int levels = 2; levels <= 7; ++levels)
    for (const int count : {0, 1, 100})
      EXPECT_EQ(verify(vdag_file_bytes(brute_svdag(levels, random_voxels(levels, count, 3)))),
                "container, checksums, metadata, structure, canonical order, minimality, counts, "
                "attributes");
}

TEST(VerifyVdag, ADamagedContainerSkipsTheRest) {
  EXPECT_EQ(verify("nothing"),
            "container! header: not a .vdag file, -checksums, -metadata, -structure, "
            "-canonical order, -minimality, -counts, -attributes");
}

TEST(VerifyVdag, AWrongChecksumIsTheOnlyFaultOfAnOtherwiseValidFile) {
  std::string bytes = vdag_file_bytes(brute_svdag(4, {{0, 0, 0}, {15, 15, 15}}));
  bytes[bytes.find("bunny")] = 'f';
  EXPECT_EQ(verify(bytes),
            "container, checksums! chunk META: checksum is wrong, metadata, structure, "
            "canonical order, minimality, counts, attributes");
}

TEST(VerifyVdag, FindsADagThatIsNotMinimal) {
  Svdag dag = brute_svdag(4, {{0, 0, 0}, {15, 15, 15}});
  dag.leaf_blocks[1] = dag.leaf_blocks[0];
  EXPECT_EQ(verify(vdag_file_bytes(dag)),
            "container, checksums, metadata, structure, canonical order, minimality! "
            "chunk LEAF, leaf block 1: leaf block equals an earlier leaf block, counts, "
            "attributes");
}

TEST(VerifyVdag, FindsAnotherOrder) {
  Svdag dag = brute_svdag(4, {{0, 0, 0}, {15, 15, 15}});
  std::swap(dag.nodes[1], dag.nodes[2]);
  EXPECT_EQ(verify(vdag_file_bytes(dag)),
            "container, checksums, metadata, structure, canonical order! chunk NODE, level 0, "
            "word 1: child is not the next in depth-first order, minimality, counts, attributes");
}

TEST(VerifyVdag, FindsWrongCounts) {
  const TempDir dir;
  const Svdag dag = brute_svdag(4, {{0, 0, 0}, {15, 15, 15}});
  VdagMetadata metadata = example_metadata(dag.view());
  metadata.counts.svo_nodes_per_level[1] = 3;
  write_vdag(dir / "a.vdag", dag.view(), metadata);
  EXPECT_EQ(
      summary(verify_vdag(dir / "a.vdag")),
      "container, checksums, metadata, structure, canonical order, minimality, "
      "counts! chunk META, counts.svo_nodes_per_level[1]: is 3, but the DAG has 2, attributes");
}

TEST(VerifyVdag, FindsMetadataOfOtherAttributes) {
  const Svdag dag = brute_svdag(4, {{0, 0, 0}, {15, 15, 15}});
  const NumberColors colors(dag.view(), 3);
  const auto detail = [&](const auto& change) {
    const TempDir dir;
    VdagMetadata metadata = example_metadata(dag.view());
    metadata.attributes.resolution = 8;
    metadata.attributes.colors.emplace();
    metadata.attributes.normals.emplace();
    metadata.attributes.materials.emplace(kNumberMaterials, "a");
    change(metadata.attributes);
    write_vdag(dir / "a.vdag", dag.view(), metadata, colors.view().attributes);
    return verify_vdag(dir / "a.vdag").checks.back().detail;
  };
  EXPECT_EQ(detail([](AttributesMetadata&) {}), "");
  EXPECT_EQ(detail([](AttributesMetadata& stated) { stated = {}; }),
            "chunk META, attributes: is missing, but the file has attributes");
  EXPECT_EQ(detail([](AttributesMetadata& stated) { stated.resolution = 16; }),
            "chunk META, attributes.resolution: is 16, but the chunk CIDX has 8");
  EXPECT_EQ(detail([](AttributesMetadata& stated) { stated.colors.reset(); }),
            "chunk META, attributes.color: is missing, but the file has the chunk COLR");
  EXPECT_EQ(detail([](AttributesMetadata& stated) { stated.materials->pop_back(); }),
            "chunk META, attributes.material.names: has 4 names, but the chunk MTID has 5 "
            "materials");
  const TempDir dir;
  VdagMetadata metadata = example_metadata(dag.view());
  metadata.attributes.resolution = 8;
  metadata.attributes.normals.emplace();
  write_vdag(dir / "a.vdag", dag.view(), metadata);
  EXPECT_EQ(verify_vdag(dir / "a.vdag").checks.back().detail,
            "chunk META, attributes.normal: describes the chunk NRML, which is missing");
}

}  // namespace
}  // namespace voxdag
