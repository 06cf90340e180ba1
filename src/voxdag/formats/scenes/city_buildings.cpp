#include <algorithm>
#include <cmath>

#include "voxdag/formats/scenes/city_parts.hpp"

namespace voxdag::scenes::city {
namespace {

/// Returns the number of storeys above the shops; more towards the centre.
int storeys_for(Random& random, double centrality) {
  const double u = random.uniform();
  return 2 +
         static_cast<int>(3 * u + centrality * (4 + 8 * u) + centrality * centrality * 30 * u * u);
}

/// Draws a block that may step back once or twice.
void stepped_tower(Builder& b, Random& random, double x0, double x1, double z0, double z1,
                   int storeys) {
  const Style style = random_style(random, true);
  double y = shops(b, random, rectangle(x0, x1, z0, z1), 0, style);
  const int tiers = storeys > 9 ? 1 + random.below(3) : 1;
  for (int tier = 0; tier < tiers; ++tier) {
    const int rest = tiers - tier,
              here = std::max(2, tier + 1 == tiers ? storeys : storeys * 3 / (2 * rest + 2));
    storeys -= here;
    const Footprint f = rectangle(x0, x1, z0, z1);
    y = walls(b, random, f, y, here, style);
    flat_roof(b, f, y);
    if (tier + 1 == tiers || storeys < 2) break;
    const double inset = random.uniform(1.6, 3.2);
    if (x1 - x0 < 4 * inset + 6 || z1 - z0 < 4 * inset + 6) break;
    x0 += inset;
    x1 -= inset;
    z0 += inset;
    z1 -= inset;
  }
  roof_clutter(b, random, x0 + 0.6, x1 - 0.6, z0 + 0.6, z1 - 0.6, y);
}

/// Draws a tower with many sides, or a slab that is turned in its lot.
void turned_tower(Builder& b, Random& random, double x0, double x1, double z0, double z1,
                  int storeys) {
  Style style = random_style(random, true);
  const double cx = (x0 + x1) / 2, cz = (z0 + z1) / 2, r = std::min(x1 - x0, z1 - z0) / 2;
  static constexpr int kSides[] = {4, 6, 8, 16, 24};
  const int sides = kSides[random.below(5)];
  style.bay = std::min(style.bay, 6.28 * r / sides);
  const double phase = random.uniform();
  const auto ring = [&](double radius) {
    Footprint f;
    for (int i = 0; i < sides; ++i) {
      const double t = phase - static_cast<double>(i) / sides;
      f.push_back({cx + radius * cos_turns(t), cz + radius * sin_turns(t)});
    }
    return f;
  };
  const double base = shops(b, random, rectangle(x0, x1, z0, z1), 0, style);
  flat_roof(b, rectangle(x0, x1, z0, z1), base);
  const Footprint f = ring(r * 0.94);
  const double top = walls(b, random, f, base, storeys, style);
  flat_roof(b, f, top);
  const Footprint crown = ring(r * 0.5);
  const double peak = walls(b, random, crown, top, 2, style);
  flat_roof(b, crown, peak);
  b.material("metal");
  b.at({{cx, peak, cz}}, [&] {
    b.tube({{0, 0, 0}, {0, r * 0.7, 0}, {0, r * 1.4, 0}}, {0.35, 0.2, 0.04}, 8);
  });
}

void corner_block(Builder& b, Random& random, double x0, double x1, double z0, double z1,
                  int storeys) {
  const Style style = random_style(random, false);
  const double cut_x = lerp(x0, x1, random.uniform(0.4, 0.55)),
               cut_z = lerp(z0, z1, random.uniform(0.4, 0.55));
  // The inner corner comes first: the L is star-shaped as seen from it.
  const Footprint f = {{cut_x, cut_z}, {x1, cut_z}, {x1, z0}, {x0, z0}, {x0, z1}, {cut_x, z1}};
  double y = shops(b, random, f, 0, style);
  y = walls(b, random, f, y, storeys, style);
  flat_roof(b, f, y);
  roof_clutter(b, random, x0 + 0.6, x1 - 0.6, z0 + 0.6, cut_z - 0.6, y);
}

void row_house(Builder& b, Random& random, double x0, double x1, double z0, double z1,
               int storeys) {
  const Style style = random_style(random, false);
  const Footprint f = rectangle(x0, x1, z0, z1);
  double y = random.chance(0.5) ? shops(b, random, f, 0, style) : 0.0;
  y = walls(b, random, f, y, storeys, style);
  if (random.chance(0.55)) {
    if (x1 - x0 >= z1 - z0) {
      pitched_roof(b, random, x0, x1, z0, z1, y);
    } else {  // the longer side must be along x
      const double cx = (x0 + x1) / 2, cz = (z0 + z1) / 2, half_l = (z1 - z0) / 2,
                   half_w = (x1 - x0) / 2;
      b.at(placed({cx, 0, cz}, 0.25),
           [&] { pitched_roof(b, random, -half_l, half_l, -half_w, half_w, y); });
    }
  } else {
    flat_roof(b, f, y);
    roof_clutter(b, random, x0 + 0.6, x1 - 0.6, z0 + 0.6, z1 - 0.6, y);
  }
}

}  // namespace

void building(Builder& b, Random& random, double x0, double x1, double z0, double z1,
              double centrality) {
  const int storeys = storeys_for(random, centrality);
  const double narrow = std::min(x1 - x0, z1 - z0);
  if (storeys > 8 && narrow > 16 && random.chance(0.3))
    return turned_tower(b, random, x0, x1, z0, z1, storeys);
  if (storeys > 8) return stepped_tower(b, random, x0, x1, z0, z1, storeys);
  if (narrow > 17 && random.chance(0.5)) return corner_block(b, random, x0, x1, z0, z1, storeys);
  row_house(b, random, x0, x1, z0, z1, std::min(storeys, 6));
}

}  // namespace voxdag::scenes::city
