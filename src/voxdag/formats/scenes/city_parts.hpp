#pragma once
/// The parts of the city.
#include "voxdag/formats/scenes/builder.hpp"
#include "voxdag/formats/scenes/random.hpp"

namespace voxdag::scenes::city {

/// A footprint: corners (x, z), starting along the front edge (largest z) in the direction of x,
/// with the outside to the right. It is star-shaped as seen from the first corner.
using Footprint = Profile;

Footprint rectangle(double x0, double x1, double z0, double z1);

/// The style of the walls of a building.
struct Style {
  double storey, bay;                  ///< Metres.
  double window_width, window_height;  ///< Fractions of a bay and of a storey.
  double recess;                       ///< Depth of the pane behind the wall, in metres.
  bool sills, fins, balconies, cornices;
  const char* wall;  ///< Material.
};

Style random_style(Random& random, bool tower);

/// Draws walls with windows over every edge of the footprint, from y = `bottom`, `storeys` storeys
/// high. Returns the height of the top.
double walls(Builder& b, Random& random, const Footprint& footprint, double bottom, int storeys,
             const Style& style);
/// Draws the ground floor: shop windows, doors and awnings. Returns the height of its top.
double shops(Builder& b, Random& random, const Footprint& footprint, double bottom,
             const Style& style);
/// Draws a mitred moulding around a footprint (x: outwards, y: height above `y`).
void band(Builder& b, const Footprint& footprint, double y, const Profile& moulding);
/// Draws a flat roof at `y` with a parapet.
void flat_roof(Builder& b, const Footprint& footprint, double y);
/// Draws machines, tanks and huts on the flat roof of a rectangle.
void roof_clutter(Builder& b, Random& random, double x0, double x1, double z0, double z1, double y);
/// Draws a pitched roof with dormers and a chimney over a rectangle whose longer side is along x.
void pitched_roof(Builder& b, Random& random, double x0, double x1, double z0, double z1, double y);

/// Draws one building on a lot; `centrality` is 0 at the outskirts and 1 in the centre.
void building(Builder& b, Random& random, double x0, double x1, double z0, double z1,
              double centrality);

void tree(Builder& b, Random& random, double height);
void street_lamp(Builder& b);          ///< Its arm points to +z.
void car(Builder& b, Random& random);  ///< Its front points to +x.
void park(Builder& b, Random& random, double half_x, double half_z);

}  // namespace voxdag::scenes::city
