#include "voxdag/formats/imports/moved_source.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/error_of.hpp"
#include "voxdag/formats/imports/import_voxels.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

class ListedPlaces : public VoxelSource {
 public:
  ListedPlaces(std::vector<Vec3d> places, bool has_points, std::optional<Grid> grid = {},
               std::vector<Rgb8> colors = {})
      : places_(std::move(places)),
        has_points_(has_points),
        grid_(grid),
        colors_(std::move(colors)) {}

  bool has_points() const override { return has_points_; }
  bool has_colors() const override { return !colors_.empty(); }
  bool has_place() const override { return grid_.has_value(); }
  std::optional<Grid> grid() const override { return grid_; }
  void visit_all(const VisitBatch& visit) const override { visit({places_, colors_}); }

 private:
  std::vector<Vec3d> places_;
  bool has_points_;
  std::optional<Grid> grid_;
  std::vector<Rgb8> colors_;
};

InputTransform transform(const std::string& up, double scale = 1, Vec3d translate = {},
                         const std::string& rotate = "") {
  return InputTransform({up, "", scale, rotate, translate}, {});
}

std::vector<Vec3d> places_of(const VoxelSource& source) {
  std::vector<Vec3d> places;
  source.visit_all([&](const VoxelBatch& batch) {
    places.insert(places.end(), batch.places.begin(), batch.places.end());
  });
  return places;
}

TEST(MovedSource, PointsMoveInDoublePrecision) {
  const auto source =
      moved_source(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{1, 2, 3}}, true),
                   transform("y:z", 2, {4'649'776.123, 0, 0}));
  EXPECT_EQ(places_of(*source), (std::vector<Vec3d>{{4'649'778.123, -6, 4}}));
}

TEST(MovedSource, VoxelsOfAGridTurnAroundTheOriginOfTheWorld) {
  Grid grid;
  grid.levels = 3;
  grid.origin = {10, 20, 30};
  grid.voxel_size = 0.5;
  const auto source =
      moved_source(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{1, 2, 3}}, false, grid),
                   transform("y:z", 3, {1, 0, 0}));
  const Grid moved = source->grid().value();
  EXPECT_EQ(moved.voxel_size, 1.5);
  const Vec3d voxel = places_of(*source).at(0);
  // The centre of the voxel goes where its point goes.
  const Vec3d centre = moved.to_world(voxel + Vec3d{0.5, 0.5, 0.5}),
              expected = transform("y:z", 3, {1, 0, 0}).point(grid.to_world({1.5, 2.5, 3.5}));
  EXPECT_EQ(centre, expected);
}

TEST(MovedSource, VoxelsWithoutAPlaceTurnInTheirBox) {
  const auto source =
      moved_source(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{0, 0, 0}, {1, 2, 5}}, false),
                   transform("y:z"));
  EXPECT_EQ(places_of(*source), (std::vector<Vec3d>{{0, 5, 0}, {1, 0, 2}}));
}

TEST(MovedSource, VoxelsRefuseWhatTheyCannotDo) {
  const auto refusal = [](const InputTransform& by) {
    return error_of([&] {
      moved_source(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{0, 0, 0}}, false), by);
    });
  };
  EXPECT_NE(refusal(transform("", 1, {}, "x:45")).find("quarters"), std::string::npos);
  EXPECT_NE(refusal(transform("", 2)).find("--voxel-size"), std::string::npos);
}

TEST(JoinedSource, CloudsAreOneAndThoseWithoutColoursGrey) {
  std::vector<std::unique_ptr<VoxelSource>> sources;
  sources.push_back(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{0, 0, 0}}, true,
                                                   std::nullopt, std::vector<Rgb8>{{1, 2, 3}}));
  sources.push_back(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{5, 0, 0}}, true));
  const auto joined = joined_source(std::move(sources));
  std::vector<Rgb8> colors;
  joined->visit_all([&](const VoxelBatch& batch) {
    colors.insert(colors.end(), batch.colors.begin(), batch.colors.end());
  });
  EXPECT_EQ(colors, (std::vector<Rgb8>{{1, 2, 3}, {204, 204, 204}}));
  EXPECT_EQ(places_of(*joined).size(), 2u);
}

TEST(JoinedSource, GridsThatCoincideBecomeOne) {
  Grid a, b;
  a.levels = b.levels = 2;
  b.origin = {-3, 0, 2};
  std::vector<std::unique_ptr<VoxelSource>> sources;
  sources.push_back(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{1, 1, 1}}, false, a));
  sources.push_back(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{0, 0, 0}}, false, b));
  const auto joined = joined_source(std::move(sources));
  EXPECT_EQ(joined->grid()->origin, (Vec3d{-3, 0, 0}));
  EXPECT_EQ(places_of(*joined), (std::vector<Vec3d>{{4, 1, 1}, {0, 0, 2}}));
  std::vector<std::unique_ptr<VoxelSource>> mixed;
  mixed.push_back(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{1, 1, 1}}, false, a));
  mixed.push_back(std::make_unique<ListedPlaces>(std::vector<Vec3d>{{0, 0, 0}}, false));
  EXPECT_NE(error_of([&] { joined_source(std::move(mixed)); }), "");
}

TEST(ImportPoints, AnyResolutionAndEachPlacementOfTheGrid) {
  const ListedPlaces points({{10.3, 20.7, 5.2}, {11.9, 20.1, 5.9}}, true);
  ImportOptions options;
  options.resolution = 10;
  EXPECT_EQ(import_voxels(points, options).grid.levels, 4);
  options = {};
  options.voxel_size = 0.1;
  options.snap = true;
  const ImportResult snapped = import_voxels(points, options);
  EXPECT_EQ(snapped.grid.origin, (Vec3d{103 * 0.1, 201 * 0.1, 52 * 0.1}));
  EXPECT_TRUE(svdag_contains(snapped.dag.view(), {16, 0, 7}, snapped.grid.levels));
  EXPECT_TRUE(svdag_contains(snapped.dag.view(), {0, 6, 0}, snapped.grid.levels));
  options.snap = false;
  options.padding = 2;
  const ImportResult padded = import_voxels(points, options);
  EXPECT_TRUE(svdag_contains(padded.dag.view(), {18, 2, 9}, padded.grid.levels));
}

}  // namespace
}  // namespace voxdag
