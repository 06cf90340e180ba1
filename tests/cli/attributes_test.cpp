// Tests `voxdag build --color --normal` and the commands that use such files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "attributes_command.hpp"
#include "json.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/vdag_file.hpp"

namespace voxdag::cli {
namespace {

/// The encoder of ESVOs rounds differently, so colours and normals are only similar.
TEST_F(AttributesCommand, HitsHaveTheColoursAndNormalsOfAnEsvoOfTheSameVoxels) {
  const std::string dag = build("a.vdag", {"--color", "--normal", "--color-bound", "0"});
  const std::string esvo = build("a.esvo", {"--no-contours"});
  write_rays(VdagFile(dag).grid());
  const std::vector<std::string> of_dag = trace(dag), of_esvo = trace(esvo);
  ASSERT_EQ(of_dag.size(), of_esvo.size());
  int hits = 0;
  double color_distances = 0, cosines = 0;
  for (std::size_t i = 0; i < of_dag.size(); ++i) {
    const Hit a(of_dag[i]), b(of_esvo[i]);
    ASSERT_EQ(a.geometry, b.geometry);
    if (!a.is_hit) continue;
    ++hits;
    cosines += static_cast<double>(dot(a.normal, b.normal));
    for (std::size_t c = 0; c < 3; ++c) color_distances += std::abs(a.color[c] - b.color[c]) / 3.0;
  }
  ASSERT_GT(hits, 300);
  EXPECT_LT(color_distances / hits, 8);
  EXPECT_GT(cosines / hits, 0.995);
}

TEST_F(AttributesCommand, ACopyOfTheLookGivesTheSameHits) {
  const std::string colored = build("a.vdag", {"--color", "--normal"}), grey = build("b.vdag", {});
  write_rays(VdagFile(colored).grid());
  EXPECT_EQ(trace(grey, {"--look", colored}), trace(colored));
}

TEST_F(AttributesCommand, TheGeometryIsThatOfABuildWithoutColours) {
  const VdagFile colored(build("a.vdag", {"--color"})), grey(build("b.vdag", {}));
  for (std::size_t i = 1; i < 4; ++i) {
    const VdagChunk &a = colored.chunks()[i], &b = grey.chunks()[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_TRUE(std::equal(a.bytes.begin(), a.bytes.end(), b.bytes.begin(), b.bytes.end()));
  }
  EXPECT_EQ(colored.metadata().counts, grey.metadata().counts);
  EXPECT_EQ(colored.metadata().source, grey.metadata().source);
}

TEST_F(AttributesCommand, AnyNumberOfThreadsWritesTheSameFile) {
  const std::vector<std::string> options = {"--color", "--normal", "--threads"};
  const auto with = [&](const std::string& name, const std::string& threads) {
    std::vector<std::string> all = options;
    all.push_back(threads);
    return read_text(build(name, all));
  };
  EXPECT_EQ(with("a.vdag", "1"), with("b.vdag", "3"));
}

TEST_F(AttributesCommand, InfoTellsTheirSizesAndErrors) {
  const std::string dag = build("a.vdag", {"--color", "--normal", "--attribute-resolution", "32"});
  const auto json = nlohmann::json::parse(run_voxdag({"info", dag, "--json"}).out);
  const auto& attributes = json.at("attributes");
  for (const char* kind : {"color", "normal"}) {
    EXPECT_EQ(attributes.at(kind).at("resolution"), 32);
    EXPECT_EQ(attributes.at(kind).at("cells"), json.at("svo_nodes"));
    EXPECT_GT(attributes.at(kind).at("bits_per_cell"), 0);
  }
  EXPECT_GT(attributes.at("color").at("psnr_db"), 25);
  EXPECT_LT(attributes.at("normal").at("mean_degrees"), 4);
  const std::string text = run_voxdag({"info", dag}).out;
  for (const char* part : {"colours", "normals", "bits/cell", "PSNR"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  const std::string lossless = build("b.vdag", {"--color", "--color-bound", "0"});
  const auto exact = nlohmann::json::parse(run_voxdag({"info", lossless, "--json"}).out);
  EXPECT_TRUE(exact.at("attributes").at("color").at("psnr_db").is_null());
  EXPECT_NE(run_voxdag({"info", lossless}).out.find("bits/cell, lossless"), std::string::npos);
}

TEST_F(AttributesCommand, VerifyChecksThem) {
  const std::string dag = build("a.vdag", {"--color", "--normal"});
  EXPECT_EQ(run_voxdag({"verify", dag}).status, 0);
  std::string bytes = read_text(dag);
  const VdagChunkEntry normals = find_entry(bytes, kChunkNormals);
  bytes[normals.offset + normals.length - 1] ^= 1;
  write_text(dag, bytes);
  EXPECT_EQ(run_voxdag({"verify", dag}).status, 1);
}

TEST_F(AttributesCommand, PicturesShowThem) {
  const std::string dag = build("a.vdag", {"--color"}), grey = build("b.vdag", {});
  const auto picture = [&](const std::string& scene) {
    const ProcessResult result =
        run_voxdag({"render", scene, "--size", "64x64", "--ao", "0", "-o", dir_ / "a.png"});
    EXPECT_EQ(result.status, 0) << result.err;
    return read_text(dir_ / "a.png");
  };
  EXPECT_NE(picture(dag), picture(grey));
}

TEST_F(AttributesCommand, ConvertKeepsOrDropsThem) {
  const std::string colored = build("a.vdag", {"--color", "--normal"}), grey = build("b.vdag", {});
  const auto convert = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"convert", colored, "-o", dir_ / "c.vdag"});
    return run_voxdag(options);
  };
  ASSERT_EQ(convert({}).status, 0);
  EXPECT_EQ(read_text(dir_ / "c.vdag"), read_text(colored));
  ASSERT_EQ(convert({"--drop-attributes"}).status, 0);
  EXPECT_EQ(read_text(dir_ / "c.vdag"), read_text(grey));
  EXPECT_EQ(convert({"--compact", "--drop-attributes"}).status, 0);
}

TEST_F(AttributesCommand, ExportWritesThem) {
  const std::string plain = build("a.vdag", {"--color", "--normal"}), grey = build("b.vdag", {}),
                    small = build("c.vdag", {"--color", "--normal", "--compact"});
  const auto exported = [&](const std::string& file, const std::string& to,
                            std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"export", file, "--quiet", "-o", dir_ / to});
    const ProcessResult result = run_voxdag(options);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_text(dir_ / to);
  };
  for (const char* to : {"v.npy", "v.ply"}) {
    const std::string colored = exported(plain, to), plainly = exported(grey, to);
    EXPECT_GT(colored.size(), 1.9 * static_cast<double>(plainly.size()));
    EXPECT_EQ(exported(small, to), colored);
    EXPECT_EQ(exported(plain, to, {"--grey"}), plainly);
    EXPECT_EQ(exported(grey, to, {"--look", small}), colored);
  }
  EXPECT_NE(exported(plain, "f.ply", {"--faces"}).find("property uchar red"), std::string::npos);
  expect_failure(run_voxdag({"export", plain, "--grey", "-o", dir_ / "v.raw"}), 2,
                 "cannot hold colours");
}

