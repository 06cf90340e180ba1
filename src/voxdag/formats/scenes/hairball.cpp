#include <cmath>

#include "voxdag/formats/scenes/builder.hpp"
#include "voxdag/formats/scenes/list.hpp"
#include "voxdag/formats/scenes/random.hpp"

/// A ball of 1 m radius made of thin, curled, tangled hairs, each a closed tube with pointed ends,
/// after the test scene of Laine and Karras, "Two Methods for Fast Ray-Cast Ambient Occlusion",
/// 2010.
namespace voxdag::scenes {
namespace {

constexpr int kSides = 6, kRings = 120;  // 2 * 6 * 120 = 1440 triangles a hair.
// Gives 769 million octree nodes at 8192³, about as many as the SVDAG paper's hairball (781
// million).
constexpr double kRadius = 0.0036;

/// Returns a path from near the centre to near the surface, bent by two slow waves.
std::vector<Vec3d> hair_path(Random& random) {
  Vec3d direction = random.direction();
  const Vec3d axes[2] = {random.direction(), random.direction()};
  double rates[2], phases[2];
  for (int k = 0; k < 2; ++k) {
    rates[k] = random.uniform(0.5, 2.5);
    phases[k] = random.uniform();
  }
  const double inner = random.uniform(0.05, 0.3), outer = random.uniform(0.75, 0.97);
  const double curl = random.uniform(0.012, 0.03), curl_rate = random.uniform(4, 9);
  const Vec3d curl_axis = random.direction();

  std::vector<Vec3d> path(kRings + 2);
  for (int i = 0; i < kRings + 2; ++i) {
    const double t = static_cast<double>(i) / (kRings + 1);
    for (int k = 0; k < 2; ++k)
      direction = normalized(direction + cross(axes[k], direction) *
                                             (0.028 * sin_turns(rates[k] * t + phases[k])));
    const Vec3d a = normalized(cross(direction, curl_axis)), b = cross(direction, a);
    const Vec3d loop = a * cos_turns(curl_rate * t) + b * sin_turns(curl_rate * t);
    path[i] = direction * lerp(inner, outer, std::sqrt(t)) + loop * curl;
  }
  return path;
}

}  // namespace

Mesh make_hairball(double size, std::uint32_t seed, Work work) {
  const int hairs = static_cast<int>(size);
  Builder builder(work);
  builder.material("hair");
  std::vector<double> radii(kRings + 2, kRadius);
  radii.front() = radii.back() = 0;
  for (int h = 0; h < hairs; ++h) {
    Random random(seed, static_cast<std::uint64_t>(h));
    builder.tube(hair_path(random), radii, kSides);
  }
  return builder.take();
}

ScenePreset hairball_preset(double) {
  ScenePreset preset;
  preset.eye = {1.1, 0.5, 2.2};
  preset.fov_degrees = 46;
  preset.sun_direction = normalized(Vec3d{-0.5, 0.9, 0.6});
  // The flight goes once around the ball and comes closer.
  constexpr int kKeys = 9;
  for (int i = 0; i < kKeys; ++i) {
    const double part = static_cast<double>(i) / (kKeys - 1);
    const double turns = 0.074 + part, radius = lerp(2.0, 2.5, cos_turns(part));
    const Vec3d eye{radius * sin_turns(turns), 0.5 * cos_turns(part), radius * cos_turns(turns)};
    preset.flight.push_back({2.5 * i, eye, Vec3d{}});
  }
  return preset;
}

}  // namespace voxdag::scenes
