#pragma once
/// Lights on the command line.
#include <string>

#include "voxdag/render/light.hpp"

namespace voxdag {

/// "point:x,y,z", "sphere:x,y,z,radius", "disc:x,y,z,nx,ny,nz,radius" or
/// "rect:x,y,z,ux,uy,uz,vx,vy,vz", each with ",r,g,b" for its colour or without. Throws
/// std::invalid_argument with the reason where the text is none of these.
LightSpec parse_light(const std::string& text);

}  // namespace voxdag
