/// Reads the .spz files of Niantic. Versions 1 to 3 are a header and arrays, which gzip has
/// unpacked. Version 4 has the arrays in streams of Zstandard, after a table of their sizes.
///
/// Source: Niantic, "spz".
#include <zstd.h>

#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"
#include "voxdag/formats/imports/points/load_value.hpp"
#include "voxdag/formats/imports/points/point_sources.hpp"
#include "voxdag/formats/imports/points/splat_source.hpp"
#include "voxdag/formats/imports/value_type.hpp"
#include "voxdag/formats/readers/ply/ply_color.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kSpzHeaderBytes = 16;

class SpzSplats final : public SplatSource {
 public:
  SpzSplats(const std::filesystem::path& path, bool splats_are_points, MemoryBudget* memory)
      : SplatSource(splats_are_points), file_(path, MappedFile::Access::kSequential) {
    const std::string_view bytes = file_.text();
    if (bytes.size() < kSpzHeaderBytes || !bytes.starts_with("NGSP"))
      throw Error(path.string(), ErrorPlace::byte(0), "is no file of spz");
    version_ = load_value<std::uint32_t>(bytes.data() + 4);
    count_ = load_value<std::uint32_t>(bytes.data() + 8);
    const auto degree = static_cast<std::uint8_t>(bytes[12]);
    fraction_bits_ = static_cast<std::uint8_t>(bytes[13]);
    if (version_ < 1 || version_ > 4)
      throw Error(path.string(), ErrorPlace::byte(4),
                  "has version " + std::to_string(version_) +
                      " of spz; 1 to 4 are read: splat-transform IN OUT.ply converts it");
    if (fraction_bits_ > 24 || degree > 4)
      throw Error(path.string(), ErrorPlace::byte(12), "its header is damaged");
    if (version_ == 4) {
      unpack_streams(path, memory);
      return;
    }
    const std::uint64_t harmonics = 3 * ((degree + 1u) * (degree + 1u) - 1);
    const std::uint64_t needed =
        kSpzHeaderBytes + count_ * (3 * place_bytes() + 7 + rotation_bytes() + harmonics);
    if (bytes.size() < needed)
      throw Error(path.string(), ErrorPlace::byte(bytes.size()),
                  "truncated: its splats need " + std::to_string(needed) + " bytes");
    arrays_ = bytes.data() + kSpzHeaderBytes;
  }

  void visit_all(const VisitBatch& visit) const override {
    BatchedVoxels splats(visit);
    const char* const places = arrays_;
    const char* const alphas = places + count_ * 3 * place_bytes();
    const char* const colors = alphas + count_;
    const char* const scales = colors + count_ * 3;
    const char* const rotations = scales + count_ * 3;
    const auto byte = [](const char* p) { return static_cast<std::uint8_t>(*p); };
    for (std::uint64_t i = 0; i < count_; ++i) {
      if (has_splats()) {
        const auto log_scale = [&](std::uint64_t axis) {
          return static_cast<float>(byte(scales + 3 * i + axis) / 16.0 - 10);
        };
        Splat splat = splat_of_logarithms(rotation(rotations + i * rotation_bytes()),
                                          {log_scale(0), log_scale(1), log_scale(2)}, 0);
        splat.extinction = extinction_of(byte(alphas + i) / 255.0);
        splats.add_splat(splat);
      }
      const auto color = [&](std::uint64_t channel) {
        const double harmonic = (byte(colors + 3 * i + channel) / 255.0 - 0.5) / 0.15;
        return color_byte(kSplatMiddle + kHarmonic * harmonic);
      };
      const char* const place = places + i * 3 * place_bytes();
      splats.add({coordinate(place), coordinate(place + place_bytes()),
                  coordinate(place + 2 * place_bytes())},
                 {color(0), color(1), color(2)});
    }
    splats.finish();
  }

