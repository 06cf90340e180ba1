#include <algorithm>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/channels/channel_request.hpp"
#include "voxdag/formats/imports/labels/label_value.hpp"
#include "voxdag/formats/imports/volumes/dense_volume.hpp"
#include "voxdag/formats/imports/volumes/slice_files.hpp"
#include "voxdag/formats/imports/volumes/value_test.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"
#include "voxdag/image/image_limits.hpp"
#include "voxdag/image/png.hpp"

namespace voxdag {
namespace {

/// The byte of a PNG file that has the bits of a value.
constexpr std::size_t kBitDepth = 24;

bool is_png(const std::string& name) { return lower_case(name).ends_with(".png"); }

class PngSlices : public VoxelSource {
 public:
  PngSlices(std::filesystem::path folder, std::optional<double> threshold, bool numbered,
            bool has_labels, const std::vector<ChannelRequest>& channels)
      : folder_(std::move(folder)),
        names_(names_of_slices(folder_, is_png)),
        numbered_(numbered),
        threshold_(threshold),
        has_labels_(has_labels) {
    if (names_.empty()) throw Error(folder_.string(), "", "the folder has no .png files");
    check_value_requests(channels);
    has_values_ = !channels.empty();
    const DecodedImage first = decode(names_[0]);
    width_ = first.width();
    height_ = first.height();
    has_colors_ = first.channels() >= 3;
    for (const ChannelRequest& channel : channels)
      channels_.push_back(
          channel_spec(channel, has_8_bits(first) ? ChannelKind::kU8 : ChannelKind::kU16));
    const VolumeSize size{static_cast<std::uint64_t>(width_), static_cast<std::uint64_t>(height_),
                          place_of(names_.size() - 1) + 1};
    check_volume_size(folder_, size);
    grid_.levels = levels_of(size);
    if (first.channels() == 4) has_opaque_alpha_ = are_opaque();
  }

  bool has_points() const override { return false; }
  bool has_colors() const override { return has_colors_; }
  bool has_labels() const override { return has_labels_; }
  std::vector<ChannelSpec> channels() const override { return channels_; }
  std::optional<Grid> grid() const override { return grid_; }
  std::vector<std::string> warnings() const override {
    const std::string missing = numbered_ ? "" : missing_slices(names_);
    if (missing.empty()) return {};
    return {missing};
  }

  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels voxels(visit);
    for (std::size_t z = 0; z < names_.size(); ++z) {
      const DecodedImage image = decode(names_[z]);
      check(image, names_[z]);
      if (threshold_)
        visit_slice(image, place_of(z), IsAtLeast<std::uint16_t>(*threshold_), voxels);
      else
        visit_slice(image, place_of(z), IsNotZero<std::uint16_t>(), voxels);
    }
    voxels.finish();
  }

 private:
  DecodedImage decode(const std::string& name) const {
    const std::filesystem::path path = folder_ / name;
    const MappedFile mapping(path, MappedFile::Access::kSequential, kMaxImageFile);
    const std::span<const std::byte> bytes = mapping.bytes();
    DecodedImage image = decode_png(
        {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, path.string());
    if (!has_labels_ && !has_values_) return image;
    const std::string wanted = has_labels_ ? "labels" : "channels";
    if (image.channels() >= 3) throw Error(path.string(), "header", "holds colours, not " + wanted);
    // libpng has spread fewer bits over 0 to 255.
    if (const int bits = std::to_integer<int>(bytes[kBitDepth]); bits < 8)
      throw Error(
          path.string(), "header",
          "has grey values of " + std::to_string(bits) + " bits, and " + wanted + " need 8 or 16");
    return image;
  }

  void check(const DecodedImage& image, const std::string& name) const {
    const auto fail = [&](const std::string& reason) {
      throw Error((folder_ / name).string(), "header", reason);
    };
    if (image.width() != width_ || image.height() != height_)
      fail("has " + std::to_string(image.width()) + " x " + std::to_string(image.height()) +
           " pixels; the first slice has " + std::to_string(width_) + " x " +
           std::to_string(height_));
    if (image.channels() >= 3 && !has_colors_) fail("has colours; the first slice is grey");
  }

  /// Returns whether no pixel is transparent. Reads until one is.
  bool are_opaque() const {
    return std::all_of(names_.begin(), names_.end(), [&](const std::string& name) {
      const DecodedImage image = decode(name);
      for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
          if (image.pixel(x, y)[3] != 65535) return false;
      return true;
    });
  }

  /// Returns the place of a slice along z.
  std::uint64_t place_of(std::size_t slice) const {
    if (!numbered_) return slice;
    const std::optional<std::int64_t> number = last_number(names_[slice]);
    if (!number)
      throw Error((folder_ / names_[slice]).string(), "", "has no number that tells its place");
    return static_cast<std::uint64_t>(*number);
  }

  template <class Test>
  void visit_slice(const DecodedImage& image, std::uint64_t z, const Test& is_set,
                   BatchedVoxels& voxels) const {
    const int channels = image.channels();
    const int unit = has_8_bits(image) ? 257 : 1;  // pixel() multiplies values of 8 bits by 257.
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const DecodedImage::Rgba pixel = image.pixel(x, y);
        if (channels == 2 && pixel[3] == 0) continue;
        const std::uint16_t value = channels == 4 && !has_opaque_alpha_
                                        ? pixel[3]
                                        : std::max({pixel[0], pixel[1], pixel[2]});
        const auto number = static_cast<std::uint16_t>(value / unit);
        if (!is_set(number)) continue;
        if (has_labels_) voxels.add_label(number);
        if (has_values_) voxels.add_channel(number);
        const Vec3d place{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        if (has_colors_)
          voxels.add(place, {to_8_bits(pixel[0]), to_8_bits(pixel[1]), to_8_bits(pixel[2])});
        else
          voxels.add(place);
      }
  }

  static bool has_8_bits(const DecodedImage& image) {
    return image.row_bytes() ==
           static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.channels());
  }
  static std::uint8_t to_8_bits(std::uint16_t value) {
    return static_cast<std::uint8_t>((value + 128) / 257);
  }

  std::filesystem::path folder_;
  std::vector<std::string> names_;
  bool numbered_;
  std::optional<double> threshold_;
  bool has_labels_, has_values_ = false;
  std::vector<ChannelSpec> channels_;
  int width_ = 0, height_ = 0;
  bool has_colors_ = false;
  bool has_opaque_alpha_ = false;  ///< Programs save slices with an alpha that says nothing.
  Grid grid_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_png_slices(const std::filesystem::path& folder,
                                             std::optional<double> threshold, bool numbered,
                                             const LabelRequest& labels,
                                             const std::vector<ChannelRequest>& channels) {
  return std::make_unique<PngSlices>(folder, threshold, numbered, wants_labels(labels), channels);
}

}  // namespace voxdag
