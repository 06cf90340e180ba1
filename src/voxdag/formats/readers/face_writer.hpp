#pragma once
/// Writes the triangles of faces.
#include <cstdint>
#include <functional>
#include <span>

#include "voxdag/formats/readers/chunks.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh/polygon.hpp"

namespace voxdag {

/// The vertices of a whole mesh.
struct AllVertices {
  std::uint64_t before = 0;  ///< Number of vertices in the chunks before the one that is read.
  std::uint64_t count = 0;   ///< Number of vertices of the mesh.
  /// Returns the position of a vertex below `count`. Called only for polygons of more than three
  /// corners.
  std::function<Vec3f(std::uint32_t)> position;
};

/// Cuts one face after the other into triangles, and reuses its scratch memory.
class FaceWriter {
 public:
  /// Writes to `triangles`. `source` and `vertices` must outlive the writer.
  FaceWriter(const MeshSource& source, const AllVertices& vertices, std::span<Triangle> triangles)
      : source_(source),
        vertices_(vertices),
        triangles_(triangles),
        poll_(source.work()),
        corners_(source.work().memory),
        positions_(source.work().memory) {}

  /// Adds a corner to the face: the index of a vertex. Throws OverMemory and Cancelled.
  void add_corner(std::uint32_t vertex) {
    poll_.step();
    corners_.push_back(vertex);
  }
  /// Returns the number of corners of the face.
  std::size_t corners() const { return corners_.size(); }

  /// Writes the triangles of the face as cut_polygon() cuts it, none if it has fewer than three
  /// corners, and starts the next face. First calls on_triangle(index in `triangles`, the three
  /// corners of the face that it joins). Throws Fault at `position` if there is no room, Error with
  /// the file's name if the face would cost too much, OverMemory and Cancelled.
  template <class OnTriangle>
  void finish_face(const char* position, const OnTriangle& on_triangle) {
    const std::size_t count = corners_.size() < 3 ? 0 : corners_.size() - 2;
    if (count > triangles_.size() - done_) throw Fault{position, kFileChanged};
    if (count == 1) {  // Most faces are triangles.
      on_triangle(done_, Triangle{0, 1, 2});
      triangles_[done_++] = {corners_[0], corners_[1], corners_[2]};
    } else if (count > 1) {
      for (Triangle& triangle : cut_face(triangles_.subspan(done_, count))) {
        on_triangle(done_++, triangle);
        for (std::uint32_t& corner : triangle) corner = corners_[corner];
      }
    }
    corners_.clear();
  }
  void finish_face(const char* position) {
    finish_face(position, [](std::size_t, const Triangle&) {});
  }

  /// Returns the number of triangles that are written.
  std::size_t written() const { return done_; }
  /// Throws Error if that is not all.
  void check_full() const {
    if (done_ != triangles_.size()) throw source_.error(kFileChanged);
  }

 private:
  /// Bytes that cut_polygon() needs for each triangle. Small polygons need too little to count.
  static constexpr std::uint64_t kScratchBytes = 80, kCountedTriangles = 4096;

  /// Sets `fan` to the triangles of the face, whose indices are those of its corners. Returns it.
  std::span<Triangle> cut_face(std::span<Triangle> fan) {
    for (std::uint32_t t = 0; t < fan.size(); ++t) fan[t] = {0, t + 1, t + 2};
    positions_.clear();
    for (const std::uint32_t corner : corners_) positions_.push_back(vertices_.position(corner));
    const MemoryReservation scratch(
        source_.work().memory, fan.size() < kCountedTriangles ? 0 : kScratchBytes * fan.size());
    try {
      cut_polygon(fan, positions_, [this] { source_.work().poll(); });
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      throw source_.error(error.reason());
    }
    return fan;
  }

  const MeshSource& source_;
  const AllVertices& vertices_;
  std::span<Triangle> triangles_;
  std::size_t done_ = 0;
  CancelPoll poll_;
  CountedVector<std::uint32_t> corners_;  ///< Of the face: indices of vertices.
  CountedVector<Vec3f> positions_;        ///< Of the corners.
};

}  // namespace voxdag
