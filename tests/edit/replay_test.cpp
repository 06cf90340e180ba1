#include "voxdag/edit/replay.hpp"

#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

TEST(Replay, OnlyEditsOfALineCount) {
  const auto ball =
      parse_replay_line("EditSphere,14483.000000,33332.000000,24591.000000,3.5,true\r");
  ASSERT_TRUE(ball);
  EXPECT_EQ(ball->radius_voxels, 3.5);
  EXPECT_TRUE(ball->adds);
  EXPECT_FALSE(parse_replay_line("EditSphere,1,2,3,4,false")->adds);
  for (const char* line : {"", "EndFrame", "SetLocation,1,2,3", "SetRotation,1,0,0,0,1,0,0,0,1",
                           "SetToolParameters,1,2,3,0,0,0,0,0,0,2300.000000,0"})
    EXPECT_FALSE(parse_replay_line(line)) << line;
  for (const char* line :
       {"EditCopy,1,2,3", "EditSphere", "EditSphere,1,2,3,4", "EditSphere,1,2,3,4,yes",
        "EditSphere,1,2,3,-4,true", "EditSphere,1,2,3,1e9,true", "EditSphere,1,2,3,x,true"})
    EXPECT_THROW(parse_replay_line(line), Error) << line;
}

TEST(Replay, BallsLieOnVoxelsAndAreTheSameEachTime) {
  const Svdag scene = brute_svdag(6, random_voxels(6, 500, 3));
  ReplayPlaces places(scene.view()), again(scene.view());
  Vec3l before{};
  for (int i = 0; i < 50; ++i) {
    const BallShape ball = places.place({2.5, true}, scene.view());
    const BallShape same = again.place({2.5, true}, scene.view());
    EXPECT_EQ(ball.center, same.center);
    EXPECT_NE(ball.center, before);
    before = ball.center;
    EXPECT_EQ(ball.radius, 640);
    Vec3i voxel;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(ball.center[axis] % 256, 128);
      voxel[axis] = static_cast<std::int32_t>(ball.center[axis] / 256);
    }
    EXPECT_TRUE(svdag_contains(scene.view(), voxel, 6));
  }
}

TEST(Replay, AnEmptySceneHasPlacesToo) {
  const Svdag none = brute_svdag(4, {});
  ReplayPlaces places(none.view());
  EXPECT_EQ(places.place({1, false}, none.view()).radius, 256);
}

}  // namespace
}  // namespace voxdag
