#include "voxdag/mesh_view/embree_scene.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/core/box.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

Box3f bounds_of(const Mesh& mesh) {
  Box3f bounds = Box3f::empty();
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) bounds.extend(mesh.vertices[vertex]);
  return bounds;
}

[[noreturn]] void fail(RTCError code) {
  const char* reason = code == RTC_ERROR_OUT_OF_MEMORY     ? "out of memory"
                       : code == RTC_ERROR_UNSUPPORTED_CPU ? "this processor is not supported"
                                                           : "the mesh was refused";
  throw Error(std::string("Embree: ") + reason + " (error " + std::to_string(code) + ")");
}

}  // namespace

EmbreeScene::EmbreeScene(Mesh mesh, EmbreeMode mode) : mesh_(std::move(mesh)) {
  const Box3f bounds = bounds_of(mesh_);
  if (!bounds.is_empty()) {
    const Vec3d lo = static_cast<Vec3d>(bounds.lo), hi = static_cast<Vec3d>(bounds.hi);
    const double longest = std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z});
    center_ = (lo + hi) * 0.5 + mesh_.origin;
    if (longest > 0) scale_ = std::ldexp(1.0, -std::ilogb(longest));
    radius_ = std::sqrt(dot(hi - lo, hi - lo)) / 2 * scale_;
  }
  for (Vec3f& vertex : mesh_.vertices)
    vertex = static_cast<Vec3f>(from_world(mesh_.to_world(vertex)));
  mesh_.origin = {};
  // Embree loads 16 bytes from each vertex, also from the last one.
  mesh_.vertices.reserve(mesh_.vertices.size() + 1);
  mesh_.vertices.push_back({});

  device_ = rtcNewDevice(nullptr);
  if (device_ == nullptr) fail(rtcGetDeviceError(nullptr));
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, mode == EmbreeMode::kRobust
                               ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION
                               : RTC_SCENE_FLAG_NONE);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             mesh_.vertices.data(), 0, sizeof(Vec3f), mesh_.vertices.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh_.triangles.data(), 0, sizeof(Triangle), mesh_.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  // rtcCommitScene would leave the caller's TBB arena.
  rtcJoinCommitScene(scene_);
  const RTCError code = rtcGetDeviceError(device_);
  if (code == RTC_ERROR_NONE) return;
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
  fail(code);
}

EmbreeScene::~EmbreeScene() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

}  // namespace voxdag
