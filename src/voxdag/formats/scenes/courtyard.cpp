#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/courtyard_parts.hpp"
#include "voxdag/formats/scenes/list.hpp"

/// A cloister court of two storeys: 3 by 8 bays of arcades on fluted columns, groin vaults behind
/// them, a balustraded gallery above, a tiled roof that slopes inwards, a fountain, trees, vases,
/// curtains and banners. The court's floor, its trees and its benches stand at an angle to the
/// axes.
///
/// Plan: the centre of the court is the origin; the arcades stand on |x| = 4.5 and |z| = 12, the
/// outer walls 3.6 m behind. Heights below are above the floor of the galleries.
namespace voxdag::scenes {
namespace {

using namespace courtyard;

constexpr double kBay = 3.0, kHalfX = 4.5, kHalfZ = 12.0;
constexpr double kGallery = 3.6;    // depth from the arcade's axis to the outer wall
constexpr double kThickness = 0.6;  // thickness of the arcade walls
constexpr double kSpring = 3.1, kGroundTop = 5.0, kUpperFloor = 5.45;
constexpr double kPedestal = 0.95, kUpperSpring = 8.05, kUpperTop = 9.1, kRoofFoot = 9.62;
constexpr double kRoofRun = 4.3, kRoofRise = 1.9;
constexpr double kWallTop = 11.4;
constexpr double kCourtFloor = -0.36;

class Courtyard {
 public:
  Courtyard(double size, std::uint32_t seed, Work work)
      : b_(work), detail_{size}, random_(seed, 1) {}

  Mesh make() {
    ground();
    mouldings();
    for (int side = 0; side < 4; ++side) {
      const double turns = 0.25 * side, half_width = side % 2 == 0 ? kHalfX : kHalfZ;
      const double half_depth = side % 2 == 0 ? kHalfZ : kHalfX;
      const int bays = side % 2 == 0 ? 3 : 8;
      b_.at(placed({}, turns), [&] {
        b_.at({{-half_width, 0, -half_depth}}, [&] { range(side, bays); });
      });
    }
    outside();
    furniture();
    b_.at({{0, kWallTop - 0.4, -kHalfZ - kGallery - 0.1}}, [&] { bell_gable(b_, detail_); });
    return b_.take();
  }

 private:
  void ground();
  void mouldings();
  void range(int side, int bays);
  void ground_bay(int side, int bay, int bays);
  void upper_bay();
  void outer_wall(int bay);
  void corner();
  void outside();
  void furniture();

