#include "voxdag/esvo/cell_builder.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/core/bits.hpp"
#include "voxdag/image/color.hpp"
#include "voxdag/voxelize/cell_classify.hpp"

namespace voxdag {
namespace {

/// Beyond so many polygons a cell is not asked whether it could be a leaf.
constexpr std::size_t kMostInLeaf = 24;

/// What surfaces look like that have no colour: linear light.
constexpr Vec3f kGrey{0.62f, 0.60f, 0.57f};

/// sRGB codes by the leading bits of a float: 13 octaves below 1, 256 steps each, half a code off
/// at most where the curve is steepest.
class SrgbTable {
 public:
  SrgbTable() {
    for (std::uint32_t i = 0; i < kSize; ++i)
      codes_[i] = linear_to_srgb8(float_from_bits(kFirst + (i << kShift) + (1u << (kShift - 1))));
  }
  std::uint8_t operator()(float linear) const {
    if (!(linear > float_from_bits(kFirst))) return 0;
    if (linear >= 1) return 255;
    return codes_[(bits_of_float(linear) - kFirst) >> kShift];
  }

 private:
  static constexpr std::uint32_t kFirst = (127 - 13) << 23, kShift = 15, kSize = 13 * 256;
  std::uint8_t codes_[kSize];
};

Vec3d to_double(Vec3f v) { return static_cast<Vec3d>(v); }

/// What stands for a triangle that meets a cell in a corner that rounding lost: its first corner,
/// moved into the cell.
SurfacePolygon touching(const SurfacePolygon& polygon) {
  SurfacePolygon point;
  point.count = 1;
  point.edges[0] = SurfacePolygon::kCutEdge;
  for (int axis = 0; axis < 3; ++axis)
    point.corners[0][axis] = std::clamp(polygon.corners[0][axis], -1.0, 1.0);
  return point;
}

}  // namespace

VoxelValue voxel_value(const SurfaceSum& sum) {
  static const SrgbTable encode;
  VoxelValue value;
  const float scale = sum.area > 0 ? 1 / sum.area : 0;
  for (int i = 0; i < 3; ++i) value.color[i] = encode(sum.color[i] * scale);
  const float length2 = dot(sum.normal, sum.normal);
  value.normal = length2 > 0 ? sum.normal * (1 / std::sqrt(length2)) : Vec3f{0, 1, 0};
  return value;
}

void CellBuilder::start(int log2_size, Vec3i origin, const ConvexPolyhedron& shape) {
  log2_size_ = log2_size;
  origin_ = origin;
  shape_ = shape;
  triangles_.clear();
  ids_.clear();
  items_.clear();
  tree_ = {};
}

void CellBuilder::add(const SurfaceTriangle& triangle, std::uint32_t id) {
  Item item;
  item.triangle = static_cast<std::uint32_t>(triangles_.size());
  item.conditions = triangle.setup.conditions;
  item.polygon = triangle.polygon({}, log2_size_);
  item.polygon.clip_to_cell();
  if (item.polygon.count == 0) item.polygon = touching(triangle.polygon({}, log2_size_));
  triangles_.push_back(triangle);
  ids_.push_back(id);
  items_.push_back(item);
}

double CellBuilder::area_of(const Item& item, int log2_size) const {
  const Vec3d area = item.polygon.area();
  return std::sqrt(dot(area, area)) * std::ldexp(1.0, 2 * (log2_size - 1));
}

double CellBuilder::weight() const {
  double weight = 0;
  for (const Item& item : items_) weight += 1 + area_of(item, log2_size_);
  return weight;
}

void CellBuilder::split(std::vector<std::uint32_t> (&children)[8]) const {
  for (auto& child : children) child.clear();
  for (const Item& item : items_) {
    const ChildConditions classified = classify_children(
        triangles_[item.triangle].setup, item.conditions, {}, 1 << (log2_size_ - 1));
    for (std::uint32_t left = classified.alive; left != 0; left &= left - 1)
      children[std::countr_zero(left)].push_back(ids_[item.triangle]);
  }
}

int CellBuilder::barycentrics(const Item& item, int log2_size, Vec3i cell,
                              Vec2f (&points)[SurfacePolygon::kMaxCorners]) const {
  const SurfaceTriangle& triangle = triangles_[item.triangle];
  const double half = 0.5 * static_cast<double>(std::int64_t{1} << log2_size);
  const Vec3d centre = static_cast<Vec3d>(cell) + Vec3d{half, half, half};
  for (int i = 0; i < item.polygon.count; ++i)
    points[i] = triangle.barycentric(centre + item.polygon.corners[i] * half);
  return item.polygon.count;
}

SurfaceSample CellBuilder::sample(const Item& item, int log2_size, Vec3i cell) const {
  const SurfaceTriangle& triangle = triangles_[item.triangle];
  if (shading_ == nullptr) return {kGrey, 1, static_cast<Vec3f>(triangle.normal)};
  Vec2f points[SurfacePolygon::kMaxCorners];
  const int count = barycentrics(item, log2_size, cell, points);
  SurfaceSample sample = shading_->mean(triangle.source, {points, static_cast<std::size_t>(count)});
  if (triangle.is_displaced) sample.normal = static_cast<Vec3f>(triangle.normal);
  return sample;
}

SurfaceSum CellBuilder::sum_of(std::size_t begin, int log2_size, Vec3i cell) const {
  SurfaceSum sum;
  for (std::size_t i = begin; i < items_.size(); ++i) {
    const SurfaceSample s = sample(items_[i], log2_size, cell);
    // A touch counts a little, so that every voxel looks like something, and so does a surface of
    // which the alpha test may leave something.
    const float area =
        static_cast<float>(area_of(items_[i], log2_size) + 1e-6) * std::max(s.coverage, 1e-3f);
    sum.add({s.color * area, s.normal * area, area});
  }
  return sum;
}

void CellBuilder::drop_cut_away(std::size_t begin, int log2_size, Vec3i cell) {
  if (shading_ == nullptr) return;
  const auto is_cut_away = [&](const Item& item) {
    const std::uint32_t source = triangles_[item.triangle].source;
    if (!shading_->may_be_cut(source)) return false;
    Vec2f points[SurfacePolygon::kMaxCorners];
    const int count = barycentrics(item, log2_size, cell, points);
    return shading_->is_cut_away(source, {points, static_cast<std::size_t>(count)});
  };
  const auto first = items_.begin() + static_cast<std::ptrdiff_t>(begin);
  items_.erase(std::remove_if(first, items_.end(), is_cut_away), items_.end());
}

ContourCandidates CellBuilder::candidates(std::size_t begin) const {
  ContourCandidates result;
  for (std::size_t i = begin; i < items_.size(); ++i) {
    const Item& item = items_[i];
    const SurfaceTriangle& triangle = triangles_[item.triangle];
    if (triangle.contour_normal == Vec3i{}) {
      // A segment or a point: across all axes.
      for (int axis = 0; axis < 3; ++axis) {
        Vec3i n{};
        n[axis] = Contour::kMaxNormal;
        result.add(n, 1e-6);
      }
      continue;
    }
    const Vec3d area = item.polygon.area();
    result.add(triangle.contour_normal, std::sqrt(dot(area, area)));
    if (triangle.open_edges == 0) continue;
    for (int k = 0; k < item.polygon.count; ++k) {
      const std::uint8_t edge = item.polygon.edges[k];
      if (edge == SurfacePolygon::kCutEdge || (triangle.open_edges >> edge & 1) == 0) continue;
      const Vec3d along = triangle.corners[(edge + 1) % 3] - triangle.corners[edge];
      const Vec3d across = cross(triangle.normal, along);
      const Vec3d part =
          item.polygon.corners[(k + 1) % item.polygon.count] - item.polygon.corners[k];
      if (dot(across, across) > 0) result.add(quantize_direction(across), dot(part, part));
    }
  }
  return result;
}

bool CellBuilder::is_near(std::size_t begin, const ConvexPolyhedron& shape, double error) const {
  if (items_.size() - begin > kMostInLeaf) return false;
  const auto is_near_point = [&](Vec3d p) {
    for (std::size_t i = begin; i < items_.size(); ++i)
      if (is_within(items_[i].polygon, triangles_[items_[i].triangle].normal, p, error))
        return true;
    return false;
  };
  for (int i = 0; i < shape.vertex_count(); ++i)
    if (!is_near_point(to_double(shape.vertex(i)))) return false;
  return shape.is_empty() || is_near_point(to_double(shape.centre()));
}

bool CellBuilder::is_uniform(std::size_t begin, int log2_size, Vec3i cell) const {
  if (!settings_.attributes) return true;
  // The normals of what is grey or displaced are its own; of the rest `shading_` knows.
  constexpr float kAnyNormal = 4;
  const auto own_normal = [&](const Item& item) {
    return shading_ == nullptr || triangles_[item.triangle].is_displaced;
  };
  const auto normal_error = [&](const Item& item) {
    return own_normal(item) ? kAnyNormal : settings_.normal_error;
  };
  Vec2f points[SurfacePolygon::kMaxCorners];
  const auto polygon_of = [&](const Item& item) {
    const int count = barycentrics(item, log2_size, cell, points);
    return std::span<const Vec2f>(points, static_cast<std::size_t>(count));
  };
  // Most that are not uniform are not by themselves: the mean need not be known.
  for (std::size_t i = begin; shading_ != nullptr && i < items_.size(); ++i)
    if (!shading_->may_be_uniform(triangles_[items_[i].triangle].source, polygon_of(items_[i]),
                                  settings_.color_error, normal_error(items_[i])))
      return false;
  const SurfaceSum sum = sum_of(begin, log2_size, cell);
  if (!(sum.area > 0)) return false;
  const SurfaceSample mean{sum.color * (1 / sum.area), 1, sum.normal * (1 / sum.area)};
  const float least = std::cos(std::min(settings_.normal_error, 3.14159265f)) *
                      std::sqrt(dot(mean.normal, mean.normal));
  for (std::size_t i = begin; i < items_.size(); ++i) {
    const SurfaceTriangle& triangle = triangles_[items_[i].triangle];
    if (own_normal(items_[i]) && triangle.normal != Vec3d{} &&
        dot(static_cast<Vec3f>(triangle.normal), mean.normal) < least)
      return false;
    if (shading_ != nullptr &&
        !shading_->is_uniform(triangle.source, polygon_of(items_[i]), settings_.color_error,
                              normal_error(items_[i]), mean))
      return false;
  }
  return is_evenly_lit(begin, log2_size, cell);
}

VoxelDecision CellBuilder::decide(std::size_t begin, int log2_size, Vec3i cell,
                                  ConvexPolyhedron& shape) const {
  // A contour that saves less of the voxel's side does not pay for its four bytes, unless it lets
  // the subdivision end here, where each child would have to have one of its own.
  constexpr double kPays = 0.15;
  VoxelDecision decision;
  if (!settings_.contours) {
    decision.is_leaf = log2_size == 0;
    return decision;
  }
  const double error = 2 * static_cast<double>(settings_.max_error) /
                       static_cast<double>(std::int64_t{1} << log2_size);
  bool near = is_near(begin, shape, error);
  if (!near) {
    polygons_.clear();
    for (std::size_t i = begin; i < items_.size(); ++i) polygons_.push_back(&items_[i].polygon);
    const std::optional<FittedContour> fitted = fit_contour(shape, polygons_, candidates(begin));
    if (fitted) {
      ConvexPolyhedron cut = shape;
      clip_to_contour(cut, fitted->contour);
      near = log2_size > 0 && is_near(begin, cut, error);
      if (near || fitted->gain > kPays) {
        decision.contour = fitted->contour;
        shape = cut;
      }
    }
  }
  decision.is_leaf = log2_size == 0 || (near && is_uniform(begin, log2_size, cell));
  return decision;
}

VoxelDecision CellBuilder::decide() { return decide(0, log2_size_, {}, shape_); }

CellBuilder::Visited CellBuilder::visit(std::size_t begin, int log2_size, Vec3i cell,
                                        ConvexPolyhedron& shape) {
  drop_cut_away(begin, log2_size, cell);
  if (items_.size() == begin) return {};
  const VoxelDecision decision = decide(begin, log2_size, cell, shape);
  if (!decision.is_leaf) {
    Visited visited = visit_children(begin, log2_size, cell, shape);
    visited.contour = decision.contour;
    return visited;
  }
  Visited visited;
  visited.sum = leaf_sum(begin, log2_size, cell);
  visited.exists = visited.sum.area > 0;
  visited.is_leaf = true;
  visited.contour = decision.contour;
  return visited;
}

CellBuilder::Visited CellBuilder::visit_children(std::size_t begin, int log2_size, Vec3i cell,
                                                 const ConvexPolyhedron& shape) {
  const std::size_t end = items_.size();
  const std::int32_t half = 1 << (log2_size - 1);
  Visited children[8];
  const std::size_t first_classified = classified_.size();
  for (std::size_t i = begin; i < end; ++i)
    classified_.push_back(
        classify_children(triangles_[items_[i].triangle].setup, items_[i].conditions, cell, half));
  Visited result;
  for (int child = 0; child < 8; ++child) {
    for (std::size_t i = begin; i < end; ++i) {
      const ChildConditions& classified = classified_[first_classified + i - begin];
      if ((classified.alive >> child & 1) == 0) continue;
      Item item;
      item.triangle = items_[i].triangle;
      item.conditions = classified.conditions(child);
      item.polygon = items_[i].polygon.octant(child);
      if (item.polygon.count == 0) item.polygon = touching(items_[i].polygon.in_octant(child));
      items_.push_back(item);
    }
    if (items_.size() == end) continue;
    const Vec3i at = cell + Vec3i{child & 1, child >> 1 & 1, child >> 2} * half;
    ConvexPolyhedron child_shape;
    if (settings_.contours) child_shape = shape.octant(child);
    children[child] = visit(end, log2_size - 1, at, child_shape);
    items_.resize(end);
  }
  classified_.resize(first_classified);

  EsvoNode& node = result.node;
  node.first_contour = static_cast<std::uint32_t>(tree_.contours.size());
  node.first_value = static_cast<std::uint32_t>(tree_.values.size());
  for (int child = 0; child < 8; ++child) {
    const Visited& c = children[child];
    if (!c.exists) continue;
    const auto bit = static_cast<std::uint8_t>(1u << child);
    result.exists = true;
    result.sum.add(c.sum);
    node.valid_mask |= bit;
    if (c.is_leaf) node.leaf_mask |= bit;
    if (c.contour) {
      node.contour_mask |= bit;
      tree_.contours.push_back(*c.contour);
    }
    if (settings_.attributes) tree_.values.push_back(voxel_value(c.sum));
  }
  for (int child = 7; child >= 0; --child)
    if (children[child].exists && !children[child].is_leaf)
      tree_.nodes.push_back(children[child].node);
  // The last one pushed is the first child; build() turns the order round.
  node.first_child = static_cast<std::uint32_t>(tree_.nodes.size()) - 1;
  return result;
}

BuiltVoxel CellBuilder::build(const VoxelDecision& decision) {
  BuiltVoxel built;
  built.contour = decision.contour;
  if (decision.is_leaf) {
    drop_cut_away(0, log2_size_, {});
    built.sum = leaf_sum(0, log2_size_, {});
    built.exists = built.sum.area > 0;
    built.is_leaf = true;
    return built;
  }
  const Visited visited = visit_children(0, log2_size_, {}, shape_);
  built.exists = visited.exists;
  built.sum = visited.sum;
  if (!visited.exists) return built;
  tree_.nodes.push_back(visited.node);
  const auto last = static_cast<std::uint32_t>(tree_.nodes.size()) - 1;
  std::reverse(tree_.nodes.begin(), tree_.nodes.end());
  for (EsvoNode& node : tree_.nodes) node.first_child = last - node.first_child;
  built.tree = std::move(tree_);
  tree_ = {};
  return built;
}

}  // namespace voxdag
