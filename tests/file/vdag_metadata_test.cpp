#include "voxdag/file/vdag_metadata.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "support/error_of.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

VdagMetadata example() { return example_metadata(brute_svdag(3, {{1, 2, 3}}).view()); }

std::string metadata_error_of(const std::string& json) {
  return voxdag::error_of([&] { parse_vdag_metadata(json); });
}

/// Returns the example's JSON with one piece of text changed.
std::string with(const std::string& from, const std::string& to) {
  std::string json = vdag_metadata_json(example());
  const std::size_t at = json.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return json.replace(at, from.size(), to);
}

TEST(VdagMetadata, ReadsBackWhatItWrote) {
  EXPECT_EQ(parse_vdag_metadata(vdag_metadata_json(example())), example());
}

TEST(VdagMetadata, IsTheJsonOfTheSpecification) {
  EXPECT_EQ(vdag_metadata_json(example()),
            R"({"grid":{"levels":3,"origin":[-1.5,0.1,1000000.0],"voxel_size":0.01,)"
            R"("quantization_scale":25599.7},"counts":{"voxels":1,"svo_nodes_per_level":[1,1,1],)"
            R"("dag_nodes_per_level":[1,1,1]},"source":{"name":"bunny.ply","vertices":34834,)"
            R"("triangles":69451},"program":"voxdag test","build":{"cover":"exact"}})");
}

TEST(VdagMetadata, UpUnitAndHomeAreOptionalKeys) {
  VdagMetadata metadata = example();
  metadata.presentation = {'z', "mm", HomeView{{{1, 2, 3}, {0.5, 0, 0}, {0, 0, 1}, 35}, {}}};
  const std::string json = vdag_metadata_json(metadata);
  EXPECT_TRUE(json.ends_with(R"("up":"z","unit":"mm","home":{"eye":[1.0,2.0,3.0],)"
                             R"("target":[0.5,0.0,0.0],"up":[0.0,0.0,1.0],"fov":35.0}})"));
  EXPECT_EQ(parse_vdag_metadata(json), metadata);
  VdagMetadata guessed = metadata;
  guessed.presentation.is_up_guessed = true;
  EXPECT_EQ(parse_vdag_metadata(vdag_metadata_json(guessed)), guessed);
  const auto error_with = [&](const std::string& from, const std::string& to) {
    std::string changed = json;
    return metadata_error_of(changed.replace(changed.find(from), from.size(), to));
  };
  EXPECT_EQ(error_with(R"("up":"z")", R"("up":"w")"), "up: is none of x, y and z");
  EXPECT_EQ(error_with("[1.0,2.0,3.0]", "[0.5,0.0,0.0]"),
            "home: has no direction, or an up vector along it");
  EXPECT_EQ(error_with("[0.0,0.0,1.0]", "[1.0,4.0,6.0]"),
            "home: has no direction, or an up vector along it");
  EXPECT_EQ(error_with(R"("fov":35.0)", R"("fov":180)"),
            "home.fov: not an angle from 0.000001 to below 180 degrees");
}

TEST(VdagMetadata, DoublesReadBackBitForBit) {
  std::mt19937_64 rng(1);
  VdagMetadata metadata = example();
  const auto same = [](double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  };
  for (int i = 0; i < 20000; ++i) {
    double value = std::bit_cast<double>(rng());
    // Skips values for which the grid's far corner would overflow, because they are refused.
    if (!std::isfinite(value) || std::abs(value) > 1e300) continue;
    metadata.grid.origin = {value, -value, -0.0};
    const Grid grid = parse_vdag_metadata(vdag_metadata_json(metadata)).grid;
    ASSERT_TRUE(same(grid.origin.x, value) && same(grid.origin.y, -value) &&
                same(grid.origin.z, -0.0))
        << value;
  }
}

TEST(VdagMetadata, LargeCountsReadBack) {
  VdagMetadata metadata = example();
  metadata.counts.voxels = ~std::uint64_t{0};
  EXPECT_EQ(parse_vdag_metadata(vdag_metadata_json(metadata)), metadata);
}

TEST(VdagMetadata, ANameThatIsNoUtf8IsStillWritten) {
  VdagMetadata metadata = example();
  metadata.source.name =
      "b\xFC"
      "cher.obj";
  EXPECT_EQ(parse_vdag_metadata(vdag_metadata_json(metadata)).source.name,
            "b\xEF\xBF\xBD"
            "cher.obj");
}

TEST(VdagMetadata, UnknownKeysAreIgnored) {
  EXPECT_EQ(parse_vdag_metadata(with("\"program\"", "\"later\":[1,{}],\"program\"")), example());
}

TEST(VdagMetadata, NamesTheFault) {
  EXPECT_EQ(metadata_error_of(""), "byte 1: not valid JSON");
  EXPECT_EQ(metadata_error_of("{\"grid\":"), "byte 9: not valid JSON");
  EXPECT_EQ(
      metadata_error_of(vdag_metadata_json(example()) + "x"),
      "byte " + std::to_string(vdag_metadata_json(example()).size() + 1) + ": not valid JSON");
  EXPECT_EQ(metadata_error_of("[]"), "not an object");
  EXPECT_EQ(metadata_error_of("{}"), "grid: missing");
  EXPECT_EQ(metadata_error_of(with("\"levels\":3", "\"levels\":1")),
            "grid.levels: 1 is not in the range 2 to 20");
  EXPECT_EQ(metadata_error_of(with("\"levels\":3", "\"levels\":3.0")),
            "grid.levels: not a whole number of 0 or more");
  EXPECT_EQ(metadata_error_of(with("\"levels\":3", "\"levels\":-3")),
            "grid.levels: not a whole number of 0 or more");
  EXPECT_EQ(metadata_error_of(with("\"levels\":3", "\"levels\":4")),
            "counts.svo_nodes_per_level: not an array of 4 values");
  EXPECT_EQ(metadata_error_of(with("[-1.5,", "[")), "grid.origin: not an array of 3 values");
  EXPECT_EQ(metadata_error_of(with("-1.5", "null")), "grid.origin[0]: not a finite number");
  EXPECT_EQ(metadata_error_of(with("\"voxel_size\":0.01", "\"voxel_size\":0.0")),
            "grid.voxel_size: not positive");
  EXPECT_EQ(metadata_error_of(with("\"voxel_size\":0.01", "\"voxel_size\":1e308")),
            "grid: the far corner of the grid is not a finite number");
  EXPECT_EQ(metadata_error_of(with("\"voxel_size\":0.01", "\"voxel_size\":4e-324")),
            "grid.voxel_size: is too small: 1 / voxel_size is not a finite number");
  EXPECT_EQ(metadata_error_of(with("\"voxels\":1", "\"voxels\":\"1\"")),
            "counts.voxels: not a whole number of 0 or more");
  EXPECT_EQ(metadata_error_of(with("\"bunny.ply\"", "7")), "source.name: not a string");
  EXPECT_EQ(metadata_error_of(with("\"exact\"", "1")), "build.cover: not a string");
  EXPECT_NE(metadata_error_of(with("0.01", "1e999")).find("not valid JSON"), std::string::npos);
}

}  // namespace
}  // namespace voxdag
