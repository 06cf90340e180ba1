#include <gtest/gtest.h>

#include "json.hpp"
#include "npy_rays.hpp"
#include "process.hpp"
#include "support/temp_dir.hpp"

namespace voxdag::cli {
namespace {

using Json = nlohmann::json;

class Convert : public testing::Test {
 protected:
  Convert() {
    EXPECT_EQ(run_voxdag({"scene", "city", "--size", "1", "-o", mesh_, "--quiet"}).status, 0);
    EXPECT_EQ(run_voxdag({"build", mesh_, "-r", "256", "-o", plain_, "--quiet"}).status, 0);
  }
  /// Runs `voxdag convert` and expects that it succeeds.
  void convert(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "convert");
    const ProcessResult result = run_voxdag(arguments);
    EXPECT_EQ(result.status, 0) << result.err;
  }

  TempDir dir_;
  std::string mesh_ = dir_ / "mesh.ply", plain_ = dir_ / "plain.vdag", small_ = dir_ / "small.vdag";
};

TEST_F(Convert, ThereAndBackGivesTheSameBytes) {
  convert({plain_, "--compact", "-o", small_});
  EXPECT_LT(std::filesystem::file_size(small_), std::filesystem::file_size(plain_) / 2);
  convert({small_, "--plain", "-o", dir_ / "back.vdag"});
  EXPECT_EQ(read_text(dir_ / "back.vdag"), read_text(plain_));
  EXPECT_EQ(run_voxdag({"verify", small_, "--mesh", mesh_}).status, 0);
}

TEST_F(Convert, BuildWritesTheSameCompactFile) {
  convert({plain_, "--compact", "-o", small_, "--threads", "1"});
  const std::string built = dir_ / "built.vdag";
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "256", "--compact", "-o", built, "--quiet"}).status,
            0);
  EXPECT_EQ(read_text(built), read_text(small_));
}

TEST_F(Convert, TraceInPlaceFindsTheHitsOfThePlainForm) {
  convert({plain_, "--compact", "-o", small_});
  const std::string rays = dir_ / "rays.npy";
  std::vector<std::array<float, 8>> values;
  for (int i = 0; i < 500; ++i) {
    const auto at = static_cast<float>(i);
    values.push_back({-30, at / 9, 40, 0, 1, 0.01F * at - 2, -0.6F, 1e9F});
  }
  write_text(rays, rays_npy(values));
  const ProcessResult plain =
      run_voxdag({"trace", plain_, "--rays", rays, "-o", dir_ / "plain.npy"});
  ASSERT_EQ(plain.status, 0) << plain.err;
  EXPECT_EQ(plain.out.find(" 0 hits"), std::string::npos) << plain.out;
  const ProcessResult in_place =
      run_voxdag({"trace", small_, "--in-place", "--rays", rays, "-o", dir_ / "small.npy"});
  ASSERT_EQ(in_place.status, 0) << in_place.err;
  EXPECT_EQ(read_text(dir_ / "small.npy"), read_text(dir_ / "plain.npy"));

  const auto refused = [&](const std::vector<std::string>& words, int status,
                           const std::string& reason) {
    std::vector<std::string> all = {"trace", "--in-place", "--rays", rays, "-o", dir_ / "n.npy"};
    all.insert(all.end(), words.begin(), words.end());
    expect_failure(run_voxdag(all), status, reason);
    EXPECT_FALSE(std::filesystem::exists(dir_ / "n.npy"));
  };
  refused({plain_}, 1, "plain.vdag: does not have the compact form, which --in-place needs");
  refused({small_, "--device", "cuda"}, 2, "--in-place");
  convert({small_, "--levels", "3", "-o", dir_ / "tiny.vdag"});
  refused({dir_ / "tiny.vdag"}, 1, "has a grid of fewer than 16³ voxels, too few for --in-place");
}

