#include "voxdag/formats/readers/gltf/gltf_transform.hpp"

#include <cmath>

namespace voxdag {
namespace {

/// Returns the rotation by a quaternion (x, y, z, w) of any length but zero.
GltfTransform rotation(const std::vector<double>& q, const GltfValue& user) {
  const double length2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (!(length2 > 0) || !std::isfinite(length2))
    throw user.error("the rotation must be a quaternion that is finite and not zero");
  const double s = 2 / length2;
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return {{{{1 - s * (y * y + z * z), s * (x * y + z * w), s * (x * z - y * w)},
            {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)},
            {s * (x * z + y * w), s * (y * z - x * w), 1 - s * (x * x + y * y)},
            {0, 0, 0}}}};
}

}  // namespace

GltfTransform gltf_node_transform(const GltfValue& node) {
  const std::vector<double> m = node["matrix"].numbers(16);
  GltfTransform transform;
  if (!m.empty()) {
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
      throw node.error("the last row of the matrix must be 0 0 0 1");
    for (std::size_t c = 0; c < 4; ++c)
      transform.columns[c] = {m[4 * c], m[4 * c + 1], m[4 * c + 2]};
    return transform;
  }
  const std::vector<double> r = node["rotation"].numbers(4);
  if (!r.empty()) transform = rotation(r, node);
  const std::vector<double> s = node["scale"].numbers(3);
  for (std::size_t axis = 0; axis < s.size(); ++axis)
    transform.columns[axis] = transform.columns[axis] * s[axis];
  const std::vector<double> t = node["translation"].numbers(3);
  if (!t.empty()) transform.columns[3] = {t[0], t[1], t[2]};
  return transform;
}

}  // namespace voxdag
