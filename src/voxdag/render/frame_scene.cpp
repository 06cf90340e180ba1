#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/render/camera.hpp"
#include "voxdag/render/coarse_cells.hpp"
#include "voxdag/render/inside_view.hpp"
#include "voxdag/render/scene_explorer.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag {
namespace {

constexpr int kCoarseLevel = 7;
constexpr double kOutsideFov = 35, kInsideFov = 65;  // degrees, vertical
/// Rooms and courtyards are less open than this, and fill more of their bounds than this. Statues
/// in folded drapery, and objects with a complex inside, do not fulfil both conditions.
constexpr double kInsideOpenness = 0.29, kInsideFill = 0.75;

/// Returns whether the scene's outline, seen along each axis, fills its bounds, like the outline of
/// a building.
bool fills_its_box(const CoarseCells& scene) {
  for (int axis = 0; axis < 3; ++axis)
    if (scene.side_cover(axis, true, scene.side()) < kInsideFill) return false;
  return true;
}

/// Returns the mean fraction of directions in which a line from the scene's cells leaves the scene:
/// about a half for the surface of an object, little for the inside of a building.
double openness(const CoarseCells& scene, const SceneExplorer& explorer, const Grid& grid,
                const Compass& compass) {
  constexpr std::size_t kCells = 500;
  constexpr int kDirections = 40;
  const double cell_size = grid.cell_size(scene.level());
  const std::size_t stride = std::max<std::size_t>(1, scene.cells().size() / kCells);
  int lines = 0, open = 0;
  for (std::size_t at = 0; at < scene.cells().size(); at += stride) {
    const Vec3d middle =
        grid.origin + (static_cast<Vec3d>(scene.cells()[at]) + Vec3d{0.5, 0.5, 0.5}) * cell_size;
    for (int i = 0; i < kDirections; ++i) {
      const Vec3d direction = sphere_direction(compass, i, kDirections);
      // The line starts two cells away: there it has left its own surface, or will meet it.
      const double distance = explorer.distance(middle + direction * (2 * cell_size), direction);
      open += distance < HUGE_VAL ? 0 : 1;
      ++lines;
    }
  }
  return lines == 0 ? 1 : static_cast<double>(open) / lines;
}

/// Returns the view from outside, along `forward`, that the scene exactly fills.
View view_from_outside(const CoarseCells& scene, const Grid& grid, Vec3d forward, Vec3d up,
                       double fov, double aspect) {
  View view;
  view.up = up;
  view.vertical_fov_degrees = fov;
  view.eye = {};
  view.target = forward;
  const Camera camera = make_camera(view, 1, 1);
  const Vec3d right = normalized(camera.right), camera_up = normalized(camera.up);
  constexpr double kMargin = 1.06;
  const double tan_y = std::tan(fov * std::numbers::pi / 360) / kMargin, tan_x = tan_y * aspect;

  // A point (x,y,z), along right, up and forward, is in the picture if |x - ex| <= tan_x * (z - ez)
  // and |y - ey| <= tan_y * (z - ez): four half-spaces. The scene's extent along their normals
  // gives the eye that is farthest forward.
  const Vec3d& ahead = camera.forward;
  const Vec3d normals[] = {right - ahead * tan_x,
                           -right - ahead * tan_x,
                           camera_up - ahead * tan_y,
                           -camera_up - ahead * tan_y,
                           ahead,
                           -ahead};
  double reach[6];
  std::fill(std::begin(reach), std::end(reach), -HUGE_VAL);
  const double cell_size = grid.cell_size(scene.level());
  const auto extend = [&](Vec3d middle, double side) {
    for (int i = 0; i < 6; ++i) {
      const Vec3d n = normals[i];
      const double half = side / 2 * (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
      reach[i] = std::max(reach[i], dot(middle, n) + half);
    }
  };
  for (const Vec3i cell : scene.cells())
    extend(grid.origin + (static_cast<Vec3d>(cell) + Vec3d{0.5, 0.5, 0.5}) * cell_size, cell_size);
  if (scene.cells().empty())
    extend((grid.bounds().lo + grid.bounds().hi) * 0.5, cell_size * scene.side());
  const double x = (reach[0] - reach[1]) / 2, y = (reach[2] - reach[3]) / 2;
  const double far = reach[4], near = -reach[5];
  const double z = std::min({-(reach[0] + reach[1]) / (2 * tan_x),
                             -(reach[2] + reach[3]) / (2 * tan_y), near - cell_size});
  view.eye = right * x + camera_up * y + camera.forward * z;
  view.target = view.eye + camera.forward * ((near + far) / 2 - z);
  return view;
}

/// Throws Error for numbers that are wrong for every target.
void check_numbers(const View& view) {
  if (!is_finite(view.eye) || !is_finite(view.target) || !is_finite(view.up))
    throw Error("the camera's coordinates must be finite");
  if (!(view.vertical_fov_degrees >= kMinFovDegrees && view.vertical_fov_degrees < 180))
    throw Error("the camera's field of view must be at least 0.000001 and below 180 degrees");
  if (!(length(view.up) > 0)) throw Error("the camera's up vector is zero");
}

void check(const View& view) {
  check_numbers(view);
  if (view.target == view.eye) throw Error("the camera's eye and target are the same point");
  const Vec3d forward = view.target - view.eye;
  if (!(length(forward) > 0)) throw Error("the camera's eye and target are too close");
  if (!(length(cross(normalized(forward), normalized(view.up))) > 1e-6))
    throw Error("the camera's up vector points along the view");
}

/// Returns whether the view's eye is within the scene's bounds.
bool is_inside(const View& view, const CoarseCells& scene, const Grid& grid) {
  const double cell_size = grid.cell_size(scene.level());
  const Vec3d eye = (view.eye - grid.origin) * (1 / cell_size);
  for (int axis = 0; axis < 3; ++axis)
    if (!(eye[axis] > scene.bounds().lo[axis] && eye[axis] < scene.bounds().hi[axis])) return false;
  return true;
}

}  // namespace

Vec3d up_across(Vec3d up, Vec3d forward) {
  const Vec3d aside = cross(forward, up);
  if (dot(aside, aside) > 1e-6 * dot(forward, forward) * dot(up, up)) return up;
  return std::fabs(up.z) > std::fabs(up.y) ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1};
}

