#include "voxdag/image/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>

#include <set>
#include <span>

#include "voxdag/core/error.hpp"
#include "voxdag/image/image_file.hpp"
#include "voxdag/io/atomic_file.hpp"

namespace voxdag {
namespace {

/// Where OpenEXR finds channel `c` of an interleaved image whose first pixel is (x0, y0).
Imf::Slice slice_of(ImageF& image, std::size_t c, int x0, int y0) {
  const std::size_t pixel = sizeof(float) * static_cast<std::size_t>(image.channels);
  const std::size_t row = pixel * static_cast<std::size_t>(image.width);
  // OpenEXR adds x * pixel + y * row to the base, with x and y counted from the window's origin.
  char* base = reinterpret_cast<char*>(image.pixels.data() + c) -
               static_cast<std::ptrdiff_t>(x0) * static_cast<std::ptrdiff_t>(pixel) -
               static_cast<std::ptrdiff_t>(y0) * static_cast<std::ptrdiff_t>(row);
  return Imf::Slice(Imf::FLOAT, base, pixel, row);
}

void require_writable(const std::string& file, const ImageF& image,
                      const std::vector<std::string>& names) {
  const auto fail = [&](const char* why) {
    throw Error(file, "", std::string("cannot write: ") + why);
  };
  if (image.width <= 0 || image.height <= 0 || image.channels <= 0 ||
      image.pixels.size() != ImageF(image.width, image.height, image.channels).pixels.size())
    fail("the image has no pixels or the wrong number");
  const std::set<std::string> distinct(names.begin(), names.end());
  if (names.size() != static_cast<std::size_t>(image.channels) || distinct.size() != names.size() ||
      distinct.count("") != 0)
    fail("channel names must be distinct, not empty and one for each channel");
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
      // Slices are of mutable memory even where OpenEXR only reads.
      frame.insert(channel_names[c], slice_of(const_cast<ImageF&>(image), c, 0, 0));
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

ExrImage read_exr(const std::filesystem::path& path) {
  const std::string file = path.string();
  const MappedFile mapping = map_image(path);
  const std::span<const std::uint8_t> bytes = encoded_bytes(mapping);
  if (bytes.size() < 4 || bytes[0] != 0x76 || bytes[1] != 0x2F || bytes[2] != 0x31 || bytes[3] != 1)
    throw Error(file, "byte 0", "not an OpenEXR file");
  try {
    Imf::StdISStream stream;
    stream.str(std::string(bytes.begin(), bytes.end()));
    Imf::InputFile in(stream);
    if (!in.isComplete()) throw Error(file, "", "the OpenEXR file is truncated");
    const Imath::Box2i window = in.header().dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;

    ExrImage exr;
    const Imf::ChannelList& channels = in.header().channels();
    for (auto c = channels.begin(); c != channels.end(); ++c) {
      if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
        throw Error(file, "header", std::string("channel ") + c.name() + " is subsampled");
      exr.channel_names.emplace_back(c.name());
    }
    const std::uint64_t samples = static_cast<std::uint64_t>(width) *
                                  static_cast<std::uint64_t>(height) * exr.channel_names.size();
    if (width > 1 << 24 || height > 1 << 24 || exr.channel_names.size() > 1024 ||
        samples > kMaxImagePixels * 4)
      throw Error(file, "header",
                  "absurd size " + std::to_string(width) + " x " + std::to_string(height));
    exr.image = ImageF(static_cast<int>(width), static_cast<int>(height),
                       static_cast<int>(exr.channel_names.size()));
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < exr.channel_names.size(); ++c)
      frame.insert(exr.channel_names[c], slice_of(exr.image, c, window.min.x, window.min.y));
    in.setFrameBuffer(frame);
    in.readPixels(window.min.y, window.max.y);
    return exr;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    throw Error(file, "", std::string("damaged OpenEXR file: ") + e.what());
  }
}

}  // namespace voxdag
