#include "voxdag/builders/esvo/shape/fit_contour.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {
Interval extent_of(const ConvexPolyhedron& shape, Vec3i normal) {
  const auto n = static_cast<Vec3f>(normal);
  FloatLanes low = all_lanes(HUGE_VALF), high = -low;
  for (int i = 0; i < shape.vertex_count(); i += kLanes) {
    const FloatLanes along = load_lanes(shape.coordinates(0) + i) * n.x +
                             load_lanes(shape.coordinates(1) + i) * n.y +
                             load_lanes(shape.coordinates(2) + i) * n.z;
    low = min(low, along);
    high = max(high, along);
  }
  Interval extent;
  for (int lane = 0; lane < kLanes; ++lane) {
    extent.add(static_cast<double>(low[lane]));
    extent.add(static_cast<double>(high[lane]));
  }
  return extent;
}

void ContourCandidates::add(const ContourDirection& direction, double weight) {
  constexpr float kLike = 0.98f;  // cosine: 11 degrees
  for (std::size_t i = 0; i < count_; ++i) {
    const ContourDirection& other = directions_[i];
    const auto along = static_cast<float>(dot(direction.normal, other.normal));
    if (std::fabs(along) < kLike * direction.length * other.length) continue;
    if (weight > weights_[i]) directions_[i] = direction;
    weights_[i] += weight;
    return;
  }
  if (count_ < kMax) {
    directions_[count_] = direction;
    weights_[count_++] = weight;
    return;
  }
  const auto lightest = static_cast<std::size_t>(
      std::min_element(weights_.begin(), weights_.end()) - weights_.begin());
  if (weights_[lightest] >= weight) return;
  directions_[lightest] = direction;
  weights_[lightest] = weight;
}

namespace {

/// Returns the extents along up to four directions per group.
template <int groups>
ContourExtents extents_by_groups(std::span<const PlanarPolygon> surface,
                                 std::span<const ContourDirection> directions) {
  // Floats are precise enough: their rounding error is a hundredth of kMargin.
  FloatLanes x[groups]{}, y[groups]{}, z[groups]{}, least[groups], most[groups];
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const auto n = static_cast<Vec3f>(directions[i].normal);
    const std::size_t group = i / kLanes, lane = i % kLanes;
    x[group][lane] = n.x, y[group][lane] = n.y, z[group][lane] = n.z;
  }
  for (int group = 0; group < groups; ++group) {
    least[group] = all_lanes(HUGE_VALF);
    most[group] = -least[group];
  }
  for (const PlanarPolygon& p : surface)
    for (int i = 0; i < p.polygon->count; ++i) {
      const auto corner = static_cast<Vec3f>(p.polygon->corners[i]);
      for (int group = 0; group < groups; ++group) {
        const FloatLanes along = x[group] * corner.x + y[group] * corner.y + z[group] * corner.z;
        least[group] = min(least[group], along);
        most[group] = max(most[group], along);
      }
    }
  ContourExtents extents;
  for (std::size_t i = 0; i < directions.size(); ++i)
    extents[i] = {static_cast<double>(least[i / kLanes][i % kLanes]),
                  static_cast<double>(most[i / kLanes][i % kLanes])};
  return extents;
}

}  // namespace

ContourExtents extents_of(std::span<const PlanarPolygon> surface,
                          const ContourCandidates& candidates) {
  const std::span<const ContourDirection> directions = candidates.directions();
  static_assert(ContourCandidates::kMax == 2 * kLanes);
  return directions.size() <= kLanes ? extents_by_groups<1>(surface, directions)
                                     : extents_by_groups<2>(surface, directions);
}

std::optional<FittedContour> fit_contour(const ConvexPolyhedron& shape,
                                         const ContourCandidates& candidates,
                                         const ContourExtents& extents) {
  // A safety margin, in steps of the stored positions.
  constexpr double kMargin = 0.01;
  if (shape.is_empty()) return std::nullopt;
  const ContourDirection* best = nullptr;
  Interval best_surface, best_shape;
  double most = 0;
  for (std::size_t i = 0; i < candidates.directions().size(); ++i) {
    const ContourDirection& direction = candidates.directions()[i];
    const Interval of_surface = extents[i], of_shape = extent_of(shape, direction.normal);
    const double over =
        (of_shape.size() - of_surface.size()) / static_cast<double>(direction.length);
    if (!(over > most)) continue;
    most = over;
    best = &direction;
    best_surface = of_surface;
    best_shape = of_shape;
  }
  if (best == nullptr) return std::nullopt;

  // position = |n|1 (2p - 127) / 127
  const std::int32_t length1_of_best = length1(best->normal);
  constexpr double kSteps = Contour::kMaxPosition;
  const auto step_of = [&](double position) {
    return (position / length1_of_best + 1) * (kSteps / 2);
  };
  // Truncation rounds down, because the positions are clamped to at least 0.
  const double below = step_of(best_surface.lo) - kMargin;
  const double above = kSteps - (step_of(best_surface.hi) + kMargin);
  const int low = std::clamp(static_cast<int>(below), 0, Contour::kMaxPosition);
  const int high =
      Contour::kMaxPosition - std::clamp(static_cast<int>(above), 0, Contour::kMaxPosition);
  FittedContour fitted;
  fitted.contour = Contour::make(best->normal, low, high);
  Interval planes;
  planes.add(std::max(contour_position<double>(length1_of_best, low), best_shape.lo));
  planes.add(std::min(contour_position<double>(length1_of_best, high), best_shape.hi));
  const auto length = static_cast<double>(best->length);
  fitted.gain = (best_shape.size() - planes.size()) / length;
  return fitted;
}

void clip_to_contour(const ConvexPolyhedron& shape, Contour contour, ConvexPolyhedron& result) {
  const Vec3i n = contour.normal();
  ConvexPolyhedron below;
  below.become_part(shape, static_cast<Vec3f>(n),
                    contour_position<float>(length1(n), contour.high()));
  result.become_part(below, static_cast<Vec3f>(-n),
                     -contour_position<float>(length1(n), contour.low()));
}

}  // namespace voxdag
