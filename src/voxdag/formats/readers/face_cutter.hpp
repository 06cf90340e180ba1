#pragma once
/// Cuts polygons into triangles, together with the attributes of their corners.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/polygon.hpp"

namespace voxdag {

/// Cuts one polygon after the other and reuses its scratch memory.
class FaceCutter {
 public:
  explicit FaceCutter(const MeshSource& source)
      : source_(source),
        memory_(source.work().memory),
        old_fan_(memory_),
        corners_(memory_),
        poll_([work = source.work()] { work.poll(); }) {}

  /// Cuts the polygon with the given fan, as cut_polygon() does. Throws Error with the file's name
  /// if the polygon would cost too much, OverMemory and Cancelled.
  void cut(std::span<Triangle> fan, std::span<const Vec3f> vertices) {
    if (fan.size() < 2) return;
    const MemoryReservation scratch(memory_, scratch_bytes(fan.size()));
    try {
      cut_polygon(fan, vertices, poll_);
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      throw source_.error(error.reason());
    }
  }

  /// Cuts the polygon, and finds the corner of the polygon for each corner of the triangles. Then
  /// move_attributes() applies to the arrays of this face.
  void cut_and_match(std::span<Triangle> fan, std::span<const Vec3f> vertices) {
    is_cut_ = false;
    if (fan.size() < 2) return;
    old_fan_.assign(fan.begin(), fan.end());
    cut(fan, vertices);
    is_cut_ = !std::equal(fan.begin(), fan.end(), old_fan_.begin());
    if (is_cut_) match(fan);
  }

  /// Moves the values of the face's corners, three for each triangle, from the triangles of the fan
  /// to those of the cut.
  template <class T>
  void move_attributes(std::span<T> values) const {
    if (!is_cut_) return;
    CountedVector<T> of_polygon(old_fan_.size() + 2, T{}, CountedAllocator<T>(memory_));
    of_polygon[0] = values[0];
    of_polygon[1] = values[1];
    for (std::size_t t = 0; t < old_fan_.size(); ++t) of_polygon[t + 2] = values[3 * t + 2];
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = of_polygon[corners_[i]];
  }

 private:
  /// Returns the scratch memory that cut_polygon() needs for a large polygon. For a small polygon
  /// it is too little to count, and the result is 0.
  static std::uint64_t scratch_bytes(std::size_t triangles) {
    return triangles < 4096 ? 0 : std::uint64_t{80} * triangles;
  }

  /// Returns the vertex of corner `i` of the polygon.
  std::uint32_t vertex(std::size_t i) const { return i < 2 ? old_fan_[0][i] : old_fan_[i - 2][2]; }

  /// Matches corners of triangles to corners of the polygon. A corner that a triangle had in the
  /// fan stays. Any other corner gets the first corner of the polygon with its vertex.
  void match(std::span<const Triangle> triangles) {
    CountedVector<std::pair<std::uint32_t, std::uint32_t>> by_vertex(memory_);
    by_vertex.reserve(old_fan_.size() + 2);
    for (std::uint32_t i = 0; i < old_fan_.size() + 2; ++i) by_vertex.emplace_back(vertex(i), i);
    std::sort(by_vertex.begin(), by_vertex.end());
    corners_.clear();
    corners_.reserve(3 * triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t in_fan = c == 0 ? 0 : t + c;
        const std::uint32_t v = triangles[t][c];
        corners_.push_back(
            vertex(in_fan) == v
                ? static_cast<std::uint32_t>(in_fan)
                : std::lower_bound(by_vertex.begin(), by_vertex.end(), std::pair(v, 0u))->second);
      }
  }

  const MeshSource& source_;
  MemoryBudget* memory_;
  CountedVector<Triangle> old_fan_;
  CountedVector<std::uint32_t> corners_;  ///< For each corner of the triangles: the polygon's.
  bool is_cut_ = false;
  std::function<void()> poll_;
};

}  // namespace voxdag
