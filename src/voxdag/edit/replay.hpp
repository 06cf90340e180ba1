#pragma once
/// Recorded sessions of HashDAG's demo, replayed on any scene.
///
/// Format: V. Careil, M. Billeter and E. Eisemann, HashDAG (2020), `replays/*.csv`: one action a
/// line. `EditSphere,X,Y,Z,RADIUS,ADDS` is an edit, in voxels of the scene of the recording, which
/// nobody can download. So a replay keeps the order, the radii and the kinds of the edits, and each
/// ball is placed on a voxel of the scene at hand.
#include <optional>
#include <random>
#include <string_view>

#include "voxdag/core/box.hpp"
#include "voxdag/edit/shapes.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// An edit of a recorded session.
struct ReplayBall {
  double radius_voxels = 0;
  bool adds = false;  ///< Adds the voxels of the ball, else removes them.
};

/// Returns the edit of a line; nothing for an empty line and for what moves the camera, shows the
/// brush or ends a frame. Throws Error for other actions and malformed edits.
std::optional<ReplayBall> parse_replay_line(std::string_view line);

/// Draws the centres of balls: for each a random point in the box around the scene's voxels, with a
/// fixed seed; then the centre of the nearest voxel.
class ReplayPlaces {
 public:
  /// Takes the box of the voxels of `scene`.
  explicit ReplayPlaces(const SvdagView& scene);

  /// Returns the next ball. `now` is the scene as edited so far; without voxels, the ball's centre
  /// is the random point.
  BallShape place(const ReplayBall& ball, const SvdagView& now);

 private:
  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  Box3i box_;
  std::mt19937_64 random_{48};
};

}  // namespace voxdag
