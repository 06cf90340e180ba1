#include "voxdag/formats/scenes/builder.hpp"

#include <gtest/gtest.h>

#include "mesh_facts.hpp"
#include "voxdag/formats/scenes/random.hpp"

namespace voxdag::scenes {
namespace {

TEST(SceneMath, SineAgreesWithTheLibrary) {
  for (int i = -4000; i <= 4000; ++i) {
    const double t = i / 1000.0;
    // The tolerance covers a few roundings of a value of at most 1, and the error of 2 pi t in the
    // library's argument.
    EXPECT_NEAR(sin_turns(t), std::sin(6.283185307179586 * t), 1e-14);
    EXPECT_NEAR(cos_turns(t), std::cos(6.283185307179586 * t), 1e-14);
  }
}

TEST(SceneMath, RandomNumbersAreThoseOfPcg32) {
  // The first outputs of the reference implementation's demo: seed 42, stream 54.
  Random random(42, 54);
  for (const std::uint32_t expected : {0xa15c02b7u, 0x7b47f409u, 0xba1d3330u, 0x83d2f293u})
    EXPECT_EQ(random.next(), expected);
}

TEST(SceneBuilder, ABoxIsClosedAndHasItsVolume) {
  Builder b;
  b.material("m");
  b.box({1, 2, 3}, {2, 4, 6});
  const Mesh mesh = b.take();
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 6.0);
}

TEST(SceneBuilder, ASquareBlockKeepsItsWidthInATurnedFrame) {
  Builder b;
  b.material("m");
  b.frame(placed({5, 0, 0}, 0.1, 2.0));
  b.square({{0, 0}, {0.5, 0}, {0.5, 3}, {0, 3}});
  EXPECT_NEAR(signed_volume(b.take()), 3.0 * 8, 1e-5);  // float vertices
}

TEST(SceneBuilder, ALatheTubeTorusAndBallHaveOutwardNormals) {
  Builder lathe, tube, torus, ball;
  lathe.lathe({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 256);
  tube.tube({{0, 0, 0}, {0, 0, 1}, {0, 1, 2}, {0, 1, 3}}, {0, 0.5, 0.5, 0}, 8);
  torus.torus(2, 0.5, 256, 256);
  ball.ball(64, [](Vec3d) { return 1.0; });
  // A polygon of 256 sides has 0.9999 of the circle's area; a grid of 64² a side is as close.
  EXPECT_NEAR(signed_volume(lathe.take()), 3.14159, 0.001);
  EXPECT_GT(signed_volume(tube.take()), 0);
  EXPECT_NEAR(signed_volume(torus.take()), 9.8696, 0.005);
  EXPECT_NEAR(signed_volume(ball.take()), 4.18879, 0.005);
}

}  // namespace
}  // namespace voxdag::scenes
