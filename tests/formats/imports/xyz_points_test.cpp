// Texts of points: cells, names of columns, colours and what is refused.
#include "point_checks.hpp"

namespace voxdag {
namespace {

class XyzPointsTest : public testing::Test {
 protected:
  struct Cloud {
    std::vector<Vec3d> places;
    std::vector<Rgb8> colors;
    std::vector<std::string> warnings;
  };

  Cloud read(const std::string& name, const std::string& text,
             const VoxelSourceOptions& options = {}) const {
    write_text(dir_ / name, text);
    const auto source = open_voxel_source(dir_ / name, options);
    Cloud cloud{{}, {}, source->warnings()};
    source->visit_all([&](const VoxelBatch& batch) {
      cloud.places.insert(cloud.places.end(), batch.places.begin(), batch.places.end());
      cloud.colors.insert(cloud.colors.end(), batch.colors.begin(), batch.colors.end());
    });
    return cloud;
  }
  /// Expects the points (10, 20, 30) and (11, 21, 31), without warnings.
  void expect_two(const std::string& text) const {
    const Cloud cloud = read("p.csv", text);
    EXPECT_EQ(cloud.places, (std::vector<Vec3d>{{10, 20, 30}, {11, 21, 31}})) << text;
    EXPECT_EQ(cloud.warnings, std::vector<std::string>()) << text;
  }
  /// Expects the colours (255, 128, 0) and (7, 8, 9).
  void expect_colors(const std::string& name, const std::string& text,
                     const std::string& warning = {},
                     const VoxelSourceOptions& options = {}) const {
    const Cloud cloud = read(name, text, options);
    EXPECT_EQ(cloud.colors, (std::vector<Rgb8>{{255, 128, 0}, {7, 8, 9}})) << text;
    EXPECT_EQ(cloud.warnings, warning.empty() ? std::vector<std::string>() : std::vector{warning})
        << text;
  }
  void expect_error(const std::string& text, const std::string& reason) const {
    EXPECT_EQ(error_of([&] { read("p.csv", text); }), (dir_ / "p.csv").string() + ": " + reason)
        << text;
  }