TEST_F(AttributesCommand, ACoarserGridKeepsTheColoursOfItsCells) {
  const std::string fine = build("a.vdag", {"--color", "--normal", "--color-bound", "0.03",
                                            "--normal-bound", "4"}),
                    coarse = dir_ / "b.vdag", same = dir_ / "c.vdag";
  ASSERT_EQ(run_voxdag({"convert", fine, "--levels", "4", "-o", coarse}).status, 0);
  EXPECT_EQ(run_voxdag({"verify", coarse}).status, 0);
  const auto attributes = [](const std::string& file) {
    return nlohmann::json::parse(run_voxdag({"info", file, "--json"}).out).at("attributes");
  };
  EXPECT_EQ(attributes(coarse).at("color").at("resolution"), 16);
  EXPECT_EQ(attributes(coarse).at("color").at("bound"), 0.03);
  EXPECT_FALSE(attributes(coarse).at("color").contains("psnr_db"));
  EXPECT_FALSE(attributes(coarse).at("normal").contains("mean_degrees"));
  ASSERT_EQ(run_voxdag({"convert", fine, "--levels", "4", "--color-bound", "0.02", "--normal-bound",
                        "3", "-o", same})
                .status,
            0);
  EXPECT_EQ(attributes(same).at("color").at("bound"), 0.05);
  EXPECT_EQ(attributes(same).at("normal").at("bound"), 7);
  EXPECT_LT(attributes(same).at("color").at("bytes"), attributes(coarse).at("color").at("bytes"));
  expect_failure(run_voxdag({"convert", fine, "--color-bound", "0.1", "-o", same}), 2,
                 "without --levels");
  // Attributes that are as coarse as the coarse grid keep their bytes and errors.
  const std::string coarsely = build("d.vdag", {"--color", "--attribute-resolution", "16"});
  ASSERT_EQ(run_voxdag({"convert", coarsely, "--levels", "4", "--compact", "-o", same}).status, 0);
  EXPECT_EQ(attributes(same).at("color"), attributes(coarsely).at("color"));
  // Hits at the coarse voxels show what the fine file stores for these cells.
  write_rays(VdagFile(coarse).grid());
  EXPECT_EQ(trace(coarse), trace(coarse, {"--look", fine}));
}

