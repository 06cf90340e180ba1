#pragma once
/// Numbers the vertices of a mesh while its polygons come by.
#include <cstdint>
#include <functional>
#include <unordered_map>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/formats/exports/faces/face_polygon.hpp"

namespace voxdag {

/// Gives the corners of polygons the numbers of their vertices, in the order in which vertices come
/// first. A vertex is forgotten after its last face. So memory holds those vertices only whose
/// voxels lie on both sides of the walk's end: in Morton order, a small part of a surface.
class SharedVertices {
 public:
  /// Without `share`, each corner of a polygon is a vertex of its own; with it, polygons must have
  /// `uses`. Counts the vertices that it holds in `memory`, which may be null.
  SharedVertices(bool share, MemoryBudget* memory) : share_(share), held_(memory, 0) {}

  /// Sets numbers() and added() to those of a polygon.
  void add(const FacePolygon& polygon) {
    numbers_.clear();
    added_.clear();
    for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
      const std::uint64_t number = share_ ? shared(polygon, i) : count_;
      if (number == count_) {
        added_.push_back(polygon.corners[i]);
        ++count_;
      }
      numbers_.push_back(number);
    }
  }
  /// Returns the numbers of the corners, from 0.
  const std::vector<std::uint64_t>& numbers() const { return numbers_; }
  /// Returns the corners that are new vertices.
  const std::vector<Vec3d>& added() const { return added_; }

 private:
  struct Open {
    std::uint64_t number;
    std::uint8_t left;  ///< Faces that are still to come.
  };
  struct Hash {
    std::size_t operator()(Vec3d p) const {
      std::uint64_t hash = 0;
      for (int axis = 0; axis < 3; ++axis)
        hash = (hash ^ std::hash<double>{}(p[axis])) * 0x9E3779B97F4A7C15u;
      return static_cast<std::size_t>(hash ^ hash >> 32);
    }
  };

  std::uint64_t shared(const FacePolygon& polygon, std::size_t i) {
    if (polygon.uses[i] == 1) return count_;
    const auto [open, is_new] =
        open_.try_emplace(polygon.corners[i], Open{count_, polygon.uses[i]});
    const std::uint64_t number = open->second.number;
    if (--open->second.left == 0) open_.erase(open);
    constexpr std::uint64_t kOpenBytes = 80;  // With the parts of the container.
    if (const std::uint64_t bytes = open_.size() * kOpenBytes; bytes > held_.bytes())
      held_.resize(bytes + (bytes >> 1));
    return number;
  }

  bool share_;
  std::uint64_t count_ = 0;
  std::vector<std::uint64_t> numbers_;
  std::vector<Vec3d> added_;
  std::unordered_map<Vec3d, Open, Hash> open_;
  MemoryReservation held_;
};

}  // namespace voxdag