  Builder b_;
  Detail detail_;
  Random random_;
};

void Courtyard::ground() {
  const double x = kHalfX + kGallery + 0.6, z = kHalfZ + kGallery + 0.6;
  b_.material("foundation");
  b_.box({-x, kCourtFloor - 0.3, -z}, {x, kCourtFloor - 0.04, z});

  // Two steps lead up to the galleries on all four sides.
  const double edge_x = kHalfX - 0.45, edge_z = kHalfZ - 0.45;
  b_.material("marble");
  b_.moulding({{0.36, kCourtFloor - 0.1},
               {0.36, kCourtFloor + 0.15},
               {0.39, kCourtFloor + 0.155},
               {0.39, kCourtFloor + 0.175},
               {0.375, kCourtFloor + 0.18},
               {0, kCourtFloor + 0.18},
               {0, -0.03},
               {0.03, -0.025},
               {0.03, -0.005},
               {0.015, 0},
               {-0.9, 0}},
              edge_x, edge_z);

  // The court is paved at 45 degrees; the steps hide the ends of the slabs.
  b_.material("paving");
  const double pitch = 0.62, reach = 0.5 * std::sqrt(2.0);
  const int n = static_cast<int>((edge_x + edge_z) / pitch) + 2;
  for (int i = -n; i <= n; ++i)
    for (int k = -n; k <= n; ++k) {
      const double cx = (i + k) * pitch * reach, cz = (k - i) * pitch * reach;
      if (std::abs(cx) > edge_x - 0.1 || std::abs(cz) > edge_z - 0.1) continue;
      if (cx * cx + cz * cz < 2.0 * 2.0) continue;
      const double half = pitch / 2 - 0.007, top = random_.uniform(-0.005, 0);
      b_.at(placed({cx, kCourtFloor, cz}, 0.125), [&] {
        b_.bevelled_slab({-half, -0.04, -half}, {half, top, half}, 0.008);
      });
    }
  const double gx = kHalfX + kGallery, gz = kHalfZ + kGallery, inner = kHalfX + 0.0;
  paving(b_, random_, -gx, -inner, -gz, gz, 0.6);
  paving(b_, random_, inner, gx, -gz, gz, 0.6);
  paving(b_, random_, -inner, inner, -gz, -kHalfZ, 0.6);
  paving(b_, random_, -inner, inner, kHalfZ, gz, 0.6);
  b_.at({{0, kUpperFloor + 0.015, 0}}, [&] {
    const double edge = inner + 0.1;
    paving(b_, random_, -gx, -edge, -gz, gz, 0.45);
    paving(b_, random_, edge, gx, -gz, gz, 0.45);
    paving(b_, random_, -edge, edge, -gz, -kHalfZ - 0.1, 0.45);
    paving(b_, random_, -edge, edge, kHalfZ + 0.1, gz, 0.45);
  });
}

void Courtyard::mouldings() {
  b_.material("marble");
  const double x = kHalfX - kThickness / 2, z = kHalfZ - kThickness / 2;
  const double y = kGroundTop;
  b_.moulding({{-0.02, y - 0.12},
               {0.03, y - 0.12},
               {0.04, y - 0.08},
               {0.04, y - 0.02},
               {0.03, y},
               {0.03, y + 0.1},
               {0.12, y + 0.16},
               {0.15, y + 0.22},
               {0.24, y + 0.24},
               {0.25, y + 0.3},
               {0.29, y + 0.36},
               {0.3, y + 0.4},
               {0.3, y + 0.45},
               {-0.6, y + 0.45}},
              x, z);
  const double t = kUpperTop;
  b_.moulding({{-0.02, t - 0.2},
               {0.03, t - 0.2},
               {0.05, t - 0.15},
               {0.03, t - 0.1},
               {0.03, t + 0.1},
               {0.09, t + 0.14},
               {0.1, t + 0.28},
               {0.36, t + 0.3},
               {0.37, t + 0.36},
               {0.43, t + 0.44},
               {0.44, t + 0.5},
               {-0.6, t + 0.52}},
              x, z);
  // The handrail of the gallery and the plinth below it.
  const double rail = kUpperFloor + kPedestal;
  const double rx = kHalfX - 0.1, rz = kHalfZ - 0.1;
  b_.moulding({{-0.3, rail - 0.14},
               {0.05, rail - 0.14},
               {0.06, rail - 0.1},
               {0.1, rail - 0.08},
               {0.11, rail - 0.02},
               {0.09, rail},
               {-0.3, rail},
               {-0.31, rail - 0.02},
               {-0.3, rail - 0.08},
               {-0.3, rail - 0.14}},
              rx, rz);
  b_.moulding({{0.08, kUpperFloor},
               {0.08, kUpperFloor + 0.1},
               {0.05, kUpperFloor + 0.13},
               {-0.28, kUpperFloor + 0.13},
               {-0.28, kUpperFloor}},
              rx, rz);
}

/// Draws one side of the court: x runs along the arcade, whose axis is z = 0; +z is the court.
void Courtyard::range(int side, int bays) {
  for (int bay = 0; bay < bays; ++bay)
    b_.at({{bay * kBay, 0, 0}}, [&] {
      ground_bay(side, bay, bays);
      b_.at({{0, kUpperFloor, 0}}, [&] { upper_bay(); });
      outer_wall(bay);
    });
  corner();
  const double width = bays * kBay;
  b_.at({{0, kRoofFoot, 0.75}},
        [&] { tiled_roof(b_, detail_, random_, width, kRoofRun, kRoofRise); });
}

void Courtyard::ground_bay(int side, int bay, int bays) {
  b_.material("marble");
  if (bay > 0) b_.at({}, [&] { corinthian_column(b_, detail_, kSpring, 0.27); });
  const double radius = kBay / 2 - 0.34;
  b_.material("plaster");
  b_.at({{0, kSpring, 0}},
        [&] { arch_wall(b_, detail_, kBay, kGroundTop + 0.1 - kSpring, radius, kThickness); });
  b_.material("marble");
  for (const double face : {0.0, 0.5})
    b_.at(placed({kBay / 2, kSpring, (face == 0 ? 0.5 : -0.5) * kThickness}, face),
          [&] { archivolt(b_, detail_, radius, 0.24); });
  if (bay > 0 && bay % 2 == 0)
    b_.at({{0, 4.42, kThickness / 2}}, [&] { rosette(b_, detail_, 0.33); });
  // Dentils under the string course.
  const int dentils = 20;
  for (int i = 0; i < dentils; ++i) {
    const double x = kBay * (i + 0.5) / dentils;
    b_.box({x - 0.045, kGroundTop + 0.02, 0.3}, {x + 0.045, kGroundTop + 0.12, 0.38});
  }
  b_.material("plaster");
  b_.at({{0, kSpring, -kThickness / 2}},
        [&] { groin_vault(b_, detail_, kBay, kGallery - kThickness / 2, 1.55); });
  // The arch between two vaults.
  b_.at(placed({0, kSpring, -kThickness / 2}, 0.25), [&] {
    arch_wall(b_, detail_, kGallery - kThickness / 2, 1.75, (kGallery - kThickness / 2) / 2 - 0.2,
              0.3);
  });
  b_.at({{kBay / 2, kSpring + 1.45, -kGallery / 2}}, [&] { lantern(b_, detail_, 0.9); });
  const bool long_side = side % 2 == 1;
  if (long_side && bay % 3 == 1)
    b_.at({{0.3, 0, 0}}, [&] { tied_curtains(b_, detail_, random_, kBay - 0.6, kSpring - 0.06); });
  if (!long_side && bay != bays / 2)
    b_.at({{0.3, 0, 0}}, [&] { tied_curtains(b_, detail_, random_, kBay - 0.6, kSpring - 0.06); });
  if (long_side && (bay + side) % 8 == 6)
    b_.at({{0.3, 0, 0}}, [&] { drawn_curtain(b_, detail_, random_, kBay - 0.6, kSpring - 0.06); });
  if (bay % 2 == 1)
    b_.at({{0, kUpperFloor + kPedestal - 0.2, 0.34}},
          [&] { banner(b_, detail_, random_, 0.95, 2.3); });
}

void Courtyard::upper_bay() {
  // Local heights: the gallery's floor is y = 0.
  const double spring = kUpperSpring - kUpperFloor, top = kUpperTop + 0.1 - kUpperFloor,
               radius = 0.53;
  for (int half = 0; half < 2; ++half)
    b_.at({{half * kBay / 2, 0, 0}}, [&] {
      b_.material("marble");
      b_.square({{0.2, 0},
                 {0.2, kPedestal - 0.06},
                 {0.23, kPedestal - 0.03},
                 {0.23, kPedestal},
                 {0, kPedestal}});
      b_.at({{0, kPedestal, 0}}, [&] { slender_column(b_, detail_, spring - kPedestal, 0.13); });
      for (int i = 0; i < 5; ++i)
        b_.at({{0.28 + i * (kBay / 2 - 0.56) / 4, 0.13, 0.0}},
              [&] { baluster(b_, detail_, kPedestal - 0.27); });
      b_.material("plaster");
      b_.at({{0, spring, 0}},
            [&] { arch_wall(b_, detail_, kBay / 2, top - spring, radius, 0.42); });
      b_.material("marble");
      b_.at({{kBay / 4, spring, 0.21}}, [&] { archivolt(b_, detail_, radius, 0.13); });
    });
  // Brackets below the eaves.
  for (int i = 0; i < 6; ++i) {
    const double x = kBay * (i + 0.5) / 6, y = kUpperTop - kUpperFloor;
    b_.box({x - 0.06, y + 0.13, 0.3}, {x + 0.06, y + 0.29, 0.6});
    b_.box({x - 0.05, y + 0.05, 0.3}, {x + 0.05, y + 0.13, 0.48});
  }
  // The gallery's ceiling beams.
  b_.material("wood");
  for (int i = 0; i < 4; ++i)
    b_.box({kBay * i / 4 - 0.08, top - 0.35, -kGallery}, {kBay * i / 4 + 0.08, top - 0.1, -0.2});
  b_.box({0, top - 0.1, -kGallery}, {kBay, top - 0.05, -0.2});
}

void Courtyard::outer_wall(int bay) {
  b_.at({{0, 0, -kGallery}}, [&] {
    b_.material("stone");
    b_.box({0, kCourtFloor, -0.5}, {kBay, kWallTop, 0});
    const bool has_door = bay % 2 == 1;
    ashlar(b_, random_, kBay, kSpring, has_door ? Point2{0.53, 1.94} : Point2{0, 0},
           has_door ? 2.2 : 0.0);
    b_.material("marble");
    b_.box({-0.24, 0, 0}, {0.24, 0.35, 0.16});
    b_.box({-0.2, 0.35, 0}, {0.2, kSpring - 0.22, 0.12});
    b_.box({-0.26, kSpring - 0.22, 0}, {0.26, kSpring, 0.18});
    if (has_door) b_.at({{kBay / 2, 0, 0}}, [&] { door(b_, detail_, 1.4); });
    if (!has_door) b_.at({{kBay / 2, 1.9, 0.03}}, [&] { rosette(b_, detail_, 0.5); });
    b_.at({{kBay / 2, kUpperFloor + 0.7, 0}}, [&] { shuttered_window(b_, 1.1, 1.8); });
    // The outside of the wall has windows too.
    b_.at(placed({kBay / 2, 1.2, -0.5}, 0.5), [&] { shuttered_window(b_, 1.1, 1.9); });
    b_.at(placed({kBay / 2, kUpperFloor + 0.7, -0.5}, 0.5),
          [&] { shuttered_window(b_, 1.1, 1.8); });
  });
  b_.material("plaster");
  b_.box({0, kGroundTop - 0.05, -kGallery}, {kBay, kUpperFloor, 0});
}

/// Draws the pier at the start of a side, and the square of the galleries behind it.
void Courtyard::corner() {
  b_.material("marble");
  square_pier(b_, kSpring, 0.36);
  b_.material("plaster");
  b_.box({-0.34, kSpring, -0.34}, {0.34, kGroundTop + 0.1, 0.34});
  const double inside = kThickness / 2;
  b_.at({{-kGallery, kSpring, -inside}},
        [&] { groin_vault(b_, detail_, kGallery - inside, kGallery - inside, 1.55); });
  b_.box({-kGallery, kGroundTop - 0.05, -kGallery}, {0, kUpperFloor, 0});
  b_.material("marble");
  b_.at({{0, kUpperFloor, 0}}, [&] { square_pier(b_, kUpperTop - kUpperFloor + 0.1, 0.24); });
  b_.material("stone");
  b_.box({-kGallery - 0.5, kCourtFloor, -kGallery - 0.5}, {0, kWallTop, -kGallery});
  b_.box({-kGallery - 0.5, kCourtFloor, -kGallery}, {-kGallery, kWallTop, 0});
}

/// Draws mouldings around the outer walls and stones at their corners.
void Courtyard::outside() {
  const double x = kHalfX + kGallery + 0.5, z = kHalfZ + kGallery + 0.5;
  b_.material("marble");
  const double base = kCourtFloor - 0.04;
  b_.moulding({{0.1, base}, {0.1, base + 0.9}, {0.06, base + 1.0}, {0, base + 1.04}}, x, z, true);
  const double y = kGroundTop;
  b_.moulding(
      {{0, y}, {0.05, y + 0.03}, {0.05, y + 0.2}, {0.12, y + 0.28}, {0.14, y + 0.4}, {0, y + 0.44}},
      x, z, true);
  const double t = kWallTop - 0.75;
  b_.moulding({{0, t},
               {0.05, t + 0.03},
               {0.06, t + 0.3},
               {0.2, t + 0.4},
               {0.22, t + 0.52},
               {0.34, t + 0.62},
               {0.36, t + 0.75},
               {-0.5, t + 0.8}},
              x, z, true);
  b_.material("stone");
  for (int course = 0; course < 20; ++course) {
    const double y0 = base + 1.06 + course * 0.46, y1 = y0 + 0.44;
    if (y1 > t || (y1 > y && y0 < y + 0.44)) continue;
    const double wide = course % 2 == 0 ? 0.9 : 0.5, deep = course % 2 == 0 ? 0.5 : 0.9;
    for (const double sx : {-1.0, 1.0})
      for (const double sz : {-1.0, 1.0})
        b_.box({std::min(sx * (x + 0.05), sx * (x - wide)), y0,
                std::min(sz * (z + 0.05), sz * (z - deep))},
               {std::max(sx * (x + 0.05), sx * (x - wide)), y1,
                std::max(sz * (z + 0.05), sz * (z - deep))});
  }
}

void Courtyard::furniture() {
  b_.at({{0, kCourtFloor, 0}}, [&] { fountain(b_, detail_, random_); });
  for (const double sx : {-1.0, 1.0})
    for (const double sz : {-1.0, 1.0}) {
      b_.at(placed({sx * 3.05, kCourtFloor, sz * 5.7}, 0.125),
            [&] { potted_tree(b_, detail_, random_, 2.5); });
      b_.at(placed({sx * 2.9, kCourtFloor, sz * 9.2}, 0.125 * sx * sz),
            [&] { bench(b_, detail_); });
    }
  // Vases at the feet of the columns, turned at random.
  for (const double sx : {-1.0, 1.0})
    for (int i = 0; i < 7; ++i) {
      const double z = (i - 3) * kBay;
      b_.at(placed({sx * (kHalfX - 0.62), 0, z}, random_.uniform()), [&] {
        b_.material("terracotta");
        const double h = random_.uniform(0.55, 0.75);
        if (i % 2 == 0) {
          amphora(b_, detail_, h);
          b_.at({{0, h * 0.9, 0}}, [&] { agave(b_, detail_, random_, 0.55); });
        }
      });
    }
}

}  // namespace

Mesh make_courtyard(double size, std::uint32_t seed, Work work) {
  return Courtyard(size, seed, work).make();
}

ScenePreset courtyard_preset(double) {
  ScenePreset preset;
  preset.eye = {-0.9, 2.5, 11.4};
  preset.target = {2.0, 2.9, -3};
  preset.fov_degrees = 58;
  preset.sun_direction = normalized(Vec3d{-0.55, 0.9, 0.35});
  // The flight passes the fountain, goes through the arcade, along the gallery behind it, and up
  // over the roofs.
  preset.flight = {
      {0, preset.eye, preset.target},           {4, {-1.5, 2.2, 6.0}, {0.6, 1.6, -1}},
      {8, {-2.7, 1.7, 0.0}, {-1.0, 1.6, -3.5}}, {11, {-1.7, 1.8, -6.9}, {-5.5, 1.9, -8.2}},
      {14, {-5.6, 1.8, -7.4}, {-6.3, 1.9, -3}}, {18, {-6.3, 1.8, -1.0}, {-5.2, 1.9, 4}},
      {21, {-4.4, 2.1, 4.5}, {0, 3.2, 5.0}},    {25, {-1.0, 6.5, 6.0}, {0.5, 5.5, -4}},
      {28, {-2.0, 13.5, 9.5}, {0.2, 4.5, -4}},  {31, {1.5, 18, 21}, {0, 4, -2}}};
  return preset;
}

}  // namespace voxdag::scenes
