#pragma once
/// The position and direction of a camera.
#include <optional>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The smallest vertical field of view. Far below it, directions of pixels are no longer distinct.
inline constexpr double kMinFovDegrees = 1e-6;

/// A view in world units. The picture's vertical axis is `up`, made perpendicular to the view
/// direction.
struct View {
  Vec3d eye{0, 0, 1};
  Vec3d target{};
  Vec3d up{0, 1, 0};
  double vertical_fov_degrees = 40;
  friend bool operator==(const View&, const View&) = default;
};

/// The view that shows a scene first.
struct HomeView : View {
  /// The direction towards the sun. Only an interior has it: a scene that is seen from inside.
  std::optional<Vec3d> sun;
  friend bool operator==(const HomeView&, const HomeView&) = default;
};

}  // namespace voxdag
