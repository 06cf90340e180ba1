#pragma once
/// The parts of the courtyard. Each function draws one part in the builder's frame: y is up, the
/// part stands on y = 0, and its front, if any, faces +z.
#include "voxdag/formats/scenes/builder.hpp"
#include "voxdag/formats/scenes/random.hpp"

namespace voxdag::scenes::courtyard {

/// Fineness of curves: 1 is the default; the number of triangles grows with its square.
struct Detail {
  double scale = 1;
  int operator()(int segments, int least = 3) const {
    const int n = static_cast<int>(segments * scale + 0.5);
    return n < least ? least : n;
  }
};

// columns
void corinthian_column(Builder& b, const Detail& d, double height, double radius);
void slender_column(Builder& b, const Detail& d, double height, double radius);
void square_pier(Builder& b, double height, double half_width);
void baluster(Builder& b, const Detail& d, double height);

// arches
/// Draws a wall over x from 0 to `width` and y from 0 (the springing) to `top`, `thickness` thick
/// and centred on z = 0. A round arch of `radius` is cut from its lower edge.
void arch_wall(Builder& b, const Detail& d, double width, double top, double radius,
               double thickness);
/// Draws the moulding around the arch of an arch_wall(), centred on x = 0, on the wall face z = 0.
void archivolt(Builder& b, const Detail& d, double radius, double band);
/// Draws a groin vault over [0,width] x [-depth,0] that springs at y = 0 and rises by `rise`, seen
/// from below, with ribs along its diagonals.
void groin_vault(Builder& b, const Detail& d, double width, double depth, double rise);

// cloth
/// Draws a pair of curtains between x = 0 and `width`, from a rod at `top` to the floor, tied back.
void tied_curtains(Builder& b, const Detail& d, Random& random, double width, double top);
/// Draws a curtain that hangs straight, from x = 0 to `width`.
void drawn_curtain(Builder& b, const Detail& d, Random& random, double width, double top);
/// Draws a banner that hangs down from y = 0, centred on x = 0, with a pointed end.
void banner(Builder& b, const Detail& d, Random& random, double width, double drop);

// ornaments
void rosette(Builder& b, const Detail& d, double radius);
void lantern(Builder& b, const Detail& d, double chain);  ///< Hangs down from y = 0.
void amphora(Builder& b, const Detail& d, double height);
void agave(Builder& b, const Detail& d, Random& random, double size);
void potted_tree(Builder& b, const Detail& d, Random& random, double height);
void fountain(Builder& b, const Detail& d, Random& random);
void bench(Builder& b, const Detail& d);
/// Draws a panelled door in an arched frame, `width` wide, on the wall face z = 0.
void door(Builder& b, const Detail& d, double width);
/// Draws a window with louvred shutters, on the wall face z = 0.
void shuttered_window(Builder& b, double width, double height);

// building
/// Draws barrel tiles on a slope that rises from (z = 0, y = 0) to (z = -run, y = rise), over x
/// from 0 to `width`, cut along the valleys where neighbouring slopes meet at both ends.
void tiled_roof(Builder& b, const Detail& d, Random& random, double width, double run, double rise);
/// Draws slabs on a square lattice of `pitch` that cover x in [x0,x1], z in [z0,z1]; their top is y
/// = 0.
void paving(Builder& b, Random& random, double x0, double x1, double z0, double z1, double pitch);
/// Draws ashlar with sunk joints over x in [0,width], y in [0,height], on the wall face z = 0; the
/// rectangle `gap` (x, width) up to `gap_height` is left free.
void ashlar(Builder& b, Random& random, double width, double height, Point2 gap, double gap_height);

/// Draws a wall with three hanging bells under a pediment, facing +z.
void bell_gable(Builder& b, const Detail& d);

}  // namespace voxdag::scenes::courtyard
