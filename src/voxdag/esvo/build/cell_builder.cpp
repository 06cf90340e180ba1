#include "voxdag/esvo/build/cell_builder.hpp"

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
  const auto index = static_cast<std::uint32_t>(triangles_.size());
  triangles_.push_back(triangle);
  SurfaceTriangle& added = triangles_.back();
  set_look(added);
  ids_.push_back(id);
  items_.emplace_back();
  Item& item = items_.back();
  item.triangle = index;
  item.conditions = added.setup.conditions;
  item.polygon = added.polygon({}, log2_size_);
  item.polygon.clip_to_cell();
  set_area(item);
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
  // Where there are very many, some of them tell all directions that matter.
  constexpr std::size_t kMostLookedAt = 48;
  const std::size_t step = (items_.size() - begin + kMostLookedAt - 1) / kMostLookedAt;
  ContourCandidates result;
  for (std::size_t i = begin; i < items_.size(); i += step) {
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
  const auto meets = [&](std::uint32_t first, std::uint32_t last) -> ChildConditions {
    const std::uint64_t every = item.conditions * detail::kEveryLane;
    return {1u << first | 1u << last, {every, every}};
  };
  if (const auto octants = item.polygon.octants()) return meets(octants->first, octants->last);
  // A triangle in the cell whose box lies in one child, or in two side by side, meets them.
  const TriangleSetup& setup = triangles_[item.triangle].setup;
  const int shift = log2_size - 1;
  std::uint32_t lo = 0, hi = 0;
  bool is_inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    const int from = (setup.box_lo[axis] - cell[axis]) >> shift;
    const int to = (setup.box_hi[axis] - cell[axis]) >> shift;
    is_inside &= ((from | to) & ~1) == 0;
    lo |= static_cast<std::uint32_t>(from) << axis;
    hi |= static_cast<std::uint32_t>(to) << axis;
  }
  const std::uint32_t across = lo ^ hi;
  if (is_inside && (across & (across - 1)) == 0) return meets(lo, hi);
  return classify_children(setup, item.conditions, cell, 1 << shift);
}

void CellBuilder::add_part(std::size_t of, const ChildConditions& classified, int child) {
  items_.emplace_back();
  const Item& whole = items_[of];
  Item& item = items_.back();
  item.triangle = whole.triangle;
  item.conditions = classified.conditions(child);
  if ((classified.alive & (classified.alive - 1)) == 0) {
    item.polygon.become_enlarged(whole.polygon, child);
    item.area = 4 * whole.area;
  } else {
    std::uint32_t across = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t low = detail::kLowChildren[axis];
      if ((classified.alive & low) != 0 && (classified.alive & ~low) != 0) across |= 1u << axis;
    }
    item.polygon.become_octant(whole.polygon, child, across);
    set_area(item);
  }
}

CellBuilder::Visited CellBuilder::visit_children(std::size_t begin, int log2_size, Vec3i cell,
                                                 bool is_near, const ConvexPolyhedron& shape) {
  const std::size_t first_classified = classified_.size(), end = items_.size();
  std::uint32_t alive = 0;
  for (std::size_t i = begin; i < end; ++i) {
    classified_.push_back(classify(items_[i], log2_size, cell));
    alive |= classified_.back().alive;
  }
  // Leaves that have no contours need no shapes.
  if (settings_.contours && !is_near && log2_size == 1) is_near = is_too_thin(begin, shape);
  const bool has_shapes = settings_.contours && !is_near;
  // Of the shape: the half that the children at hand are in, and the half of that.
  ConvexPolyhedron half, quarter;
  Visited children[8];
  for (int last = -1; alive != 0; alive &= alive - 1) {
    const int child = std::countr_zero(alive);
    ConvexPolyhedron octant;
    if (has_shapes) {
      if (last < 0 || last >> 2 != child >> 2) half.become_half(shape, 2, child >> 2 != 0);
      if (last < 0 || last >> 1 != child >> 1) quarter.become_half(half, 1, (child >> 1 & 1) != 0);
      octant.become_half(quarter, 0, (child & 1) != 0);
    }
    last = child;
    for (std::size_t i = begin; i < end; ++i) {
      const ChildConditions& classified = classified_[first_classified + (i - begin)];
      if ((classified.alive >> child & 1u) != 0) add_part(i, classified, child);
    }
    const Vec3i at = cell + Vec3i{child & 1, child >> 1 & 1, child >> 2} * (1 << (log2_size - 1));
    children[child] = visit(end, log2_size - 1, at, is_near, octant);
    items_.resize(end);
  }
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
