#pragma once
/// Finds where the primary rays of a picture may start, by packets of beams.
#include <vector>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/cpu/packets/beam_packet.hpp"
#include "voxdag/render/primary_beams.hpp"

namespace voxdag {

/// Sets `starts` to RenderSetup::beam_starts (see render/primary_beams.hpp) of a whole picture.
/// Runs on all threads, for any layout that cast_beam_packet() accepts. A packet holds 8×8 beams. A
/// beam has `pixels` squared pixels; `pixels` is kBeamPixels or kCoarseBeamPixels. Coarse beams are
/// the default, because finer ones cost more time than they save for rays in packets.
template <class Nodes>
void find_beam_starts(const Nodes& nodes, const RenderSetup& setup, std::vector<float>& starts,
                      int pixels = kCoarseBeamPixels) {
  constexpr int kSide = 8;
  const int parts = pixels / kBeamPixels;
  constexpr float kDown = 1 - 0x1p-20f;  // covers the rounding of a ray's own t
  const Camera& camera = setup.camera;
  const int across = beams_across(camera.width) / parts, down = beams_across(camera.height) / parts;
  starts.resize(static_cast<std::size_t>(across * parts) * static_cast<std::size_t>(down * parts));
  const double to_unit = 1.0 / setup.side();
  const Vec3d origin = camera.direction(0, 0) * to_unit;
  const Vec3d right = (camera.direction(pixels, 0) - camera.direction(0, 0)) * to_unit;
  const Vec3d below = (camera.direction(0, pixels) - camera.direction(0, 0)) * to_unit;
  const Vec3d zero{}, lowest = min(right, zero) + min(below, zero),
                      highest = max(right, zero) + max(below, zero);
  const int columns = (across + kSide - 1) / kSide, rows = (down + kSide - 1) / kSide;
  parallel_for(static_cast<std::size_t>(columns * rows), [&](std::size_t at) {
    const int first_x = static_cast<int>(at) % columns * kSide,
              first_y = static_cast<int>(at) / columns * kSide;
    const int width = across - first_x < kSide ? across - first_x : kSide,
              height = down - first_y < kSide ? down - first_y : kSide;
    BeamPacket packet;
    packet.apex = (camera.eye - setup.grid.origin) * to_unit;
    packet.stop = pixel_beam_stop(setup, pixels);
    for (int i = 0; i < width * height; ++i) {
      const Vec3d corner = origin + right * static_cast<double>(first_x + i % width) +
                           below * static_cast<double>(first_y + i / width);
      packet.add(corner + lowest, corner + highest);
    }
    cast_beam_packet(nodes, packet);
    for (int i = 0; i < width * height; ++i)
      for (int part = 0; part < parts * parts; ++part) {
        const int x = (first_x + i % width) * parts + part % parts,
                  y = (first_y + i / width) * parts + part / parts;
        starts[static_cast<std::size_t>(y) * static_cast<std::size_t>(across * parts) +
               static_cast<std::size_t>(x)] = packet.first[i] * kDown;
      }
  });
}

}  // namespace voxdag
