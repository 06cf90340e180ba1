#pragma once
/// Reads back the pictures that the library writes.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <filesystem>
#include <string>
#include <vector>

#include "voxdag/image/decode.hpp"
#include "voxdag/image/image.hpp"

namespace voxdag {

/// Reads a PNG as 8-bit RGB; alpha is left out.
inline ImageRgb8 read_rgb8(const std::filesystem::path& path) {
  const DecodedImage image = read_image(path);
  ImageRgb8 rgb(image.width(), image.height());
  for (int y = 0; y < rgb.height; ++y)
    for (int x = 0; x < rgb.width; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        rgb.pixel(x, y)[c] = static_cast<std::uint8_t>(image.pixel(x, y)[c] >> 8);
  return rgb;
}

struct ExrImage {
  ImageF image;
  std::vector<std::string> channel_names;  ///< Sorted, as OpenEXR stores them.
};

/// Reads a single-part OpenEXR file whose data window starts at (0, 0).
inline ExrImage read_exr(const std::filesystem::path& path) {
  Imf::InputFile in(path.c_str());
  const Imath::Box2i window = in.header().dataWindow();
  ExrImage exr;
  const Imf::ChannelList& channels = in.header().channels();
  for (auto c = channels.begin(); c != channels.end(); ++c)
    exr.channel_names.emplace_back(c.name());
  exr.image =
      ImageF(window.max.x + 1, window.max.y + 1, static_cast<int>(exr.channel_names.size()));
  Imf::FrameBuffer frame;
  const std::size_t pixel = sizeof(float) * exr.channel_names.size();
  for (std::size_t c = 0; c < exr.channel_names.size(); ++c)
    frame.insert(exr.channel_names[c],
                 Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(exr.image.pixels.data() + c), pixel,
                            pixel * static_cast<std::size_t>(exr.image.width)));
  in.setFrameBuffer(frame);
  in.readPixels(window.min.y, window.max.y);
  return exr;
}

}  // namespace voxdag