View frame_scene(const VoxelSet& voxels, const Grid& grid, double aspect,
                 const ViewRequest& request) {
  View view;
  view.up = request.up.value_or(view.up);
  view.vertical_fov_degrees = request.vertical_fov_degrees.value_or(kInsideFov);
  if (request.eye && request.target) {
    view.eye = *request.eye;
    view.target = *request.target;
    if (!request.up)
      view.up =
          up_across(request.scene_up ? *request.scene_up : guess_up(CoarseCells(voxels, kUpLevel)),
                    view.target - view.eye);
    check(view);
    return view;
  }

  const CoarseCells scene(voxels, kCoarseLevel);
  if (!request.up) view.up = request.scene_up ? *request.scene_up : guess_up(scene);
  view.eye = request.eye.value_or(Vec3d{});
  check_numbers(view);  // before its up vector and angle are used
  const Compass compass(view.up);
  if (request.eye) {
    const Vec3i twice_middle = scene.bounds().lo + scene.bounds().hi;
    const Vec3d middle = scene.cells().empty()
                             ? Vec3d{0.5, 0.5, 0.5} * static_cast<double>(scene.side())
                             : static_cast<Vec3d>(twice_middle) * 0.5;
    view.target = grid.to_world(middle * (static_cast<double>(grid.resolution()) / scene.side()));
    check(view);
    return view;
  }

  const bool has_home = request.home && request.home->up == view.up && !request.target;
  if (has_home && is_inside(*request.home, scene, grid)) {
    View inside = *request.home;
    if (request.vertical_fov_degrees) inside.vertical_fov_degrees = *request.vertical_fov_degrees;
    return inside;
  }
  if (!has_home && !request.target && fills_its_box(scene)) {
    const SceneExplorer explorer(voxels, grid);
    if (openness(scene, explorer, grid, compass) < kInsideOpenness) {
      const auto inside =
          inside_views(scene, explorer, grid, compass, view.vertical_fov_degrees, aspect);
      if (!inside.empty()) return inside.front().view;
    }
  }
  const double fov = request.vertical_fov_degrees.value_or(kOutsideFov);
  const Vec3d forward = has_home ? normalized(request.home->target - request.home->eye)
                                 : compass.direction(2.2, -0.42);
  View outside = view_from_outside(scene, grid, forward, view.up, fov, aspect);
  if (request.target) {
    outside.eye = outside.eye + (*request.target - outside.target);
    outside.target = *request.target;
  }
  check(outside);
  return outside;
}

HomeView home_view(const VoxelSet& voxels, const Grid& grid, const std::optional<Vec3d>& up) {
  constexpr double kAspect = 16.0 / 9, kSteps = 1024;
  ViewRequest request;
  request.scene_up = up;
  HomeView home{frame_scene(voxels, grid, kAspect, request), {}};
  const double step = grid.side() / kSteps;
  for (Vec3d* point : {&home.eye, &home.target})
    for (int axis = 0; axis < 3; ++axis)
      (*point)[axis] =
          grid.origin[axis] + std::round(((*point)[axis] - grid.origin[axis]) / step) * step;
  if (is_inside(home, CoarseCells(voxels, kCoarseLevel), grid))
    home.sun = interior_sun(voxels, grid, home, kAspect);
  return home;
}

bool shows_interior(const VoxelSet& voxels, const Grid& grid, const ViewRequest& request,
                    const View& view) {
  // Without a home only frame_scene() knows that the scene is an interior.
  if (request.home ? !request.home->sun : request.eye || request.target) return false;
  return is_inside(view, CoarseCells(voxels, kCoarseLevel), grid);
}

std::vector<View> scene_views(const VoxelSet& voxels, const Grid& grid, double aspect, int count) {
  constexpr double kApart = 0.12;  // fraction of the grid's side, for views with similar directions
  constexpr double kOtherWay = 0.3;  // least cosine of similar directions
  const CoarseCells scene(voxels, kCoarseLevel);
  const SceneExplorer explorer(voxels, grid);
  const Vec3d up = guess_up(scene);
  const Compass compass(up);
  const double side = grid.side();
  std::vector<View> views;
  const auto is_new = [&](const View& view) {
    const Vec3d forward = normalized(view.target - view.eye);
    return std::all_of(views.begin(), views.end(), [&](const View& other) {
      return length(view.eye - other.eye) > kApart * side ||
             dot(forward, normalized(other.target - other.eye)) < kOtherWay;
    });
  };
  for (const InsideView& inside :
       inside_views(scene, explorer, grid, compass, kInsideFov, aspect)) {
    if (static_cast<int>(views.size()) >= count) break;
    if (is_new(inside.view)) views.push_back(inside.view);
  }
  for (int i = 0; static_cast<int>(views.size()) < count; ++i) {
    const Vec3d forward = compass.direction(0.7 + 2.399963229728653 * i, i % 2 == 0 ? -0.2 : -0.6);
    views.push_back(view_from_outside(scene, grid, forward, up, kOutsideFov, aspect));
  }
  return views;
}

}  // namespace voxdag
