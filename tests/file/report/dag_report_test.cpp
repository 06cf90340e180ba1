#include "voxdag/file/report/dag_report.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

TEST(DagReport, TheNameOfTheMeshIsPrintedWithoutControlCharacters) {
  SceneMetadata metadata;
  metadata.source = {"a\x1b[31m\n.obj", 4, 2};
  const std::string text = placement_table(metadata);
  EXPECT_NE(text.find("a?[31m?.obj, 2 triangles"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

TEST(DagReport, ALongNameIsCut) {
  SceneMetadata metadata;
  metadata.source = {std::string(100'000, 'x'), 4, 2};
  const std::string text = placement_table(metadata);
  EXPECT_LT(text.size(), 600u);
}

TEST(DagReport, SaysWhichWayIsUpTheUnitAndTheHome) {
  SceneMetadata metadata;
  EXPECT_EQ(placement_table(metadata).find("  up "), std::string::npos);
  metadata.presentation.up = 'z';
  metadata.presentation.unit = "mm";
  metadata.presentation.home = HomeView{{{1, -2.5, 3}, {}, {0, 0, 1}, 35}, {}};
  EXPECT_NE(placement_table(metadata).find("  up            z, in mm, home at (1, -2.5, 3)\n"),
            std::string::npos)
      << placement_table(metadata);
}

}  // namespace
}  // namespace voxdag
