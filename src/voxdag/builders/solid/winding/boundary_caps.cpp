#include "voxdag/builders/solid/winding/boundary_caps.hpp"

#include <algorithm>
#include <span>

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/polled_sort.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {
namespace {

/// Walks along the boundary, and cuts off a loop whenever it comes to a point for a second time.
class LoopCutter {
 public:
  LoopCutter(CountedVector<BoundaryEdge> edges, Work work)
      : edges_(std::move(edges)),
        points_(work.memory),
        next_edge_(work.memory),
        place_(work.memory),
        path_(work.memory),
        caps_(work.memory),
        work_(work) {
    polled_sort(edges_.begin(), edges_.end(), work,
                [](const BoundaryEdge& e, const BoundaryEdge& f) {
                  return e.a != f.a ? is_before(e.a, f.a) : is_before(e.b, f.b);
                });
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (i > 0 && edges_[i].a == edges_[i - 1].a) continue;
      points_.push_back(edges_[i].a);
      next_edge_.push_back(i);
    }
    place_.assign(points_.size(), kNotOnPath);
  }

  PageVector<QuantizedTriangle> run() {
    for (std::size_t start = 0; start < points_.size(); ++start) {
      work_.poll_seldom(start);
      walk_from(start);
    }
    return std::move(caps_);
  }

 private:
  static constexpr std::size_t kNotOnPath = ~std::size_t{0};

  /// Returns the number of a point; all ends of edges are also beginnings.
  std::size_t number_of(Vec3i point) const {
    return static_cast<std::size_t>(
        std::lower_bound(points_.begin(), points_.end(), point, is_before) - points_.begin());
  }

  /// Returns an edge that begins at the point and is not used up, or null.
  BoundaryEdge* edge_from(std::size_t point) {
    for (std::size_t& i = next_edge_[point]; i < edges_.size() && edges_[i].a == points_[point];
         ++i)
      if (edges_[i].times > 0) return &edges_[i];
    return nullptr;
  }

  /// Uses up all edges that begin at a point, with the loops that they belong to.
  void walk_from(std::size_t start) {
    path_.assign(1, start);
    place_[start] = 0;
    while (BoundaryEdge* const edge = edge_from(path_.back())) {
      --edge->times;
      const std::size_t next = number_of(edge->b);
      if (place_[next] == kNotOnPath) {
        place_[next] = path_.size();
        path_.push_back(next);
        continue;
      }
      const std::size_t first = place_[next];
      add_cap(std::span(path_).subspan(first));
      for (std::size_t i = first + 1; i < path_.size(); ++i) place_[path_[i]] = kNotOnPath;
      path_.resize(first + 1);
    }
    for (const std::size_t point : path_) place_[point] = kNotOnPath;
  }

  void add_cap(std::span<const std::size_t> loop) {
    const std::size_t count = loop.size(), first = count / 3, second = 2 * count / 3;
    const auto at = [&](std::size_t i) { return points_[loop[i % count]]; };
    caps_.push_back({at(0), at(first), at(second)});
    add_part(at, 0, first);
    add_part(at, first, second);
    add_part(at, second, count);
  }

  /// Caps a part of a loop and the line from its last point to its first one. Halves it, so that
  /// most triangles are small.
  template <class At>
  void add_part(const At& at, std::size_t first, std::size_t last) {
    if (last - first < 2) return;
    const std::size_t middle = first + (last - first) / 2;
    caps_.push_back({at(first), at(middle), at(last)});
    add_part(at, first, middle);
    add_part(at, middle, last);
  }

  CountedVector<BoundaryEdge> edges_;
  CountedVector<Vec3i> points_;           ///< Where edges begin, sorted.
  CountedVector<std::size_t> next_edge_;  ///< Of each point.
  CountedVector<std::size_t> place_;      ///< Of each point on the path.
  CountedVector<std::size_t> path_;       ///< Points.
  PageVector<QuantizedTriangle> caps_;
  Work work_;
};

}  // namespace

PageVector<QuantizedTriangle> cap_boundary(CountedVector<BoundaryEdge> boundary, Work work) {
  return LoopCutter(std::move(boundary), work).run();
}

}  // namespace voxdag
