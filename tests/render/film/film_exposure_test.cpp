#include "voxdag/render/film/film_exposure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "voxdag/core/error.hpp"
#include "voxdag/render/film/film.hpp"

namespace voxdag {
namespace {

std::vector<double> frames(int count, double per_second) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) times.push_back(i / per_second);
  return times;
}

/// Returns the weighted mean, computed over all frames.
std::vector<float> over_all(const std::vector<double>& times, const std::vector<double>& logs) {
  std::vector<float> smooth;
  for (const double time : times) {
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double w = std::exp(-2 * (times[i] - time) * (times[i] - time));
      sum += w * logs[i];
      weight += w;
    }
    smooth.push_back(static_cast<float>(std::exp(sum / weight)));
  }
  return smooth;
}

TEST(FilmExposure, IsTheWeightedMeanOverAllFrames) {
  const std::vector<double> times = frames(600, 30);
  std::vector<double> logs;
  for (std::size_t i = 0; i < times.size(); ++i)
    logs.push_back(i < 250 ? -3.0 : std::sin(static_cast<double>(i) * 0.1));
  EXPECT_EQ(smoothed_exposures(times, logs), over_all(times, logs));
}

TEST(FilmExposure, OfAMillionFramesTakesSeconds) {
  const std::vector<double> times = frames(1'000'000, 30);
  const std::vector<float> smooth = smoothed_exposures(times, std::vector<double>(times.size(), 0));
  EXPECT_EQ(smooth.front(), 1);
  EXPECT_EQ(smooth.back(), 1);
}

TEST(Film, FramesRunFromTheFirstKeyToTheLastOne) {
  const CameraPath path({{1, {}}, {2, {}}});
  const std::vector<double> times = frame_times(path, 4);
  EXPECT_EQ(times, (std::vector<double>{1, 1.25, 1.5, 1.75, 2}));
}

TEST(Film, MoreThanAMillionFramesAreRefusedWithTheirNumber) {
  const CameraPath path({{0, {}}, {2000, {}}});
  try {
    frame_times(path, 1000);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "the film would have 2000001 frames; at most 1000000 are allowed");
  }
}

}  // namespace
}  // namespace voxdag
