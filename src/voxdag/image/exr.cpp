#include "voxdag/image/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>

#include <set>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/image/image_limits.hpp"

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

ImageF decode_exr(std::span<const std::uint8_t> bytes, const std::string& name) {
  try {
    Imf::StdISStream stream;
    stream.str({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    Imf::InputFile in(stream);
    const Imath::Box2i window = in.header().dataWindow();
    const auto side = [](int low, int high) {
      return high < low ? std::uint64_t{0}
                        : static_cast<std::uint64_t>(std::int64_t{high} - low + 1);
    };
    check_image_size(name, side(window.min.x, window.max.x), side(window.min.y, window.max.y));
    const Imf::ChannelList& channels = in.header().channels();
    const bool is_grey = channels.findChannel("R") == nullptr;
    ImageF image(static_cast<int>(side(window.min.x, window.max.x)),
                 static_cast<int>(side(window.min.y, window.max.y)), 3);
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < 3; ++c) {
      const char* const color[] = {"R", "G", "B"};
      const char* const channel = is_grey ? "Y" : color[c];
      const Imf::Channel* found = channels.findChannel(channel);
      if (found == nullptr || found->xSampling != 1 || found->ySampling != 1)
        throw Error(name, "header", "the EXR has neither the channels R, G and B nor Y");
      if (is_grey && c > 0) break;
      Imf::Slice slice = slice_of(image, c);
      slice.base -= window.min.x * static_cast<std::ptrdiff_t>(slice.xStride) +
                    window.min.y * static_cast<std::ptrdiff_t>(slice.yStride);
      frame.insert(channel, slice);
    }
    in.setFrameBuffer(frame);
    in.readPixels(window.min.y, window.max.y);
    if (is_grey)
      for (std::size_t i = 0; i < image.pixels.size(); i += 3)
        image.pixels[i + 1] = image.pixels[i + 2] = image.pixels[i];
    return image;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(name, "", std::string("cannot read: ") + e.what());
  }
}

}  // namespace voxdag
