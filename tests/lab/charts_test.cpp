#include "lab/report/charts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/temp_dir.hpp"

namespace voxdag::lab {
namespace {

Chart example(const std::string& file) {
  ChartPanel panel{"Sponza",
                   {"resolution", AxisScale::kLog2},
                   {"time (s)", AxisScale::kLog10},
                   {{"ours", {512, 1024, 2048}, {0.1, NAN, 1.2}, 0, LineStyle::kSolid, true},
                    {"published", {512, 2048}, {0.2, 2.4}, 1, LineStyle::kDashed, false}}};
  return {file, {panel, panel}};
}

TEST(Charts, AreDrawnTheSameEachTime) {
  const TempDir dir;
  Progress progress;
  if (!draw_charts({example("a.svg"), example("b.svg")}, dir.path(), progress))
    GTEST_SKIP() << "matplotlib is not installed";
  const std::string svg = read_text(dir / "a.svg");
  EXPECT_NE(svg.find("<svg"), std::string::npos);
  EXPECT_EQ(svg, read_text(dir / "b.svg"));
}

TEST(Charts, AFolderThatCannotBeWrittenIsAnError) {
  Progress progress;
  const TempDir dir;
  if (!draw_charts({}, dir.path(), progress)) GTEST_SKIP() << "matplotlib is not installed";
  EXPECT_THROW(draw_charts({example("a.svg")}, dir / "none", progress), Error);
}

}  // namespace
}  // namespace voxdag::lab
