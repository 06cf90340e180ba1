#include "voxdag/image/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>

#include <set>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"

namespace voxdag {
namespace {

/// Returns OpenEXR's slice for channel `c` of an interleaved image.
Imf::Slice slice_of(const ImageF& image, std::size_t c) {
  const std::size_t pixel = sizeof(float) * static_cast<std::size_t>(image.channels);
  const std::size_t row = pixel * static_cast<std::size_t>(image.width);
  // A slice refers to mutable memory even if OpenEXR only reads it.
  auto* base = const_cast<float*>(image.pixels.data() + c);
  return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(base), pixel, row);
}

void require_writable(const std::string& file, const ImageF& image,
                      const std::vector<std::string>& names) {
  const auto fail = [&](const char* why) {
    throw Error(file, "", std::string("cannot write: ") + why);
  };
  if (image.width <= 0 || image.height <= 0 || image.channels <= 0 ||
      image.pixels.size() != ImageF(image.width, image.height, image.channels).pixels.size())
    fail("the number of pixels does not match the size of the image");
  const std::set<std::string> distinct(names.begin(), names.end());
  if (names.size() != static_cast<std::size_t>(image.channels) || distinct.size() != names.size() ||
      distinct.count("") != 0)
    fail("each channel must have a name of its own");
}

}  // namespace

void write_exr(const std::filesystem::path& path, const ImageF& image,
               const std::vector<std::string>& channel_names) {
  require_writable(path.string(), image, channel_names);
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channel_names.size(); ++c) {
      header.channels().insert(channel_names[c], Imf::Channel(Imf::FLOAT));
      frame.insert(channel_names[c], slice_of(image, c));
    }
    Imf::StdOSStream stream;
    {
      Imf::OutputFile out(stream, header);
      out.setFrameBuffer(frame);
      out.writePixels(image.height);
    }
    write_whole_file(path, stream.str());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(path.string(), "", std::string("cannot write: ") + e.what());
  }
}

}  // namespace voxdag