TEST_F(Convert, EveryCommandTakesACompactDag) {
  convert({plain_, "--compact", "-o", small_});
  const std::string rays = dir_ / "rays.npy";
  write_text(rays, rays_npy({{-1000, 3, 1, 0, 1, 0, 0, 1e9F}, {0, 500, 0, 0, 0, -1, 0, 1e9F}}));
  for (const std::string& file : {plain_, small_}) {
    const std::string to = file == plain_ ? "plain" : "small";
    EXPECT_EQ(run_voxdag({"trace", file, "--rays", rays, "-o", dir_ / (to + ".npy")}).status, 0);
    EXPECT_EQ(run_voxdag({"export", file, "-o", dir_ / (to + ".ply"), "--quiet"}).status, 0);
    EXPECT_EQ(run_voxdag({"render", file, "--size", "48x32", "-o", dir_ / (to + ".png")}).status,
              0);
  }
  for (const char* ending : {".npy", ".ply", ".png"})
    EXPECT_EQ(read_text(dir_ / ("small" + std::string(ending))),
              read_text(dir_ / ("plain" + std::string(ending))))
        << ending;
}

TEST_F(Convert, InfoHasTheBytesOfBothForms) {
  convert({plain_, "--compact", "-o", small_});
  const Json plain = Json::parse(run_voxdag({"info", plain_, "--json"}).out);
  const Json small = Json::parse(run_voxdag({"info", small_, "--json"}).out);
  EXPECT_EQ(plain.at("voxels"), small.at("voxels"));
  EXPECT_EQ(plain.at("bytes").at("svdag_paper"), small.at("bytes").at("svdag_paper"));
  EXPECT_FALSE(plain.at("bytes").contains("compact"));
  const Json& parts = small.at("bytes").at("compact_parts");
  std::uint64_t sum = 0;
  for (const auto& [name, bytes] : parts.items()) sum += bytes.get<std::uint64_t>();
  EXPECT_EQ(small.at("bytes").at("compact"), sum);
  EXPECT_NE(run_voxdag({"info", small_}).out.find("shared bricks"), std::string::npos);
}

TEST_F(Convert, FewerLevelsKeepEveryVoxelsCell) {
  const std::string coarse = dir_ / "coarse.vdag";
  convert({plain_, "--levels", "6", "-o", coarse});
  const Json before = Json::parse(run_voxdag({"info", plain_, "--json"}).out);
  const Json after = Json::parse(run_voxdag({"info", coarse, "--json"}).out);
  EXPECT_EQ(after.at("resolution"), 64);
  EXPECT_EQ(after.at("voxels"), before.at("svo_nodes_per_level").at(6));
  EXPECT_EQ(after.at("transform").at("origin"), before.at("transform").at("origin"));
  EXPECT_EQ(after.at("transform").at("voxel_size").get<double>(),
            4 * before.at("transform").at("voxel_size").get<double>());
  EXPECT_EQ(run_voxdag({"verify", coarse}).status, 0);
  expect_failure(run_voxdag({"convert", plain_, "--levels", "9", "-o", coarse}), 1, "256");
  const std::string by_two = dir_ / "by_two.vdag";
  ASSERT_EQ(run_voxdag({"coarsen", plain_, "--by", "2", "-o", by_two}).status, 0);
  EXPECT_EQ(read_text(by_two), read_text(coarse));
  expect_failure(run_voxdag({"coarsen", plain_, "--by", "7", "-o", by_two}), 1,
                 "--by can drop 6 at most");
  expect_failure(run_voxdag({"coarsen", plain_, "-o", by_two}), 2, "--by");
}

TEST_F(Convert, ADamagedCompactFileIsRefusedByPlace) {
  convert({plain_, "--compact", "-o", small_});
  std::string bytes = read_text(small_);
  bytes[bytes.size() - 200] ^= 1;
  write_text(small_, bytes);
  expect_failure(run_voxdag({"info", small_}), 1, "chunk CSTR: checksum is wrong");
  expect_failure(run_voxdag({"verify", small_, "--quiet"}), 1, "chunk CSTR: checksum is wrong");
  expect_failure(run_voxdag({"convert", small_, "--plain", "-o", dir_ / "none.vdag"}), 1, "CSTR");
  EXPECT_FALSE(std::filesystem::exists(dir_ / "none.vdag"));
}

TEST_F(Convert, AnEsvoIsRefused) {
  const std::string esvo = dir_ / "a.esvo";
  ASSERT_EQ(run_voxdag({"build", mesh_, "-r", "32", "-o", esvo, "--quiet"}).status, 0);
  expect_failure(run_voxdag({"convert", esvo, "-o", small_}), 1, "holds an ESVO");
}

}  // namespace
}  // namespace voxdag::cli
