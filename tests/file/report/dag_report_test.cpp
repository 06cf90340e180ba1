#include "voxdag/file/report/dag_report.hpp"

#include <gtest/gtest.h>

namespace voxdag {
namespace {

TEST(DagReport, TheNameOfTheMeshIsPrintedWithoutControlCharacters) {
  VdagSource source{"a\x1b[31m\n.obj", 4, 2};
  const std::string text = placement_table(Grid{}, source);
  EXPECT_NE(text.find("a?[31m?.obj, 2 triangles"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
}

TEST(DagReport, ALongNameIsCut) {
  const std::string text = placement_table(Grid{}, {std::string(100'000, 'x'), 4, 2});
  EXPECT_LT(text.size(), 600u);
}

}  // namespace
}  // namespace voxdag
