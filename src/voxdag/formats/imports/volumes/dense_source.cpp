#include "voxdag/formats/imports/volumes/dense_source.hpp"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "voxdag/core/error.hpp"
#include "voxdag/core/with_file_name.hpp"
#include "voxdag/formats/imports/channels/channel_request.hpp"
#include "voxdag/formats/imports/value_type.hpp"
#include "voxdag/formats/imports/volumes/gzip_stream.hpp"

namespace voxdag {
namespace {

/// Reads numbers from a byte of a file to its end. All functions throw Error with the byte.
class TextValues {
 public:
  /// The text must outlive this.
  TextValues(std::filesystem::path path, std::string_view text, std::uint64_t begin)
      : path_(std::move(path)), text_(text), at_(begin) {}

  /// Fills the span with numbers of a type, in the byte order of the machine. They are decimal and
  /// stand between white space or commas.
  void fill_decimal(ValueType type, std::span<std::byte> bytes);
  /// Fills the span with bytes of two hexadecimal digits each.
  void fill_hex(std::span<std::byte> bytes);
  /// Throws if there is more than white space.
  void expect_end();

 private:
  void skip_spaces();
  [[noreturn]] void fail(const std::string& reason) const;

  std::filesystem::path path_;
  std::string_view text_;
  std::uint64_t at_;
};

bool separates(char c) { return c == ' ' || c == ',' || (c >= '\t' && c <= '\r'); }

void TextValues::fill_decimal(ValueType type, std::span<std::byte> bytes) {
  with_type(type, [&]<class T>(T zero) {
    // No format has texts of these.
    if constexpr (std::is_same_v<T, Half>)
      fail("has a type that is not written as text");
    else
      for (std::size_t i = 0; i < bytes.size(); i += sizeof zero) {
        skip_spaces();
        if (at_ < text_.size() && text_[at_] == '+') ++at_;
        const char* const begin = text_.data() + at_;
        const char* const end = text_.data() + text_.size();
        auto value = zero;
        const auto [next, error] = std::from_chars(begin, end, value);
        if (begin == end) fail("truncated: the volume has more values than the file");
        if (error != std::errc() || (next != end && !separates(*next)))
          fail("is not a number of the volume's type");
        at_ += static_cast<std::uint64_t>(next - begin);
        std::memcpy(bytes.data() + i, &value, sizeof value);
      }
  });
}

void TextValues::fill_hex(std::span<std::byte> bytes) {
  for (std::byte& byte : bytes) {
    skip_spaces();
    std::uint8_t value = 0;
    const std::string_view digits = text_.substr(at_, 2);
    const char* const end = digits.data() + digits.size();
    if (digits.size() < 2) fail("truncated: the volume has more values than the file");
    const auto [next, error] = std::from_chars(digits.data(), end, value, 16);
    if (error != std::errc() || next != end) fail("is not a byte of two hexadecimal digits");
    at_ += 2;
    byte = static_cast<std::byte>(value);
  }
}

void TextValues::expect_end() {
  skip_spaces();
  if (at_ < text_.size()) fail("has more values than the volume");
}

void TextValues::skip_spaces() {
  while (at_ < text_.size() && separates(text_[at_])) ++at_;
}

void TextValues::fail(const std::string& reason) const {
  throw Error(path_.string(), ErrorPlace::byte(at_), reason);
}

class DenseSource : public VoxelSource {
 public:
  explicit DenseSource(DenseFile file) : file_(std::move(file)) {
    if (file_.begin > file_.data.text().size())
      throw Error(file_.path.string(), ErrorPlace::byte(file_.data.text().size()),
                  "truncated: the data begin at byte " + std::to_string(file_.begin));
    if (is_raw()) check_length();
    if (file_.encoding == Encoding::kSlices && slice_bytes() >= kMaxSliceBytes)
      throw Error(file_.path.string(), "header", "a slice has more than a GiB");
    file_.volume.has_values = !file_.channels.empty();
    const std::string wanted = file_.volume.has_labels ? "labels" : "channels";
    if ((file_.volume.has_labels || file_.volume.has_values) &&
        (file_.volume.channels > 1 || file_.volume.repeats > 1))
      throw Error(file_.path.string(), "header",
                  file_.volume.has_colors()
                      ? "holds colours, not " + wanted
                      : "holds several layers, and " + wanted + " need one value for each voxel");
    with_file_name(file_.path.string(), [&] { check_value_requests(file_.channels); });
    if (file_.volume.channels == 4 && file_.volume.has_colors())
      with_bytes([&](const FillBytes& fill) {
        file_.volume.has_opaque_alpha = has_opaque_alpha(file_.volume, fill);
        return false;
      });
  }

