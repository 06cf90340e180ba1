#pragma once
/// Lights on the command line.
#include <string>

#include "voxdag/render/light.hpp"

namespace voxdag::cli {

/// Parses "point:x,y,z", "sphere:x,y,z,radius", "disc:x,y,z,nx,ny,nz,radius" or
/// "rect:x,y,z,ux,uy,uz,vx,vy,vz". Each may end with ",r,g,b", its colour. Throws
/// std::invalid_argument with the reason if the text is none of these.
LightSpec parse_light(const std::string& text);

}  // namespace voxdag::cli
