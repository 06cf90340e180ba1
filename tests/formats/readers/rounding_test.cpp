/// Tests that float32 values are correctly rounded in every text format.
#include <cstdlib>
#include <random>
#include <span>

#include "formats/readers/mesh_text.hpp"
#include "voxdag/formats/readers/obj/obj_reader.hpp"
#include "voxdag/formats/readers/ply/ply_reader.hpp"
#include "voxdag/formats/readers/stl/stl_reader.hpp"

namespace voxdag {
namespace {

/// Returns decimal numbers near the middle between two floats, and others that are hard to round.
std::vector<std::string> hard_numbers() {
  std::vector<std::string> numbers = {"0",
                                      "-0",
                                      "+1",
                                      ".5",
                                      "5.",
                                      "-.5e1",
                                      "1e-45",
                                      "7.006492321624085e-46",
                                      "7.006492321624086e-46",
                                      "1.17549428e-38",
                                      "3.4028234663852886e38",
                                      "3.4028235677973366e38",
                                      "16777217",
                                      "16777219",
                                      "0.1",
                                      "1.00000005960464477539062500",
                                      "1.00000005960464477539062501",
                                      "1.000000178813934326171875",
                                      "9007199254740993e-9",
                                      "0.000000000000000000000000000000000000011754942106924411"};
  numbers.push_back("1.000000059604644775390625" + std::string(800, '0') + "1");
  std::mt19937 random(1);
  char text[64];
  for (int i = 0; i < 3000; ++i) {
    const float value = std::bit_cast<float>(static_cast<std::uint32_t>(random() % 0x7F000000));
    const double middle =
        (static_cast<double>(value) +
         static_cast<double>(std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) + 1))) /
        2;
    for (const int digits : {6, 9, 17, 40, 160}) {
      char longer[256];
      std::snprintf(longer, sizeof(longer), "%.*e", digits, middle);
      numbers.emplace_back(longer);
    }
    std::snprintf(text, sizeof(text), "%.9g", static_cast<double>(-value));
    numbers.emplace_back(text);
  }
  return numbers;
}

void expect_rounded(const std::vector<std::string>& numbers, std::span<const Vec3f> vertices) {
  ASSERT_EQ(vertices.size(), numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint32_t>(vertices[i].x),
              std::bit_cast<std::uint32_t>(std::strtof(numbers[i].c_str(), nullptr)))
        << numbers[i];
}

TEST(Rounding, ObjCoordinatesAreTheNearestFloats) {
  const auto numbers = hard_numbers();
  std::string text;
  for (const auto& number : numbers) text.append("v ").append(number).append(" 0 0\n");
  expect_rounded(numbers, read_text(read_obj, text + "f 1 2 3\n").vertices);
}

TEST(Rounding, AsciiPlyCoordinatesAreTheNearestFloats) {
  const auto numbers = hard_numbers();
  for (const std::string type : {"float", "double"}) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex ";
    text += std::to_string(numbers.size()) + "\nproperty " + type +
            " x\nproperty float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n";
    for (const auto& number : numbers) text.append(number).append(" 0 0\n");
    expect_rounded(numbers, read_text(read_ply, text + "3 0 1 2\n").vertices);
  }
}

TEST(Rounding, AsciiStlCoordinatesAreTheNearestFloats) {
  for (const auto& number : hard_numbers()) {
    const std::string vertex = "vertex " + number + " 0 0 ";
    const Mesh mesh = read_text(read_stl, "solid\nfacet normal 0 0 1 outer loop " + vertex +
                                              vertex + vertex + "endloop endfacet endsolid");
    ASSERT_EQ(std::bit_cast<std::uint32_t>(mesh.vertices[0].x),
              std::bit_cast<std::uint32_t>(std::strtof(number.c_str(), nullptr)));
  }
}

}  // namespace
}  // namespace voxdag