  TempDir dir_;
};

TEST_F(XyzPointsTest, CellsMayHoldBlanksWhereOtherCharactersSeparate) {
  expect_two("point id,x,y,z,intensity\n1,10,20,30,7\n2,11,21,31,9\n");
  expect_two("\"point id\",\"x\",\"y\",\"z\",\"gps time\"\n1,10,20,30,7\n2,11,21,31,9\n");
  expect_two("Punkt Nr;x;y;z;Datum Zeit\n1;10;20;30;5\n2;11;21;31;5\n");
  expect_two("point id\tx\ty\tz\n1\t10\t20\t30\n2\t11\t21\t31\r\n");
  expect_two("#time,x,y,z\n2024-01-05 10:00,10,20,30\n2024-01-05 10:01,11,21,31\n");
  expect_two("x,y,z,name\n10,20,30,tree 1\n11,21,31,\"a, b\"\n");
  expect_two("10,20,30,tree 1\n11,21,31,\"a, b \"\"c\"\"\"\n");
  expect_two("id,name,x,y,z\n1,\"p, 1\",10,20,30\n2,\"# 2\",11,21,31 # two\n");
  expect_two("id x y z\ntree 1,10,20,30\ntree 2,11,21,31\n");
  expect_two("10|20|30\n11 | 21 | 31|\n");
  expect_two("\"point id\" \"x\" \"y\" \"z\" \"i\"\n\"tree 1\" 10 20 30 7\n2 11 21 31 7\n");
}

TEST_F(XyzPointsTest, SeparatorsMayHaveBlanksOrBeMixed) {
  expect_two("x, y, z\n10, 20, 30\n11 ,21 , 31\n");
  expect_two("10, 20 30\n11 21; 31\n");
  expect_two("10,\t20,\t30\n11,\t21,\t31\n");
  expect_two("10\t\t20\t\t30\n11\t\t21\t\t31\n");
  expect_two("\t10\t20\t30\t\n\t11\t21\t31\t\n");
  expect_two("x,y,z\n10 20 30\n11;21;31\n");
  expect_two("\"10,20,30\"\n\"11\",\"21\",\"31\"\n");
  expect_two("x y z\n10,20,30,1\n11,21,31,1\n");
}

TEST_F(XyzPointsTest, EmptyCellsOfTabsKeepTheirColumns) {
  expect_two("id\tnote\tx\ty\tz\tq\n1\ta\t10\t20\t30\t7\n2\t\t11\t21\t31\t9\n");
  expect_two("\tx\ty\tz\n0\t10\t20\t30\n1\t11\t21\t31\n");
  const Cloud cloud = read("p.txt", "10\t20\t30\n1\t\t3\n");
  ASSERT_EQ(cloud.places.size(), 2u);
  EXPECT_TRUE(std::isnan(cloud.places[1].y));
  expect_colors("p.txt", "x\ty\tz\ti\tr\tg\tb\n1\t2\t3\t\t255\t128\t0\n1\t2\t3\t5\t7\t8\t9\n");
}

TEST_F(XyzPointsTest, NamesMayHaveUnitsAndOtherWords) {
  expect_two("id,x [m],y [m],z [m]\n1,10,20,30\n2,11,21,31\n");
  expect_two("x [m] y [m] z [m] i\n10 20 30 1\n11 21 31 1\n");
  expect_two("z(m);Y Coord.;Coord. X\n30;20;10\n31;21;11\n");
  expect_two("id,X_coordinate,coord-y,Coordinate Z\n1,10,20,30\n2,11,21,31\n");
  for (const char* names :
       {"Red (8-bit),Green (8-bit),Blue (8-bit)", "diffuse_red,diffuse_green,diffuse_blue",
        "color_r,color_g,color_b", "R_,G_,B_", "Colour Red,Colour Green,Colour Blue"})
    expect_colors("p.csv",
                  std::string("x,y,z,i,") + names + "\n1,2,3,4,255,128,0\n1,2,3,4,7,8,9\n");
  expect_colors("p.csv", "E,N,H,i,r,g,b\n1,2,3,9,255,128,0\n1,2,3,9,7,8,9\n",
                "its columns 'E', 'N' and 'H' are taken for x, y and z");
  for (const char* name : {"rgb", "red", "hex color"})
    EXPECT_EQ(read("p.csv", std::string("x,y,z,") + name + "\n1,2,3,4\n").warnings,
              std::vector{"its column '" + std::string(name) +
                          "' is left out: colours are three columns, red, green and blue"});
}

TEST_F(XyzPointsTest, EndingsTellTheColumnsOfColours) {
  const std::string with_intensity = "2\n1 2 3 40 255 128 0\n1 2 3 41 7 8 9\n";
  expect_colors("p.pts", with_intensity);
  expect_colors("p.pts", "1 2 3 255 128 0\n1 2 3 7 8 9\n");
  expect_colors("p.pts", "1 2 3 255 128 0 0.5\n1 2 3 7 8 9 0.5\n");
  EXPECT_EQ(read("p.pts", "1 2 3 40 0 1 0\n").colors, std::vector<Rgb8>({{0, 1, 0}}));
  const std::string guess =
      "its columns 4 to 6 are taken for the colour, which columns 5 to 7 could be, too: they "
      "have no names";
  const std::string rows = "1 2 3 255 128 0 4\n1 2 3 7 8 9 5\n";
  expect_colors("p.xyz", rows, guess);
  expect_colors("p.xyz", "1 2 3 255 128 0 255\n1 2 3 7 8 9 255\n");
  expect_colors("p.xyz", "1 2 3 255 128 0 0 1 0\n1 2 3 7 8 9 0 0 1\n");
  expect_colors("p.xyz", rows, {}, {.labels = "7"});
  expect_colors("p.xyz", with_intensity, {}, {.channels = {{"4", {}}}});
  expect_colors("p.xyzrgb", "1 2 3 1.0 0.501961 0.0\n1 2 3 0.027451 0.031373 0.035294\n");
  expect_colors("p.xyzrgb", "1 2 3 255 128 0\n1 2 3 7 8 9\n");
}

TEST_F(XyzPointsTest, MissingNumbersAreNotFinite) {
  const Cloud cloud = read("p.csv", "NA,NA,NA\nnull,1,1\n1,None,1\n1,1,N/A\n1,2,3\n");
  ASSERT_EQ(cloud.places.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(is_finite(cloud.places[i]), i == 4) << i;
}

TEST_F(XyzPointsTest, LinesOfOtherProgramsAreNoPoints) {
  expect_two("sep=;\nx;y;z\n10;20;30\n11;21;31\n");
  expect_two("% x y z\n% 1 2 3\n10 20 30\n11 21 31\n");
  for (const std::string& end : {std::string(3, '\0'), std::string("\x1A\x1A\x1A")}) {
    const Cloud cloud = read("p.xyz", "10 20 30\n11 21 31\n" + end);
    EXPECT_EQ(cloud.places.size(), 2u);
    EXPECT_EQ(cloud.warnings,
              std::vector<std::string>{"bytes after the text, 0 or Ctrl-Z, are left out: 3"});
  }
}

TEST_F(XyzPointsTest, CommasInsideNumbersAreRefusedAtOnce) {
  const std::string reason =
      "has commas inside numbers and other separators between them: write decimal points";
  for (const char* row : {"0,5\t0,5\t0,5\t7\t8\t9", "0,5 0,5 0,5", "0,5;0,5;0,5",
                          "\"0,5\",\"0,5\",\"0,5\"", "\"0,5\" \"0,5\" \"0,5\"", "1;2;3,5"}) {
    expect_error(row, "line 1: " + reason);
    expect_error(std::string("x;y;z\n") + row, "line 2: " + reason);
  }
  expect_error("x,y,z\n\"0,5\",\"0,5\",\"0,5\"\n", "line 2: " + reason);
  expect_error("1\t2\t3\n1,5\t2\t3\n", "line 2: " + reason);
}

TEST_F(XyzPointsTest, BadCellsAreRefused) {
  expect_error("x,y,z\n1 0,2,3\n", "line 2: number 1, '1 0', is not a number");
  expect_error("x,y,z\n1,\"2\" m,3\n", "line 2: number 2, '\"2\" m', is not a number");
  expect_error("tree 1,2,3,4\n", "line 1: number 1, 'tree 1', is not a number");
  // Errors of the first points come before warnings.
  write_text(dir_ / "p.csv", "E,N,H\n1,2,3\n1,2,x\n");
  EXPECT_TRUE(error_of([&] { open_voxel_source(dir_ / "p.csv"); }).ends_with("is not a number"));
  expect_error("point id x y z i\n1 10 20 30 7\n",
               "line 2: has 5 numbers, but 6 columns have names");
}

TEST_F(XyzPointsTest, DamagedTextsAreRefusedOrSafe) {
  std::mt19937 rng(7);
  const std::string files[] = {"sep=;\nx [m];y;z;r;g;b\n1;\"2\";3;4;5;6\n;2;NA;1;2;3 # end\n",
                               "\"point id\",\"x\",\"y\",\"z\"\n1,2,\"3\",4\n2,,\"a, b\",1\n",
                               "2\n1.5 2.5 3.5 40 255 0 0\n2.5\t2.5 3.5 41 0 0 255\n"};
  const std::string bytes("\"\",;\t|# \n\r%/\0\x1A", 14);
  for (const std::string& good : files)
    for (int i = 0; i < 200; ++i) {
      std::string bad = good.substr(0, good.size() - rng() % 3);
      for (unsigned k = rng() % 4 + 1; k > 0; --k)
        bad[rng() % bad.size()] =
            rng() % 4 ? bytes[rng() % bytes.size()] : static_cast<char>(rng());
      EXPECT_EQ(error_of([&] { read("p.csv", bad); }).find('\n'), std::string::npos) << bad;
    }
}

}  // namespace
}  // namespace voxdag
