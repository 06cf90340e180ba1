/// Reads the .sog files of PlayCanvas: archives of images whose pixels are splats.
///
/// Source: PlayCanvas, "The SOG Format", version 2.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/printable.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/imports/points/splat_source.hpp"
#include "voxdag/formats/readers/ply/ply_color.hpp"
#include "voxdag/formats/readers/threemf/zip_part.hpp"
#include "voxdag/image/image_limits.hpp"
#include "voxdag/image/webp.hpp"

namespace voxdag {
namespace {

using Json = nlohmann::json;

class SogSplats final : public SplatSource {
 public:
  SogSplats(const std::filesystem::path& path, bool splats_are_points, const Work& work)
      : SplatSource(splats_are_points),
        file_(path, MappedFile::Access::kRandom),
        source_{file_.text(), path.string(), {}, &file_, {}} {
    source_.options.work = work;
    try {
      read_header();
    } catch (const Json::exception&) {
      throw Error(path.string(), "meta.json", "is damaged, or not of version 2 of SOG");
    }
  }

  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels splats(visit);
    for (std::uint64_t i = 0; i < count_; ++i) {
      const Pixel low = pixel(kLow, i), high = pixel(kHigh, i), color = pixel(kColor, i);
      if (has_splats()) {
        const Pixel scale = pixel(kScale, i), turn = pixel(kTurn, i);
        if (turn[3] < 252)
          throw Error(source_.name, "quats", "splat " + std::to_string(i) + " has no rotation");
        const auto part = [&](std::size_t c) { return (turn[c] / 255.0 - 0.5) * std::sqrt(2.0); };
        Splat splat =
            splat_of_logarithms(rotation_of_three({part(0), part(1), part(2)}, turn[3] - 252u),
                                {scales_[scale[0]], scales_[scale[1]], scales_[scale[2]]}, 0);
        splat.extinction = extinction_of(color[3] / 255.0);
        splats.add_splat(splat);
      }
      const auto coordinate = [&](int axis) {
        const auto c = static_cast<std::size_t>(axis);
        const double t = (high[c] << 8 | low[c]) / 65535.0;
        const double logarithm = least_[axis] * (1 - t) + most_[axis] * t;
        return std::copysign(std::expm1(std::abs(logarithm)), logarithm);
      };
      const auto channel = [&](std::size_t c) {
        return color_byte(kSplatMiddle + kHarmonic * static_cast<double>(colors_[color[c]]));
      };
      splats.add({coordinate(0), coordinate(1), coordinate(2)},
                 {channel(0), channel(1), channel(2)});
    }
    splats.finish();
  }

 private:
  using Pixel = std::array<std::uint8_t, 4>;
  enum Image : std::size_t { kLow, kHigh, kScale, kTurn, kColor };

  void read_header() {
    std::string text;
    constexpr std::size_t kMost = 1 << 20;
    const bool is_found = read_zip_part(source_, "meta.json", [&](std::string_view part) {
      if (text.size() + part.size() > kMost) throw Error(source_.name, "meta.json", "is too long");
      text += part;
    });
    if (!is_found) throw source_.error("has no meta.json: it is no file of SOG");
    const Json meta = Json::parse(text);
    if (meta.at("version").get<int>() != 2)
      throw Error(source_.name, "meta.json",
                  "has another version than 2: splat-transform IN OUT.ply converts it");
    count_ = meta.at("count").get<std::uint64_t>();
    const Json &means = meta.at("means"), &scales = meta.at("scales"), &colors = meta.at("sh0");
    for (int axis = 0; axis < 3; ++axis) {
      least_[axis] = means.at("mins").at(static_cast<std::size_t>(axis)).get<double>();
      most_[axis] = means.at("maxs").at(static_cast<std::size_t>(axis)).get<double>();
    }
    scales_ = codebook(scales.at("codebook"));
    colors_ = codebook(colors.at("codebook"));
    read_image(kLow, means.at("files").at(0));
    read_image(kHigh, means.at("files").at(1));
    read_image(kScale, scales.at("files").at(0));
    read_image(kTurn, meta.at("quats").at("files").at(0));
    read_image(kColor, colors.at("files").at(0));
  }

  std::vector<float> codebook(const Json& values) const {
    auto book = values.get<std::vector<float>>();
    if (book.size() != 256)
      throw Error(source_.name, "meta.json", "has a codebook that has not 256 values");
    return book;
  }

  void read_image(Image image, const std::string& name) {
    std::vector<std::uint8_t> bytes;
    const bool is_found = read_zip_part(source_, name, [&](std::string_view part) {
      if (bytes.size() + part.size() > kMaxImageFile.bytes)
        throw Error(source_.name, printable(name), "is too large");
      bytes.insert(bytes.end(), part.begin(), part.end());
    });
    if (!is_found) throw source_.error("has no " + in_quotes(name));
    ImageOptions options;
    options.memory = source_.work().memory;
    images_[image] = decode_webp(bytes, source_.name + ": " + printable(name), options);
    const DecodedImage& decoded = images_[image];
    if (static_cast<std::uint64_t>(decoded.width()) * static_cast<std::uint64_t>(decoded.height()) <
        count_)
      throw Error(source_.name, printable(name),
                  "has less pixels than the " + std::to_string(count_) + " splats of meta.json");
  }

  Pixel pixel(Image image, std::uint64_t i) const {
    const DecodedImage& from = images_[image];
    const auto width = static_cast<std::uint64_t>(from.width());
    const auto channels = static_cast<std::size_t>(from.channels());
    const std::uint8_t* p = from.row(static_cast<int>(i / width)) + i % width * channels;
    return {p[0], p[1], p[2], channels == 4 ? p[3] : std::uint8_t{255}};
  }

  MappedFile file_;
  MeshSource source_;
  std::uint64_t count_ = 0;
  Vec3d least_, most_;  ///< Of the logarithms of coordinates.
  std::vector<float> scales_, colors_;
  std::array<DecodedImage, 5> images_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_sog(const std::filesystem::path& path, bool splats_are_points,
                                      const Work& work) {
  return std::make_unique<SogSplats>(path, splats_are_points, work);
}

}  // namespace voxdag
