#pragma once
/// What the city is made of.
#include "voxdag/scenes/builder.hpp"
#include "voxdag/scenes/random.hpp"

namespace voxdag::scenes::city {

/// A footprint: corners (x, z) in the order in which x runs along the front edge (largest z), so
/// that the outside lies to the right of the way. Star-shaped seen from the first corner.
using Footprint = Profile;

Footprint rectangle(double x0, double x1, double z0, double z1);

/// How the walls of a building look.
struct Style {
  double storey, bay;                  ///< Metres.
  double window_width, window_height;  ///< Parts of a bay and of a storey.
  double recess;                       ///< Metres that the pane lies behind the wall.
  bool sills, fins, balconies, cornices;
  const char* wall;  ///< Material.
};

Style random_style(Random& random, bool tower);

/// Walls with windows from y = `bottom`, `storeys` storeys high, over every edge of the footprint.
/// Returns the height of the top.
double walls(Builder& b, Random& random, const Footprint& footprint, double bottom, int storeys,
             const Style& style);
/// The ground floor: shop windows, doors and awnings. Returns the height of its top.
double shops(Builder& b, Random& random, const Footprint& footprint, double bottom,
             const Style& style);
/// A moulding (x: outwards, y: height above `y`) around a footprint, mitred.
void band(Builder& b, const Footprint& footprint, double y, const Profile& moulding);
/// A flat roof at `y` with a parapet.
void flat_roof(Builder& b, const Footprint& footprint, double y);
/// Machines, tanks and huts on the flat roof of a rectangle.
void roof_clutter(Builder& b, Random& random, double x0, double x1, double z0, double z1, double y);
/// A pitched roof with dormers and a chimney over a rectangle whose longer side is along x.
void pitched_roof(Builder& b, Random& random, double x0, double x1, double z0, double z1, double y);

/// One building on a lot; `centrality` is 0 at the outskirts and 1 in the centre.
void building(Builder& b, Random& random, double x0, double x1, double z0, double z1,
              double centrality);

void tree(Builder& b, Random& random, double height);
void street_lamp(Builder& b);          ///< Its arm reaches over +z.
void car(Builder& b, Random& random);  ///< Drives towards +x.
void park(Builder& b, Random& random, double half_x, double half_z);

}  // namespace voxdag::scenes::city