TEST_F(AttributesCommand, VerifyComparesThemWithTheMesh) {
  const std::string dag = build("a.vdag", {"--color", "--normal", "--compact"}),
                    mesh = dir_ / "waves.obj";
  const ProcessResult result = run_voxdag({"verify", dag, "--mesh", mesh});
  EXPECT_EQ(result.status, 0) << result.err;
  for (const char* text : {"colours         passed", "normals         passed", "largest error 0.0"})
    EXPECT_NE(result.out.find(text), std::string::npos) << text << "\n" << result.out;
  // The red of the first block of colours changes; all checksums are right. Its bits follow the 9
  // bits of the block's header at the start of the chunk's words.
  std::string bytes = read_text(dag);
  const std::uint64_t chunk = find_entry(bytes, kChunkColors).offset;
  const CellPagesView pages{.values = peek<ValuePagesHeader>(bytes, chunk).values};
  const std::uint64_t words = chunk + sizeof(ValuePagesHeader) + 8 * pages.group_count();
  bytes[words + 1] ^= 0x30;
  repair_checksums(bytes);
  write_text(dag, bytes);
  EXPECT_EQ(run_voxdag({"verify", dag}).status, 0);
  expect_failure(run_voxdag({"verify", dag, "--mesh", mesh, "--quiet"}), 1,
                 "the bound and rounding allow");
}

TEST_F(AttributesCommand, OptionsWithoutEffectAreRefused) {
  expect_failure(run_build("a.vdag", {"--attribute-resolution", "32"}), 2, "without --color");
  expect_failure(run_build("a.vdag", {"--normal", "--color-bound", "0.1"}), 2, "without --color");
  expect_failure(run_build("a.vdag", {"--color", "--normal-bound", "3"}), 2, "without --normal");
  expect_failure(run_build("a.vdag", {"--color", "--attribute-resolution", "128"}), 2,
                 "128 is more than the grid's resolution, 64");
  expect_failure(run_voxdag({"build", dir_ / "waves.obj", "--voxel-size", "1", "-o",
                             dir_ / "a.vdag", "--color", "--attribute-resolution", "1024"}),
                 1, "1024 is more than the grid's resolution, ");
  expect_failure(run_build("a.esvo", {"--color"}), 2, "is for DAGs only");
  EXPECT_EQ(dir_.count(), 1);
}

}  // namespace
}  // namespace voxdag::cli