 private:
  /// Unpacks the streams of all arrays but the harmonics.
  void unpack_streams(const std::filesystem::path& path, MemoryBudget* memory) {
    const std::string_view bytes = file_.text();
    const std::uint64_t streams = static_cast<std::uint8_t>(bytes[15]);
    const auto fail = [&](std::uint64_t at, const std::string& reason) {
      throw Error(path.string(), ErrorPlace::byte(at), reason);
    };
    if (bytes.size() < 32) fail(bytes.size(), "truncated: the file ends inside its header");
    const std::uint64_t table = load_value<std::uint32_t>(bytes.data() + 16);
    if (table < 32 || table > bytes.size() || (bytes.size() - table) / 16 < streams)
      fail(16, "truncated: its table of streams is not in the file");
    const std::uint64_t sizes[] = {count_ * 3 * place_bytes(), count_, count_ * 3, count_ * 3,
                                   count_ * rotation_bytes()};
    if (streams < std::size(sizes)) fail(15, "has too few streams");
    std::uint64_t total = 0, packed_at = table + 16 * streams;
    for (const std::uint64_t size : sizes) total += size;
    reserved_ = MemoryReservation(memory, total);
    unpacked_.resize(total);
    arrays_ = unpacked_.data();
    char* out = unpacked_.data();
    for (std::size_t i = 0; i < std::size(sizes); ++i) {
      const char* const entry = bytes.data() + table + 16 * i;
      const auto packed = load_value<std::uint64_t>(entry),
                 size = load_value<std::uint64_t>(entry + 8);
      if (packed > bytes.size() - packed_at)
        fail(bytes.size(), "truncated: the file ends inside stream " + std::to_string(i));
      if (size != sizes[i] || ZSTD_decompress(out, size, bytes.data() + packed_at, packed) != size)
        fail(packed_at, "stream " + std::to_string(i) + " is damaged");
      out += size;
      packed_at += packed;
    }
  }

  std::uint64_t place_bytes() const { return version_ == 1 ? 2 : 3; }
  std::uint64_t rotation_bytes() const { return version_ >= 3 ? 4 : 3; }

  double coordinate(const char* p) const {
    if (version_ == 1) return static_cast<double>(Half{load_value<std::uint16_t>(p)});
    const std::uint32_t word = load_value<std::uint16_t>(p) |
                               static_cast<std::uint32_t>(static_cast<std::uint8_t>(p[2])) << 16;
    // 24 bits with a sign.
    return std::ldexp(static_cast<std::int32_t>(word << 8) >> 8, -fraction_bits_);
  }

  /// Returns w, x, y, z. The file has x, y, z, w, of which it leaves out w or the greatest part.
  std::array<float, 4> rotation(const char* p) const {
    std::array<float, 4> xyzw;
    if (version_ >= 3) {
      const auto word = load_value<std::uint32_t>(p);
      const auto part = [&](int shift) {
        const double size = (word >> shift & 511u) / 511.0 * std::sqrt(0.5);
        return (word >> (shift + 9) & 1u) != 0 ? -size : size;
      };
      xyzw = rotation_of_three({part(20), part(10), part(0)}, word >> 30);
    } else {
      const auto part = [&](int i) { return static_cast<std::uint8_t>(p[i]) / 127.5 - 1; };
      xyzw = rotation_of_three({part(0), part(1), part(2)}, 3);
    }
    return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
  }

  MappedFile file_;
  MemoryReservation reserved_;
  std::vector<char> unpacked_;
  const char* arrays_ = nullptr;  ///< Places, opacities, colours, scales, rotations.
  std::uint32_t version_ = 0;
  std::uint64_t count_ = 0;
  int fraction_bits_ = 0;
};

}  // namespace

std::unique_ptr<VoxelSource> open_spz(const std::filesystem::path& path, bool splats_are_points,
                                      const Work& work) {
  return std::make_unique<SpzSplats>(path, splats_are_points, work.memory);
}

}  // namespace voxdag
