#include "voxdag/solid/parity.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

#include "voxdag/core/int128.hpp"
#include "voxdag/parallel/polled_for.hpp"

namespace voxdag {
namespace {

constexpr std::int32_t kUnits = 256;  // of a voxel, in each direction

Vec3l centre_of(Vec3i voxel) {
  const auto at = [](std::int32_t v) { return std::int64_t{v} * kUnits + kUnits / 2; };
  return {at(voxel.x), at(voxel.y), at(voxel.z)};
}

template <class T>
int sign_of(T value) {
  return (value > 0) - (value < 0);
}

/// Returns on which side of the line from a to b the ray at p passes in the plane of y and z: 1 or
/// -1; 0 if a and b have the same y and z.
int side_of_edge(const Vec3l& a, const Vec3l& b, const Vec3l& p) {
  const std::int64_t dy = b.y - a.y, dz = b.z - a.z;
  const int side = sign_of(dy * (p.z - a.z) - dz * (p.y - a.y));
  if (side != 0) return side;
  // The ray is at (p.y + e, p.z + e²) for an infinitely small e.
  return dz != 0 ? -sign_of(dz) : sign_of(dy);
}

/// Returns whether the ray from p along +x crosses the triangle, in which p must not lie.
bool crosses(const std::array<Vec3l, 3>& t, const Vec3l& p) {
  const int side = side_of_edge(t[0], t[1], p);
  if (side == 0 || side_of_edge(t[1], t[2], p) != side || side_of_edge(t[2], t[0], p) != side)
    return false;
  const Vec3l u = t[1] - t[0], v = t[2] - t[0], to_p = p - t[0];
  const Vec3l normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  const Int128 above = static_cast<Int128>(normal.x) * to_p.x +
                       static_cast<Int128>(normal.y) * to_p.y +
                       static_cast<Int128>(normal.z) * to_p.z;
  return sign_of(above) * sign_of(normal.x) < 0;
}

/// The places, by where their rays pass in the plane of y and z.
class RayBins {
 public:
  explicit RayBins(const std::vector<Vec3i>& voxels) {
    Vec3i high{};
    low_ = voxels.front();
    high = low_;
    for (const Vec3i v : voxels) {
      low_ = min(low_, v);
      high = max(high, v);
    }
    const auto across = static_cast<std::int32_t>(
        std::clamp(std::sqrt(static_cast<double>(voxels.size())), 1.0, 2048.0));
    width_ = std::max(high.y - low_.y, high.z - low_.z) / across + 1;
    columns_ = (high.y - low_.y) / width_ + 1;
    rows_ = (high.z - low_.z) / width_ + 1;
    begin_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const Vec3i v : voxels) ++begin_[bin_of(v) + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    order_.resize(voxels.size());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t i = 0; i < voxels.size(); ++i) order_[next[bin_of(voxels[i])]++] = i;
  }

  /// Calls visit(index) for all voxels that may lie between these voxels in y and z.
  template <class Visit>
  void each_between(Vec3i lo, Vec3i hi, const Visit& visit) const {
    const std::int32_t first_column = std::max((lo.y - low_.y) / width_, 0),
                       last_column = std::min((hi.y - low_.y) / width_, columns_ - 1),
                       first_row = std::max((lo.z - low_.z) / width_, 0),
                       last_row = std::min((hi.z - low_.z) / width_, rows_ - 1);
    if (hi.y < low_.y || hi.z < low_.z || first_column > last_column) return;
    for (std::int32_t row = first_row; row <= last_row; ++row) {
      const std::size_t bins = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
      const std::size_t begin = begin_[bins + static_cast<std::size_t>(first_column)],
                        end = begin_[bins + static_cast<std::size_t>(last_column) + 1];
      for (std::size_t i = begin; i < end; ++i) visit(order_[i]);
    }
  }

 private:
  std::size_t bin_of(Vec3i v) const {
    return static_cast<std::size_t>((v.z - low_.z) / width_) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>((v.y - low_.y) / width_);
  }

  Vec3i low_;
  std::int32_t width_ = 1, columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> begin_, order_;
};

/// Returns the voxel that a coordinate in units lies in.
std::int32_t voxel_of(std::int32_t units) { return units >> 8; }

}  // namespace

std::vector<bool> are_inside(const QuantizedMesh& mesh, const std::vector<Vec3i>& voxels,
                             Progress* progress) {
  if (voxels.empty()) return {};
  const RayBins bins(voxels);
  std::vector<std::uint8_t> odd(voxels.size(), 0);
  constexpr std::size_t kChunk = 1024;
  const std::size_t count = mesh.triangle_count();
  polled_for((count + kChunk - 1) / kChunk, 1, progress, "inside", [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
      if (!mesh.in_range(i)) continue;
      const QuantizedTriangle triangle = mesh.triangle(i);
      const Vec3i lo = min(min(triangle.x, triangle.y), triangle.z),
                  hi = max(max(triangle.x, triangle.y), triangle.z);
      const std::array<Vec3l, 3> corners = {static_cast<Vec3l>(triangle.x),
                                            static_cast<Vec3l>(triangle.y),
                                            static_cast<Vec3l>(triangle.z)};
      bins.each_between({0, voxel_of(lo.y), voxel_of(lo.z)}, {0, voxel_of(hi.y), voxel_of(hi.z)},
                        [&](std::uint32_t place) {
                          if (crosses(corners, centre_of(voxels[place])))
                            std::atomic_ref(odd[place]).fetch_xor(1, std::memory_order_relaxed);
                        });
    }
  });
  return {odd.begin(), odd.end()};
}

}  // namespace voxdag
