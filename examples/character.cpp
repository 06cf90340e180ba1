// A character walks through voxels: a capsule that slides along walls, climbs stairs and falls.
#include <cmath>
#include <cstdio>

#include "voxdag/algebra/contact/contacts.hpp"
#include "voxdag/edit/editable_dag.hpp"

using voxdag::Vec3d;

namespace {

constexpr double kRadius = 0.3, kHeight = 1.8;  // metres
constexpr double kStep = 0.25;                  // climbs stairs up to this height
constexpr double kSkin = 0.005;                 // keeps this distance from what it touches
constexpr double kSteepest = 0.5;               // stands where the normal's z is larger
constexpr double kGravity = 9.81, kSecondsPerFrame = 1.0 / 60;

struct Character {
  Vec3d feet;
  double fall_speed = 0;
  bool is_standing = false;
};

voxdag::Capsule body_at(Vec3d feet) {
  return {feet + Vec3d{0, 0, kRadius}, feet + Vec3d{0, 0, kHeight - kRadius}, kRadius};
}

// Returns the part of a motion that ends kSkin before the contact.
double free_part(const voxdag::SweepHit& hit, Vec3d motion) {
  if (!hit.hit) return 1;
  const double approach = -voxdag::dot(hit.normal, motion);
  return approach > 0 ? std::fmax(0, hit.t - kSkin / approach) : 0;
}

// Moves along the motion, and where that meets voxels along their surface.
Vec3d slide(const voxdag::ContactScene& world, Vec3d feet, Vec3d motion) {
  for (int i = 0; i < 4 && voxdag::length(motion) > 1e-6; ++i) {
    const voxdag::SweepHit hit = voxdag::sweep(world, body_at(feet), motion);
    const double part = free_part(hit, motion);
    feet = feet + motion * part;
    const Vec3d rest = motion * (1 - part);
    motion = rest - hit.normal * voxdag::dot(hit.normal, rest);
  }
  return feet;
}

double distance2(Vec3d a, Vec3d b) {
  const double x = a.x - b.x, y = a.y - b.y;
  return x * x + y * y;
}

// Walks on a level, or one step up if that leads farther.
Vec3d walk(const voxdag::ContactScene& world, Vec3d feet, Vec3d motion) {
  const Vec3d level = slide(world, feet, motion);
  const Vec3d up{0, 0, kStep}, down{0, 0, -kStep};
  const Vec3d raised = feet + up * free_part(voxdag::sweep(world, body_at(feet), up), up);
  const Vec3d across = slide(world, raised, motion);
  const voxdag::SweepHit landing = voxdag::sweep(world, body_at(across), down);
  const bool is_better = distance2(across, feet) > distance2(level, feet) + 1e-9;
  if (!is_better || !landing.hit || landing.normal.z < kSteepest) return level;
  return across + down * free_part(landing, down);
}

void advance(const voxdag::ContactScene& world, Character& character, Vec3d velocity) {
  character.feet = walk(world, character.feet, velocity * kSecondsPerFrame);
  character.fall_speed += kGravity * kSecondsPerFrame;
  const Vec3d fall{0, 0, -character.fall_speed * kSecondsPerFrame - kSkin};
  const voxdag::SweepHit ground = voxdag::sweep(world, body_at(character.feet), fall);
  character.is_standing = ground.hit && ground.normal.z >= kSteepest;
  if (character.is_standing) {
    character.feet = character.feet + fall * free_part(ground, fall);
    character.fall_speed = 0;
  } else {
    character.feet = slide(world, character.feet, fall);
  }
}

// Eight stairs of 20 cm that lead up from a floor at 1 m to a platform with a wall.
voxdag::EditSnapshot make_stairs(const voxdag::Grid& grid) {
  voxdag::Svdag nothing;
  nothing.levels = grid.levels;
  voxdag::EditableDag dag(nothing.view());
  const double side = grid.side();
  for (int stair = 0; stair <= 8; ++stair)
    dag.add(voxdag::make_box(grid, {stair == 0 ? 0 : 2.7 + 0.3 * stair, 0, 0},
                             {side, side, 1 + 0.2 * stair}));
  dag.add(voxdag::make_box(grid, {9, 0, 0}, {side, side, 6}));
  return dag.snapshot();
}

}  // namespace

int main() {
  const voxdag::Grid grid{.levels = 8, .voxel_size = 0.05};
  const voxdag::EditSnapshot stairs = make_stairs(grid);
  const voxdag::ContactScene world{stairs.view(), grid};
  Character character{{1, 2, 1.5}};
  for (int frame = 1; frame <= 360; ++frame) {
    advance(world, character, {2, 1, 0});
    if (frame % 60 == 0)
      std::printf("%d s: %s at %.2f, %.2f, %.2f m\n", frame / 60,
                  character.is_standing ? "stands" : "falls", character.feet.x, character.feet.y,
                  character.feet.z);
  }
}
