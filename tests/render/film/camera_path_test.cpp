#include "voxdag/render/film/camera_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

CameraKey key(double time, Vec3d eye, Vec3d target = {0, 0, 0}, double fov = 50) {
  return {time, {eye, target, {0, 1, 0}, fov}};
}

/// Returns keys at uneven times and distances; the target rests between two of them.
std::vector<CameraKey> walk() {
  return {key(0, {0, 0, 9}), key(1, {1, 0, 8}, {0, 0, 0}, 50), key(1.5, {6, 1, 3}, {0, 0, 0}, 70),
          key(4, {6, 1, 2.9}, {2, 0, 0}, 70), key(9, {-5, 2, -7}, {2, 1, 0}, 40)};
}

TEST(CameraPath, PassesThroughItsKeys) {
  const CameraPath path(walk());
  for (const CameraKey& k : walk()) {
    const View view = path.at(k.time);
    EXPECT_LT(length(view.eye - k.view.eye), 1e-9);
    EXPECT_LT(length(view.target - k.view.target), 1e-9);
    EXPECT_NEAR(view.vertical_fov_degrees, k.view.vertical_fov_degrees, 1e-9);
  }
}

TEST(CameraPath, StandsStillOutsideOfItsTimes) {
  const CameraPath path(walk());
  EXPECT_EQ(path.at(-1).eye, walk().front().view.eye);
  EXPECT_EQ(path.at(10).eye, walk().back().view.eye);
}

TEST(CameraPath, GoesStraightAndEvenlyThroughKeysOnALine) {
  const CameraPath path(
      {key(0, {0, 0, 1}), key(1, {1, 0, 1}), key(2, {2, 0, 1}), key(3, {3, 0, 1})});
  for (double time = 0; time <= 3; time += 0.05)
    EXPECT_LT(length(path.at(time).eye - Vec3d{time, 0, 1}), 1e-12) << time;
}

TEST(CameraPath, NeitherJumpsNorChangesItsSpeedAtOnce) {
  const CameraPath path(walk());
  constexpr double kStep = 1e-5;
  for (const CameraKey& k : walk()) {
    if (k.time == path.start() || k.time == path.end()) continue;
    const auto velocity = [&](double time) {
      return (path.at(time + kStep / 2).eye - path.at(time - kStep / 2).eye) * (1 / kStep);
    };
    const Vec3d before = velocity(k.time - kStep), after = velocity(k.time + kStep);
    EXPECT_LT(length(after - before), 0.01) << k.time;
  }
}

TEST(CameraPath, AngleAndUpDoNotOvershoot) {
  const CameraPath path(walk());
  for (double time = 0; time <= 9; time += 0.01) {
    const View view = path.at(time);
    EXPECT_GE(view.vertical_fov_degrees, 40 - 1e-9);
    EXPECT_LE(view.vertical_fov_degrees, 70 + 1e-9);
    EXPECT_EQ(view.up, (Vec3d{0, 1, 0}));
  }
}

TEST(CameraPath, StandsStillBetweenEqualKeys) {
  const CameraPath path(
      {key(0, {0, 0, 9}), key(1, {3, 0, 9}), key(2, {3, 0, 9}), key(3, {3, 5, 9})});
  for (double time = 1; time <= 2; time += 0.1)
    EXPECT_LT(length(path.at(time).eye - Vec3d{3, 0, 9}), 1e-6) << time;
}

TEST(CameraPath, OneKeyIsAStill) {
  const CameraPath path({key(2, {0, 0, 9})});
  EXPECT_EQ(path.start(), path.end());
  EXPECT_EQ(path.at(5).eye, (Vec3d{0, 0, 9}));
}

TEST(CameraPath, RefusesKeysThatMakeNoPath) {
  const auto refuses = [](std::vector<CameraKey> keys, const char* reason) {
    try {
      CameraPath path(std::move(keys));
      ADD_FAILURE() << "accepted: " << reason;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  refuses({}, "at least one");
  refuses({key(1, {0, 0, 9}), key(1, {0, 1, 9})}, "key 1: its time");
  refuses({key(1, {0, 0, 9}), key(2, {0, NAN, 9})}, "key 1");
  refuses({key(1, {0, 0, 0})}, "same point");
  refuses({key(1, {0, 0, 9}, {}, 180)}, "fov");
}

}  // namespace
}  // namespace voxdag
