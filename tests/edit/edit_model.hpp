#pragma once
/// A voxel grid that is edited voxel by voxel: the reference for EditableDag.
#include <functional>
#include <random>
#include <vector>

#include "edit/shape_oracle.hpp"
#include "support/brute_svdag.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/edit/editable_dag.hpp"

namespace voxdag {

/// One cell of the grid: its colour if it has a voxel.
struct ModelVoxel {
  bool is_set = false;
  Value8 color{};
};

class EditModel {
 public:
  EditModel(int levels, const std::vector<Vec3i>& voxels)
      : levels_(levels), voxels_(std::size_t{1} << (3 * levels)) {
    for (const Vec3i v : voxels) (*this)[v].is_set = true;
  }
  int side() const { return 1 << levels_; }
  bool has(Vec3i v) const {
    return (v.x | v.y | v.z) >= 0 && (v.x | v.y | v.z) >> levels_ == 0 && voxels_[place(v)].is_set;
  }
  ModelVoxel& operator[](Vec3i v) { return voxels_[place(v)]; }
  const ModelVoxel& operator[](Vec3i v) const { return voxels_[place(v)]; }
  template <class Fn>
  void for_each(const Fn& fn) const {
    for (int z = 0; z < side(); ++z)
      for (int y = 0; y < side(); ++y)
        for (int x = 0; x < side(); ++x) fn(Vec3i{x, y, z});
  }
  Svdag dag() const {
    return brute_svdag(levels_, voxels_where(levels_, [&](Vec3i v) { return has(v); }));
  }

  void add(const EditShape& shape, Value8 color) {
    for_each([&](Vec3i v) {
      if (!has(v) && oracle_has(shape, v)) (*this)[v] = {true, color};
    });
  }
  void remove(const EditShape& shape) {
    for_each([&](Vec3i v) {
      if (oracle_has(shape, v)) (*this)[v] = {};
    });
  }
  void paint(const EditShape& shape, Value8 color) {
    for_each([&](Vec3i v) {
      if (has(v) && oracle_has(shape, v)) (*this)[v].color = color;
    });
  }
  void replace(const EditShape& shape, Value8 color) {
    for_each([&](Vec3i v) {
      if (oracle_has(shape, v)) (*this)[v] = {true, color};
    });
  }
  void copy(const Box3i& box, Vec3i to, bool moves) {
    const EditModel before = *this;
    const auto in_box = [&](Vec3i v) {
      for (int axis = 0; axis < 3; ++axis)
        if (v[axis] < box.lo[axis] || v[axis] >= box.hi[axis]) return false;
      return before.has(v);
    };
    if (moves)
      for_each([&](Vec3i v) {
        if (in_box(v)) (*this)[v] = {};
      });
    for_each([&](Vec3i v) {
      const Vec3i source = v - (to - box.lo);
      if (!has(v) && in_box(source)) (*this)[v] = before[source];
    });
  }
  void filter(const BallShape& ball, BallFilter filter) {
    const EditModel before = *this;
    for_each([&](Vec3i v) {
      if (!oracle_has(ball, v)) return;
      int around = 0, faces = 0;
      for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
          for (int x = -1; x <= 1; ++x) {
            const bool is_set = before.has(v + Vec3i{x, y, z});
            around += is_set ? 1 : 0;
            if (x * x + y * y + z * z <= 1) faces += is_set ? 1 : 0;
          }
      (*this)[v].is_set = filter == BallFilter::kSmooth ? around >= 14
                          : filter == BallFilter::kGrow ? faces > 0
                                                        : faces == 7;
    });
  }

 private:
  std::size_t place(Vec3i v) const {
    return static_cast<std::size_t>(v.x) |
           (static_cast<std::size_t>(v.y) | static_cast<std::size_t>(v.z) << levels_) << levels_;
  }

  int levels_;
  std::vector<ModelVoxel> voxels_;
};

/// Draws shapes, boxes and colours in and around a grid.
class RandomEdits {
 public:
  RandomEdits(int levels, unsigned seed) : random_(seed), side_(1 << levels) {
    grid.levels = levels;
    grid.voxel_size = 1;
  }
  Grid grid;

  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  double real(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random_);
  }
  Vec3d point() { return {real(-2, side_ + 2), real(-2, side_ + 2), real(-2, side_ + 2)}; }
  Value8 color() {
    return {static_cast<std::uint8_t>(below(256)), static_cast<std::uint8_t>(below(256)),
            static_cast<std::uint8_t>(below(256))};
  }
  BallShape ball() { return std::get<BallShape>(make_ball(grid, point(), real(0, side_ / 3.0))); }
  Box3i box() {
    const Vec3i a{below(side_), below(side_), below(side_)},
        b{below(side_), below(side_), below(side_)};
    return {min(a, b), max(a, b) + Vec3i{1, 1, 1}};
  }
  EditShape shape() {
    switch (below(6)) {
      case 0:
        return make_capsule(grid, point(), point(), real(0, side_ / 6.0));
      case 1: {
        const Vec3d a = point(), b = point();
        return make_box(grid, min(a, b), max(a, b));
      }
      case 2: {
        const Vec3d x = normalized_or(point() - point(), {1, 0, 0});
        const Vec3d y = normalized_or(cross(x, point() - point()), {0, 1, 0});
        const Vec3d axes[] = {x, y, cross(x, y)};
        return make_turned_box(grid, point(), {real(0, 9), real(0, 9), real(0, 9)}, axes);
      }
      case 3:
        return make_half_space(grid, point(), point() - point());
      default:
        return ball();
    }
  }

 private:
  std::mt19937 random_;
  int side_;
};

}  // namespace voxdag
