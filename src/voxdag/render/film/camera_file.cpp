#include "voxdag/render/film/camera_file.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "voxdag/render/camera.hpp"
#include "voxdag/render/film/json_file.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::json;

/// The camera's axes and its position, in the world.
struct Pose {
  Vec3d right, up, back, eye;
};

/// Returns the first three rows of a matrix of `columns` columns.
std::array<std::array<double, 4>, 3> rows_of(const Json& json, const JsonPlace& place,
                                             const char* member, std::size_t columns) {
  std::array<std::array<double, 4>, 3> rows{};
  if (!json.is_array() || json.size() < 3 || json.size() > columns)
    place.refuse(std::string("\"") + member + "\" must be the rows of a matrix");
  for (std::size_t row = 0; row < 3; ++row) {
    if (!json[row].is_array() || json[row].size() != columns)
      place.refuse(std::string("row ") + std::to_string(row) + " of \"" + member + "\" must have " +
                   std::to_string(columns) + " numbers");
    for (std::size_t i = 0; i < columns; ++i)
      rows[row][i] = json_number(json[row][i], place, member);
  }
  return rows;
}

/// Throws Error unless the axes are those of a rotation. Files round their numbers.
void check_rotation(const Pose& pose, const JsonPlace& place, const char* member) {
  constexpr double kRounding = 1e-3;
  const Vec3d across = cross(pose.right, pose.up) - pose.back;
  for (const Vec3d axis : {pose.right, pose.up, pose.back})
    if (std::fabs(dot(axis, axis) - 1) > kRounding || dot(across, across) > kRounding)
      place.refuse(std::string("\"") + member + "\" is not a rotation and a translation");
}

Pose pose_of(const Json& json, const JsonPlace& place) {
  const char* member = nullptr;
  for (const char* name : {"camera_to_world", "transform_matrix", "world_to_camera"})
    if (member == nullptr && json.contains(name)) member = name;
  if (member == nullptr)
    place.refuse(
        "has neither \"camera_to_world\" nor \"world_to_camera\" nor \"transform_matrix\"");
  const auto m = rows_of(json[member], place, member, 4);
  Pose pose;
  if (member == std::string("world_to_camera")) {
    pose = {
        {m[0][0], m[0][1], m[0][2]}, {m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}, {}};
    pose.eye = -(pose.right * m[0][3] + pose.up * m[1][3] + pose.back * m[2][3]);
  } else {
    const auto column = [&](std::size_t i) { return Vec3d{m[0][i], m[1][i], m[2][i]}; };
    pose = {column(0), column(1), column(2), column(3)};
  }
  check_rotation(pose, place, member);
  const std::string convention = json.value("convention", "opengl");
  if (convention != "opengl" && convention != "opencv")
    place.refuse("\"convention\" is \"" + convention + "\", neither \"opengl\" nor \"opencv\"");
  if (convention == "opencv") {
    pose.up = -pose.up;
    pose.back = -pose.back;
  }
  return pose;
}

/// Returns the vertical angle of view in degrees.
double fov_of(const Json& json, const JsonPlace& place) {
  const auto degrees = [](double height, double focal) {
    return 2 * std::atan(height / (2 * focal)) * 180 / std::numbers::pi;
  };
  if (json.contains("fov_y_degrees"))
    return json_number(json["fov_y_degrees"], place, "fov_y_degrees");
  const char* const height_name = json.contains("height") ? "height" : "h";
  if (!json.contains(height_name)) place.refuse("has neither \"fov_y_degrees\" nor \"height\"");
  const double height = json_number(json[height_name], place, height_name);
  if (json.contains("fl_y")) return degrees(height, json_number(json["fl_y"], place, "fl_y"));
  if (!json.contains("intrinsics")) place.refuse("has no angle of view: \"fov_y_degrees\"");
  constexpr double kPixels = 0.51;  // centres of pixels count as i or as i + 0.5
  const auto m = rows_of(json["intrinsics"], place, "intrinsics", 3);
  if (std::fabs(m[0][0] - m[1][1]) > 1e-3 * std::fabs(m[1][1]))
    place.refuse("\"intrinsics\" has pixels that are not square");
  if (std::fabs(m[1][2] - height / 2) > kPixels ||
      (json.contains("width") &&
       std::fabs(m[0][2] - json_number(json["width"], place, "width") / 2) > kPixels))
    place.refuse("\"intrinsics\" has a centre that is not that of the picture");
  return degrees(height, m[1][1]);
}

}  // namespace

ViewRequest read_camera_file(const std::string& path) {
  const Json json = read_json_file(path, {std::uint64_t{1} << 20, "a camera"});
  const JsonPlace place{path, ""};
  if (!json.is_object()) place.refuse("must be an object");
  const Pose pose = pose_of(json, place);
  ViewRequest request;
  request.eye = pose.eye;
  request.target = pose.eye - pose.back;
  request.up = pose.up;
  request.vertical_fov_degrees = fov_of(json, place);
  return request;
}

std::string camera_json(const View& view, int width, int height) {
  const Camera camera = make_camera(view, width, height);
  const Vec3d right = normalized(camera.right), up = normalized(camera.up), back = -camera.forward;
  const Vec3d eye = camera.eye;
  const auto row = [](double a, double b, double c, double d) { return Json::array({a, b, c, d}); };
  const auto vector = [](Vec3d v) { return Json::array({v.x, v.y, v.z}); };
  const double focal = height / (2 * std::tan(view.vertical_fov_degrees * std::numbers::pi / 360));
  nlohmann::ordered_json out;
  out["convention"] = "opengl";
  out["camera_to_world"] = {row(right.x, up.x, back.x, eye.x), row(right.y, up.y, back.y, eye.y),
                            row(right.z, up.z, back.z, eye.z), row(0, 0, 0, 1)};
  out["world_to_camera"] = {row(right.x, right.y, right.z, -dot(right, eye)),
                            row(up.x, up.y, up.z, -dot(up, eye)),
                            row(back.x, back.y, back.z, -dot(back, eye)), row(0, 0, 0, 1)};
  out["intrinsics"] = {vector({focal, 0, width / 2.0}), vector({0, focal, height / 2.0}),
                       vector({0, 0, 1})};
  out["width"] = width;
  out["height"] = height;
  out["fov_y_degrees"] = view.vertical_fov_degrees;
  out["eye"] = vector(view.eye);
  out["target"] = vector(view.target);
  out["up"] = vector(view.up);
  return out.dump(2) + "\n";
}

}  // namespace voxdag