  bool has_points() const override { return false; }
  bool has_colors() const override { return file_.volume.has_colors(); }
  bool has_labels() const override { return file_.volume.has_labels; }
  std::map<Label, std::string> label_names() const override { return file_.label_names; }
  std::vector<ChannelSpec> channels() const override {
    if (file_.channels.empty()) return {};
    const bool is_scaled = file_.volume.slope != 1 || file_.volume.intercept != 0;
    return {channel_spec(file_.channels[0],
                         is_scaled ? ChannelKind::kF32 : kind_of(file_.volume.type))};
  }
  std::optional<Grid> grid() const override { return file_.map.grid(); }
  bool has_place() const override { return file_.has_place; }
  std::vector<std::string> warnings() const override { return file_.warnings; }

  void visit_all(const VisitBatch& visit) const override {
    with_bytes([&](const FillBytes& fill) {
      visit_volume(file_.volume, fill,
                   [&](const VoxelBatch& batch) { file_.map.visit_cubes(batch, visit); });
      return true;
    });
  }

 private:
  bool is_raw() const {
    return file_.encoding == Encoding::kRaw || file_.encoding == Encoding::kPlanar;
  }
  std::string_view data() const { return file_.data.text().substr(file_.begin); }

  void check_length() {
    const std::uint64_t size = data().size(), needed = file_.volume.bytes();
    if (size < needed)
      throw Error(file_.path.string(), ErrorPlace::byte(file_.begin + size),
                  "truncated: the volume needs " + std::to_string(needed) + " bytes after byte " +
                      std::to_string(file_.begin) + ", the file has " + std::to_string(size));
    if (size > needed && !file_.may_have_more)
      file_.warnings.push_back("bytes after the volume are left out: " +
                               std::to_string(size - needed));
  }

  /// Calls read(fill), where fill() gives the bytes of the volume. If it returns true, it read all
  /// of them; then checks what follows.
  template <class Read>
  void with_bytes(const Read& read) const {
    switch (file_.encoding) {
      case Encoding::kRaw:
        return with_raw(read);
      case Encoding::kPlanar:
        return with_planar(read);
      case Encoding::kGzip:
        return with_gzip(read);
      case Encoding::kAscii:
      case Encoding::kHex:
        return with_text(read);
      case Encoding::kSlices:
        return with_slices(read);
    }
  }

  template <class Read>
  void with_raw(const Read& read) const {
    const char* next = data().data();
    read([&](std::span<std::byte> bytes) {
      std::memcpy(bytes.data(), next, bytes.size());
      next += bytes.size();
    });
  }

  /// Gathers the channels of each voxel.
  template <class Read>
  void with_planar(const Read& read) const {
    const auto channels = static_cast<std::uint64_t>(file_.volume.channels);
    const std::uint64_t plane = file_.volume.bytes() / channels;
    const char* next = data().data();
    read([&](std::span<std::byte> bytes) {
      for (std::size_t i = 0; i < bytes.size(); i += channels, ++next)
        for (std::size_t c = 0; c < channels; ++c)
          bytes[i + c] = static_cast<std::byte>(next[c * plane]);
    });
  }

  std::uint64_t slice_bytes() const {
    return file_.volume.size[0] * file_.volume.size[1] * file_.volume.voxel_bytes();
  }

  template <class Read>
  void with_slices(const Read& read) const {
    std::vector<std::byte> slice(static_cast<std::size_t>(slice_bytes()));
    std::size_t at = slice.size();
    std::uint64_t z = 0;
    read([&](std::span<std::byte> bytes) {
      while (!bytes.empty()) {
        if (at == slice.size()) {
          file_.read_slice(z++, slice);
          at = 0;
        }
        const std::size_t count = std::min(bytes.size(), slice.size() - at);
        std::copy_n(slice.data() + at, count, bytes.data());
        bytes = bytes.subspan(count);
        at += count;
      }
    });
  }

  template <class Read>
  void with_gzip(const Read& read) const {
    GzipStream stream(file_.path, file_.data.text(), file_.begin);
    stream.skip(file_.skipped);
    if (read([&](std::span<std::byte> bytes) { stream.fill(bytes); }) && !file_.may_have_more)
      stream.expect_end();
  }

  template <class Read>
  void with_text(const Read& read) const {
    TextValues values(file_.path, file_.data.text(), file_.begin);
    const auto fill = [&](std::span<std::byte> bytes) {
      if (file_.encoding == Encoding::kHex)
        values.fill_hex(bytes);
      else
        values.fill_decimal(file_.volume.type, bytes);
    };
    if (read(fill)) values.expect_end();
  }

  DenseFile file_;
};

}  // namespace

std::unique_ptr<VoxelSource> make_dense_source(DenseFile file) {
  return std::make_unique<DenseSource>(std::move(file));
}

}  // namespace voxdag
