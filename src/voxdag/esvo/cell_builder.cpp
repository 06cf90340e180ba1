#include "voxdag/esvo/cell_builder.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/voxelize/cell_classify.hpp"

namespace voxdag {

void CellBuilder::start(int log2_size, Vec3i origin, const ConvexPolyhedron& shape) {
  origin_ = origin;
  log2_size_ = log2_size;
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
  triangles_.push_back(triangle);
  set_look(triangles_.back());
  ids_.push_back(id);
  set_area(item);
  items_.push_back(item);
}

void CellBuilder::set_area(Item& item) const {
  item.area = std::max(dot(item.polygon.area(), triangles_[item.triangle].normal), 0.0);
}

double CellBuilder::area_of(const Item& item, int log2_size) const {
  const double half = 0.5 * static_cast<double>(std::int64_t{1} << log2_size);
  return item.area * half * half;
}

double CellBuilder::weight() const {
  double weight = 0;
  for (const Item& item : items_) weight += 1 + area_of(item, log2_size_);
  return weight;
}

void CellBuilder::split(std::array<std::vector<std::uint32_t>, 8>& children) const {
  for (auto& child : children) child.clear();
  for (const Item& item : items_) {
    const ChildConditions classified = classify(item, log2_size_, {});
    for (std::uint32_t left = classified.alive; left != 0; left &= left - 1)
      children[static_cast<std::size_t>(std::countr_zero(left))].push_back(ids_[item.triangle]);
  }
}

ContourCandidates CellBuilder::candidates(std::size_t begin) const {
  ContourCandidates result;
  for (std::size_t i = begin; i < items_.size(); ++i) {
    const Item& item = items_[i];
    const SurfaceTriangle& triangle = triangles_[item.triangle];
    if (!triangle.across.exists()) {
      // A segment or a point: across all axes.
      for (int axis = 0; axis < 3; ++axis) {
        Vec3i n{};
        n[axis] = Contour::kMaxNormal;
        result.add(ContourDirection(n), 1e-6);
      }
      continue;
    }
    result.add(triangle.across, item.area);
    if (triangle.open_edges == 0) continue;
    for (int k = 0; k < item.polygon.count; ++k) {
      const std::uint8_t edge = item.polygon.edges[k];
      if (edge == SurfacePolygon::kCutEdge || !triangle.across_edges[edge].exists()) continue;
      const Vec3d part =
          item.polygon.corners[(k + 1) % item.polygon.count] - item.polygon.corners[k];
      result.add(triangle.across_edges[edge], dot(part, part));
    }
  }
  return result;
}

bool CellBuilder::is_too_thin(std::size_t begin, const ConvexPolyhedron& shape) const {
  constexpr std::size_t kMost = 6;       // Where there are more it is not likely.
  constexpr double kRounding = 0x1p-10;  // more than that of cutting shapes
  if (items_.size() - begin > kMost) return false;
  const auto is_thin = [&](const ContourDirection& across) {
    return 2 * extent_of(shape, across.normal).size() <
           (FittedContour::kLeastGain - kRounding) * static_cast<double>(across.length);
  };
  Vec3i known{};
  for (std::size_t i = begin; i < items_.size(); ++i) {
    const SurfaceTriangle& triangle = triangles_[items_[i].triangle];
    if (!triangle.across.exists() || triangle.open_edges != 0) return false;
    if (triangle.across.normal == known) continue;
    known = triangle.across.normal;
    if (!is_thin(triangle.across)) return false;
  }
  return true;
}

VoxelDecision CellBuilder::decide(std::size_t begin, int log2_size, Vec3i cell, bool is_near,
                                  ConvexPolyhedron& shape, SurfaceSum& sum) const {
  VoxelDecision decision;
  decision.is_near = is_near;
  if (settings_.contours && !is_near) {
    const double error = 2 * static_cast<double>(settings_.max_error) /
                         static_cast<double>(std::int64_t{1} << log2_size);
    polygons_.clear();
    for (std::size_t i = begin; i < items_.size(); ++i)
      polygons_.push_back(
          {&items_[i].polygon, static_cast<Vec3f>(triangles_[items_[i].triangle].normal)});
    const auto is_near_enough = [&](const ConvexPolyhedron& of) {
      return is_near_surface(of, polygons_, static_cast<float>(error));
    };
    decision.is_near = is_near_enough(shape);
    std::optional<FittedContour> fitted;
    if (!decision.is_near) {
      const ContourCandidates directions = candidates(begin);
      fitted = fit_contour(shape, directions, extents_of(polygons_, directions));
    }
    if (fitted && log2_size == 0) {
      if (fitted->pays()) decision.contour = fitted->contour;
    } else if (fitted) {
      ConvexPolyhedron cut;
      clip_to_contour(shape, fitted->contour, cut);
      decision.is_near = is_near_enough(cut);
      if (decision.is_near || fitted->pays()) {
        decision.contour = fitted->contour;
        shape = cut;
      }
    }
  }
  if (log2_size == 0) {
    decision.is_leaf = true;
    sum = sum_of(begin, log2_size, cell);
    put_in_light(begin, log2_size, cell, sum);
  } else {
    decision.is_leaf = decision.is_near && is_uniform(begin, log2_size, cell, sum);
  }
  return decision;
}

VoxelDecision CellBuilder::decide(const VoxelDecision& parent) {
  SurfaceSum sum;
  return decide(0, log2_size_, {}, parent.is_near, shape_, sum);
}

CellBuilder::Visited CellBuilder::visit(std::size_t begin, int log2_size, Vec3i cell, bool is_near,
                                        ConvexPolyhedron& shape) {
  drop_cut_away(begin, log2_size, cell);
  if (items_.size() == begin) return {};
  SurfaceSum sum;
  const VoxelDecision decision = decide(begin, log2_size, cell, is_near, shape, sum);
  if (!decision.is_leaf) {
    Visited visited = visit_children(begin, log2_size, cell, decision.is_near, shape);
    visited.contour = decision.contour;
    return visited;
  }
  Visited visited;
  visited.sum = sum;
  visited.exists = visited.sum.area > 0;
  visited.is_leaf = true;
  visited.contour = decision.contour;
  return visited;
}

ChildConditions CellBuilder::classify(const Item& item, int log2_size, Vec3i cell) const {
  const TriangleSetup& setup = triangles_[item.triangle].setup;
  // A triangle in the cell whose box lies in one child, or in two side by side, meets them.
  const int shift = log2_size - 1;
  unsigned lo = 0, hi = 0;
  bool is_inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    const int from = (setup.box_lo[axis] - cell[axis]) >> shift;
    const int to = (setup.box_hi[axis] - cell[axis]) >> shift;
    is_inside &= ((from | to) & ~1) == 0;
    lo |= static_cast<unsigned>(from) << axis;
    hi |= static_cast<unsigned>(to) << axis;
  }
  const unsigned across = lo ^ hi;
  if (!is_inside || (across & (across - 1)) != 0)
    return classify_children(setup, item.conditions, cell, 1 << shift);
  const std::uint64_t every = item.conditions * 0x0001000100010001ull;
  return {1u << lo | 1u << hi, {every, every}};
}

