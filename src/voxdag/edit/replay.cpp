#include "voxdag/edit/replay.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/algebra/query/voxel_moments.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/number_text.hpp"
#include "voxdag/core/printable.hpp"

namespace voxdag {

std::optional<ReplayBall> parse_replay_line(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  if (line.empty()) return {};
  std::vector<std::string_view> fields;
  for (std::size_t end = 0; end != line.npos;) {
    end = line.find(',');
    fields.push_back(line.substr(0, end));
    if (end != line.npos) line.remove_prefix(end + 1);
  }
  for (const char* ignored : {"SetLocation", "SetRotation", "SetToolParameters", "EndFrame"})
    if (fields[0] == ignored) return {};
  if (fields[0] != "EditSphere")
    throw Error(in_quotes(fields[0]) + " is no action that can be replayed: only EditSphere is");
  const bool is_whole = fields.size() == 6 && (fields[5] == "true" || fields[5] == "false");
  const auto radius = is_whole ? number_in(fields[4]) : std::nullopt;
  if (!radius || *radius < 0 || *radius > kMaxShapeCoordinate / kSubvoxels)
    throw Error("an edit must be EditSphere,X,Y,Z,RADIUS,true or false");
  return ReplayBall{*radius, fields[5] == "true"};
}

ReplayPlaces::ReplayPlaces(const SvdagView& scene) : box_(bounds_of(scene, {})) {}

BallShape ReplayPlaces::place(const ReplayBall& ball, const SvdagView& now) {
  Vec3d point;
  for (int axis = 0; axis < 3; ++axis)
    point[axis] = box_.lo[axis] + uniform() * (box_.hi[axis] - box_.lo[axis]);
  Vec3i voxel{static_cast<std::int32_t>(point.x), static_cast<std::int32_t>(point.y),
              static_cast<std::int32_t>(point.z)};
  if (const auto nearest = nearest_voxel(now, point)) voxel = nearest->voxel;
  constexpr std::int64_t kHalf = kSubvoxels / 2;
  return {Vec3l(voxel) * std::int64_t{kSubvoxels} + Vec3l{kHalf, kHalf, kHalf},
          std::llround(ball.radius_voxels * kSubvoxels)};
}

}  // namespace voxdag
