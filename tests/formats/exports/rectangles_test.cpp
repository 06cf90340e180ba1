#include "voxdag/formats/exports/faces/rectangles.hpp"

#include <gtest/gtest.h>

#include <map>

#include "colored_scene.hpp"

namespace voxdag {
namespace {

/// A face of a voxel: the voxel and the side.
using FaceKey = std::pair<VoxelKey, Face>;

Vec3i voxel_behind(Vec3i lo, Face face) {
  if ((static_cast<int>(face) & 1) != 0) --lo[face_axis(face)];
  return lo;
}

/// Returns the faces between voxels of the window and others, one by one.
template <class Scene>
std::map<FaceKey, Value8> faces_of(const Scene& scene, const Box3i& window) {
  std::map<FaceKey, Value8> faces;
  const auto has = [&](Vec3i v) {
    for (int axis = 0; axis < 3; ++axis)
      if (v[axis] < window.lo[axis] || v[axis] >= window.hi[axis]) return false;
    return scene.has(v.x, v.y, v.z);
  };
  for (const Vec3i v : scene.voxels)
    for (int i = 0; has(v) && i < 6; ++i) {
      const auto face = static_cast<Face>(i);
      if (has(v + face_normal(face))) continue;
      Value8 color{};
      if constexpr (std::is_same_v<Scene, ColoredScene>) color = scene.value(v);
      faces[{{v.x, v.y, v.z}, face}] = color;
    }
  return faces;
}

struct Cut {
  std::map<FaceKey, Value8> faces;
  std::size_t rectangles = 0;
};

/// Cuts the rectangles into faces. Each face must occur once.
Cut cut(const VoxelSet& voxels, const Box3i& window, LookReader* colors, bool merge) {
  Cut cut;
  for_each_rectangle(voxels, window, colors, merge, nullptr, [&](const FaceRectangle& r) {
    ++cut.rectangles;
    const int axis = face_axis(r.face), u = (axis + 1) % 3, v = (axis + 2) % 3;
    EXPECT_EQ(r.lo[axis], r.hi[axis]);
    for (Vec3i at = r.lo; at[u] < r.hi[u]; ++at[u])
      for (at[v] = r.lo[v]; at[v] < r.hi[v]; ++at[v]) {
        const Vec3i voxel = voxel_behind(at, r.face);
        EXPECT_TRUE(cut.faces.try_emplace({{voxel.x, voxel.y, voxel.z}, r.face}, r.color).second);
      }
  });
  return cut;
}

TEST(Rectangles, CoverTheOuterFacesOnce) {
  const ExportedScene scene(5, 3000);
  for (const Box3i& window : {whole_grid(5), Box3i{{3, 1, 6}, {29, 32, 13}}}) {
    const auto faces = faces_of(scene, window);
    const Cut merged = cut(scene.view(), window, nullptr, true);
    EXPECT_EQ(merged.faces, faces);
    EXPECT_LT(merged.rectangles, faces.size());
    const Cut single = cut(scene.view(), window, nullptr, false);
    EXPECT_EQ(single.faces, faces);
    EXPECT_EQ(single.rectangles, faces.size());
  }
}

TEST(Rectangles, HaveOneColor) {
  for (const int finest : {6, 3}) {
    const ColoredScene scene(finest);
    LookReader look(scene.options.look);
    const auto faces = faces_of(scene, whole_grid(6));
    EXPECT_EQ(cut(scene.view(), whole_grid(6), &look, true).faces, faces);
  }
}

TEST(Rectangles, AreAsLargeAsPossible) {
  // A slab with a hole: rows above, beside and below the hole.
  std::vector<Vec3i> voxels;
  for (int x = 2; x < 12; ++x)
    for (int y = 1; y < 9; ++y)
      if (x != 6 || y != 4) voxels.push_back({x, y, 7});
  const Svdag dag = brute_svdag(4, voxels);
  std::map<Face, std::size_t> counts;
  for_each_rectangle(dag.view(), whole_grid(4), nullptr, true, nullptr,
                     [&](const FaceRectangle& r) { ++counts[r.face]; });
  EXPECT_EQ(counts[Face::kPositiveZ], 4u);
  EXPECT_EQ(counts[Face::kNegativeZ], 4u);
  EXPECT_EQ(counts[Face::kPositiveX], 2u);  // the side, and that of the hole
}

TEST(Rectangles, CornersAreCounterClockwiseFromOutside) {
  for (int i = 0; i < 6; ++i) {
    const auto face = static_cast<Face>(i);
    FaceRectangle r;
    r.face = face;
    r.lo = {3, 4, 5};
    r.hi = {8, 11, 18};
    r.hi[face_axis(face)] = r.lo[face_axis(face)];
    const std::array<Vec3i, 4> c = corners_of(r);
    const Vec3d normal = cross(Vec3d(c[1] - c[0]), Vec3d(c[2] - c[0]));
    EXPECT_EQ(normalized(normal), Vec3d(face_normal(face)));
    EXPECT_EQ(c[0] + c[2], c[1] + c[3]);
    EXPECT_EQ(min(min(c[0], c[1]), min(c[2], c[3])), r.lo);
    EXPECT_EQ(max(max(c[0], c[1]), max(c[2], c[3])), r.hi);
  }
}

/// Without polls, the search for the bounds of a large scene could not be cancelled.
TEST(Rectangles, TheSearchForTheBoundsPolls) {
  Svdag dag;  // All voxels of 256³.
  dag.levels = 8;
  dag.leaf_blocks = {~std::uint64_t{0}};
  dag.level_begin.fill(9 * 6);
  for (std::uint32_t level = 0; level < 6; ++level) {
    dag.level_begin[level] = 9 * level;
    dag.nodes.push_back(0xFF);
    dag.nodes.insert(dag.nodes.end(), 8, level == 5 ? 0 : 9 * (level + 1));
  }
  int calls = 0;
  EXPECT_THROW(for_each_rectangle(
                   dag.view(), whole_grid(8), nullptr, true,
                   [&](double) {
                     if (++calls == 3) throw Cancelled();
                   },
                   [](const FaceRectangle&) { FAIL() << "a rectangle before the third poll"; }),
               Cancelled);
}

}  // namespace
}  // namespace voxdag
