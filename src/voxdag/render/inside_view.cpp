#include "voxdag/render/inside_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxdag/render/camera.hpp"

namespace voxdag {
namespace {

/// Returns a score that is high for distant surfaces, few near obstacles and little sky.
double view_score(const SceneExplorer& explorer, const Camera& camera, double size) {
  constexpr int kColumns = 10, kRows = 6;
  double sum = 0;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const Vec3d ray = normalized(camera.direction((column + 0.5) * camera.width / kColumns,
                                                    (row + 0.5) * camera.height / kRows));
      const double distance = explorer.distance(camera.eye, ray) / size;
      if (distance < 0.04)
        sum -= 1;
      else if (distance < HUGE_VAL)
        sum += 1 + std::log2(std::min(distance, 0.6) / 0.04);
    }
  return sum / (kColumns * kRows);
}

}  // namespace

std::vector<InsideView> inside_views(const CoarseCells& scene, const SceneExplorer& explorer,
                                     const Grid& grid, const Compass& compass, double fov,
                                     double aspect) {
  constexpr int kPlaces = 160, kDirections = 48, kYaws = 24;
  if (scene.cells().empty()) return {};
  const double cell_size = grid.cell_size(scene.level());
  const Vec3d lo = grid.origin + static_cast<Vec3d>(scene.bounds().lo) * cell_size;
  const Vec3d extent = static_cast<Vec3d>(scene.bounds().hi - scene.bounds().lo) * cell_size;
  const double size = length(extent);
  std::vector<InsideView> views;
  for (int place = 0; place < kPlaces; ++place) {
    // The R3 sequence, limited to low heights, where people stand.
    double u[3] = {0.8191725134, 0.6710436067, 0.5497004779};
    for (double& c : u) c = c * (place + 1) - std::floor(c * (place + 1));
    const double height = 0.12 + 0.38 * u[2];
    Vec3d eye = lo + extent * 0.5;
    eye = eye + compass.east * (dot(extent, {std::fabs(compass.east.x), std::fabs(compass.east.y),
                                             std::fabs(compass.east.z)}) *
                                (0.8 * u[0] - 0.4));
    eye =
        eye + compass.north * (dot(extent, {std::fabs(compass.north.x), std::fabs(compass.north.y),
                                            std::fabs(compass.north.z)}) *
                               (0.8 * u[1] - 0.4));
    eye = eye + compass.up * (dot(extent, {std::fabs(compass.up.x), std::fabs(compass.up.y),
                                           std::fabs(compass.up.z)}) *
                              (height - 0.5));

    int met = 0, close = 0;
    for (int i = 0; i < kDirections; ++i) {
      const double distance = explorer.distance(eye, sphere_direction(compass, i, kDirections));
      met += distance < HUGE_VAL ? 1 : 0;
      close += distance < 0.02 * size ? 1 : 0;
    }
    if (met < kDirections * 3 / 4 || close > 0) continue;
    InsideView best;
    for (int i = 0; i < kYaws; ++i) {
      View view;
      view.eye = eye;
      view.target = eye + compass.direction(2 * std::numbers::pi * i / kYaws, -0.02) * (size / 4);
      view.up = compass.up;
      view.vertical_fov_degrees = fov;
      const Camera camera = make_camera(view, 1000, static_cast<int>(1000 / aspect) + 1);
      const double score = view_score(explorer, camera, size);
      if (score > best.score) best = {score, view};
    }
    if (best.score > 0) views.push_back(best);
  }
  std::stable_sort(views.begin(), views.end(),
                   [](const InsideView& a, const InsideView& b) { return a.score > b.score; });
  return views;
}

Vec3d interior_sun(const VoxelSet& voxels, const Grid& grid, const View& view, double aspect) {
  constexpr int kColumns = 24, kRows = 14, kSuns = 200;  // half of the suns are below the horizon
  const SceneExplorer explorer(voxels, grid);
  const Compass compass(view.up);
  const Camera camera = make_camera(view, 1000, static_cast<int>(1000 / aspect) + 1);
  const double cell_size = grid.side() / 512;  // of the explorer
  std::vector<Vec3d> seen;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const Vec3d ray = normalized(camera.direction((column + 0.5) * camera.width / kColumns,
                                                    (row + 0.5) * camera.height / kRows));
      const double distance = explorer.distance(camera.eye, ray);
      if (distance < HUGE_VAL) seen.push_back(camera.eye + ray * (distance - 2 * cell_size));
    }
  Vec3d best = compass.direction(2.5, 1.2);
  int most = 0;
  for (int i = 0; i < kSuns / 2; ++i) {  // the steepest first
    Vec3d sun = sphere_direction(compass, i, kSuns);
    for (int axis = 0; axis < 3; ++axis) sun[axis] = std::round(sun[axis] * 1024) / 1024;
    int lit = 0;
    for (const Vec3d point : seen) lit += explorer.distance(point, sun) < HUGE_VAL ? 0 : 1;
    if (lit > most) most = lit, best = sun;
  }
  for (int axis = 0; axis < 3; ++axis) best[axis] = std::round(best[axis] * 1024) / 1024;
  return best;
}

}  // namespace voxdag