void CellBuilder::visit_halves(std::size_t begin, const Part& part, std::uint32_t alive,
                               const ConvexPolyhedron& shape, Visited (&children)[8]) {
  const std::size_t end = items_.size();
  const std::uint32_t low = detail::kLowChildren[part.axis];
  for (const bool is_upper : {false, true}) {
    const std::uint32_t half = part.children & (is_upper ? ~low : low);
    if ((alive & half) == 0) continue;
    const int child = std::countr_zero(half);  // The only one where the axis is the last.
    for (std::size_t i = begin; i < end; ++i) {
      const ChildConditions& classified = classified_[items_[i].classified];
      if ((classified.alive & half) == 0) continue;
      items_.emplace_back();
      const Item& whole = items_[i];
      Item& item = items_.back();
      item.triangle = whole.triangle;
      item.classified = whole.classified;
      const bool is_in_one_child = (classified.alive & (classified.alive - 1)) == 0;
      if (!is_in_one_child) {
        item.polygon.become_half(whole.polygon, part.axis, is_upper);
      } else if (part.axis == 0) {
        const Item& of_cell = items_[part.items + whole.classified - part.classified];
        item.polygon = of_cell.polygon;
        for (int axis = 0; axis < 3; ++axis) item.polygon.stretch(axis, (child >> axis & 1) != 0);
        item.area = 4 * of_cell.area;
      }
      if (part.axis > 0) continue;
      item.conditions = classified.conditions(child);
      if (!is_in_one_child) set_area(item);
    }
    ConvexPolyhedron half_shape;
    if (settings_.contours && !part.is_near) half_shape.become_half(shape, part.axis, is_upper);
    if (part.axis > 0) {
      Part next = part;
      next.axis = part.axis - 1;
      next.children = half;
      visit_halves(end, next, alive, half_shape, children);
    } else {
      const Vec3i at =
          part.cell + Vec3i{child & 1, child >> 1 & 1, child >> 2} * (1 << (part.log2_size - 1));
      children[child] = visit(end, part.log2_size - 1, at, part.is_near, half_shape);
    }
    items_.resize(end);
  }
}

CellBuilder::Visited CellBuilder::visit_children(std::size_t begin, int log2_size, Vec3i cell,
                                                 bool is_near, const ConvexPolyhedron& shape) {
  const std::size_t first_classified = classified_.size();
  std::uint32_t alive = 0;
  for (std::size_t i = begin; i < items_.size(); ++i) {
    Item& item = items_[i];
    item.classified = static_cast<std::uint32_t>(classified_.size());
    classified_.push_back(classify(item, log2_size, cell));
    alive |= classified_.back().alive;
  }
  // Leaves that have no contours need no shapes.
  if (settings_.contours && !is_near && log2_size == 1) is_near = is_too_thin(begin, shape);
  Visited children[8];
  visit_halves(begin, {log2_size, cell, is_near, 2, 0xFF, begin, first_classified}, alive, shape,
               children);
  classified_.resize(first_classified);

  Visited result;
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
    built.sum = sum_of(0, log2_size_, {});
    put_in_light(0, log2_size_, {}, built.sum);
    built.exists = built.sum.area > 0;
    built.is_leaf = true;
    return built;
  }
  const Visited visited = visit_children(0, log2_size_, {}, decision.is_near, shape_);
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
