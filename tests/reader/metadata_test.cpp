// Tests how include/voxdag.h reads META: numbers to the bit, and the JSON that others may write.
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "reader/header_scene.hpp"

namespace voxdag {
namespace {

/// Returns a file with this JSON as META.
std::string file_with(const std::string& json) {
  static const std::string bytes = vdag_file_bytes(brute_svdag(3, {{1, 2, 3}}));
  return with_chunk(bytes, kChunkMeta, json);
}

std::string example_json() {
  return vdag_metadata_json(example_metadata(brute_svdag(3, {{1, 2, 3}}).view()));
}

/// Returns the example's JSON with one piece of text changed.
std::string json_with(const std::string& from, const std::string& to) {
  std::string json = example_json();
  const std::size_t at = json.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return json.replace(at, from.size(), to);
}

/// Expects that both readers refuse the file, or read equal members.
void expect_same(const std::string& json) {
  EXPECT_EQ(disagreement(file_with(json), 10), "") << json;
}

TEST(ReaderMetadata, DoublesAreReadToTheBit) {
  std::mt19937_64 rng(1);
  VdagMetadata metadata = example_metadata(brute_svdag(3, {{1, 2, 3}}).view());
  for (int i = 0; i < 600; ++i) {
    double value = std::bit_cast<double>(rng());
    if (i % 3 == 0) value = std::bit_cast<double>(rng() % (std::uint64_t{1} << 53));
    if (i % 3 == 1) value = static_cast<double>(rng() % 1000000) / 1000;
    if (!std::isfinite(value) || std::abs(value) > 1e300) continue;
    metadata.grid.origin = {value, -value, 0.5 * value};
    const HeaderScene header(file_with(vdag_metadata_json(metadata)));
    ASSERT_TRUE(header.is_open()) << header.error();
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_EQ(std::bit_cast<std::uint64_t>(header.scene().info.origin[axis]),
                std::bit_cast<std::uint64_t>(metadata.grid.origin[axis]))
          << value;
  }
}

TEST(ReaderMetadata, DecimalsAreRoundedToTheNearestDouble) {
  for (const char* number : {"9007199254740993",
                             "9007199254740993.0000000000000000000000000000000001",
                             "9007199254740992.9999999999999999999999999999999999",
                             "18446744073709551615",
                             "18446744073709551616",
                             "1.00000000000000011102230246251565404236316680908203125",
                             "1.00000000000000011102230246251565404236316680908203124",
                             "1.00000000000000011102230246251565404236316680908203126",
                             "1.00000000000000033306690738754696212708950042724609375",
                             "2.2250738585072011e-308",
                             "2.2250738585072012e-308",
                             "2.2250738585072014e-308",
                             "4.9406564584124654e-324",
                             "2.4703282292062327e-324",
                             "2.4703282292062328e-324",
                             "2.4703282292062329e-324",
                             "1e-400",
                             "7.4109846876186982e-324",
                             "1.7976931348623157e308",
                             "1.7976931348623158e308",
                             "1.7976931348623159e308",
                             "1e309",
                             "-1e309",
                             "1e-5",
                             "1E5",
                             "1e+5",
                             "-0",
                             "-0.0",
                             "0",
                             "0.0",
                             "0e5",
                             "0.000000000000000000000000000000000000000001e42",
                             "123456789e-9",
                             "5e-324",
                             "3e-324",
                             "2e-324",
                             "8.98846567431158e307",
                             "0.1",
                             "1e22",
                             "1e23",
                             "8.442911973260991817129021e-309",
                             "1e1000000000000",
                             "1e-1000000000000"})
    expect_same(json_with("-1.5", number));
  expect_same(json_with("-1.5", "0." + std::string(700, '0') + "1"));
  expect_same(json_with("-1.5", std::string(300, '7') + "." + std::string(400, '3')));
  expect_same(json_with("-1.5", "1" + std::string(500, '0') + "e-500"));
}

TEST(ReaderMetadata, NumbersThatJsonDoesNotHaveAreRefused) {
  for (const char* text : {"", "-", "+1", "01", ".5", "5.", "1e", "1e+", "0x10", "nan", "Infinity",
                           "1 2", "--1", "1.e5", "\"1\"", "null", "true", "[1]", "{}"}) {
    EXPECT_FALSE(HeaderScene(file_with(json_with("-1.5", text))).is_open()) << text;
    expect_same(json_with("-1.5", text));
  }
}

TEST(ReaderMetadata, CountsAreWholeNumbers) {
  for (const char* text : {"0", "1", "18446744073709551615", "18446744073709551616", "1.0", "1e3",
                           "-1", "-0", "00", "99999999999999999999999"})
    expect_same(json_with("\"voxels\":1", std::string("\"voxels\":") + text));
  for (const char* text : {"1", "2", "3", "20", "21", "3.0", "-3", "4294967299", "\"3\""})
    expect_same(json_with("\"levels\":3", std::string("\"levels\":") + text));
}

TEST(ReaderMetadata, SizesMustFitTheGrid) {
  for (const char* size :
       {"0.0", "-1", "1e308", "2.2e307", "2.3e307", "4e-324", "5e-309", "6e-309", "1e-320"})
    expect_same(json_with("\"voxel_size\":0.01", std::string("\"voxel_size\":") + size));
  expect_same(json_with("[-1.5,0.1,1000000.0]", "[1.7e308,1.7976931348623157e308,0]"));
  expect_same(json_with("[-1.5,0.1,1000000.0]", "[1,2]"));
  expect_same(json_with("[-1.5,0.1,1000000.0]", "[1,2,3,4]"));
  expect_same(json_with("[-1.5,0.1,1000000.0]", "[]"));
  expect_same(json_with("[-1.5,0.1,1000000.0]", "7"));
}

TEST(ReaderMetadata, TheUpAxisIsOptional) {
  for (const char* up : {"\"x\"", "\"y\"", "\"z\"", "\"w\"", "\"\"", "\"xy\"", "1", "null"})
    expect_same(json_with("\"source\"", std::string("\"up\":") + up + ",\"source\""));
  EXPECT_EQ(HeaderScene(file_with(example_json())).scene().info.up, '\0');
}

TEST(ReaderMetadata, OtherMembersAndSpacesAreSkipped) {
  expect_same(json_with("\"program\"", R"("later":[1,{"a":[]},"]}\\\"",null,-1.5e3],"program")"));
  expect_same(json_with("{\"grid\":{", " {\n\t\"grid\" : \r{ \"levels2\":5, \"evels\":7, "));
  expect_same(json_with("\"levels\":3", "\"levels\":9,\"levels\":3"));
  expect_same(json_with("\"levels\":3", "\"levels\":3,\"levels\":9"));
  expect_same(json_with("{\"grid\":", R"({"a":{"grid":{"levels":4}},"b":"grid","grid":)"));
  expect_same(json_with("\"bunny.ply\"", R"("\"grid\":{\"levels\":5}")"));
  expect_same(json_with("\"bunny.ply\"", "\"" + std::string(70000, 'x') + "\""));
}

TEST(ReaderMetadata, EveryTruncationIsSurvived) {
  const std::string json = example_json();
  for (std::size_t size = 0; size <= json.size(); ++size) expect_same(json.substr(0, size));
}

TEST(ReaderMetadata, IsHandedOutAsItIs) {
  const HeaderScene header(file_with(example_json()));
  const voxdag_info& info = header.scene().info;
  EXPECT_EQ(std::string(info.metadata, info.metadata_bytes), example_json());
}

}  // namespace
}  // namespace voxdag
