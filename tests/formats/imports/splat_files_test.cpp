// Splats of .spz and .sog against values computed from the definitions, those of texts and .splat
// against the DAG of the PLY file with the same splats.
#include <webp/encode.h>

#include <cmath>
#include <random>

#include "raw_splats.hpp"
#include "support/error_of.hpp"
#include "volume_files.hpp"
#include "voxdag/formats/exports/zip_file.hpp"

namespace voxdag {
namespace {

void add_little(std::string& bytes, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> 8 * i);
}

/// Returns a frame of Zstandard: one block that is stored as it is.
std::string zstd_of(const std::string& bytes) {
  std::string frame;
  add_little(frame, 0xFD2FB528, 4);
  add_little(frame, 0xA0, 1);
  add_little(frame, bytes.size(), 4);
  add_little(frame, 1 | bytes.size() << 3, 3);
  return frame + bytes;
}

/// Returns what a file of version 4 has after its 15th byte: the number of streams, where their
/// table is, the table, and the streams of the arrays that are not empty.
std::string spz_streams(const std::vector<std::string>& arrays) {
  std::string head, table, streams;
  for (const std::string& array : arrays) {
    if (array.empty()) continue;
    const std::string packed = zstd_of(array);
    add_little(table, packed.size(), 8);
    add_little(table, array.size(), 8);
    streams += packed;
  }
  add_little(head, table.size() / 16, 1);
  add_little(head, 32, 4);
  head += std::string(12, '\0');
  return head + table + streams;
}

/// What a file says of a splat.
struct PlainSplat {
  Vec3d center;
  std::array<double, 3> log_scale, color;  ///< The colour from 0 to 1.
  std::array<double, 4> rotation;          ///< w, x, y, z
  double alpha;
};

class SplatFiles : public VolumeTest {
 protected:
  std::uint32_t random(std::uint32_t below) { return static_cast<std::uint32_t>(rng_() % below); }

  /// Returns a unit quaternion whose part `greatest` is left out.
  static std::array<double, 4> complete(const std::vector<double>& parts, std::size_t greatest) {
    std::array<double, 4> rotation{};
    double squares = 0;
    for (std::size_t i = 0, next = 0; i < 4; ++i)
      if (i != greatest) {
        rotation[i] = parts[next++];
        squares += rotation[i] * rotation[i];
      }
    rotation[greatest] = std::sqrt(std::max(0.0, 1 - squares));
    return rotation;
  }

  void expect(const std::string& name, const std::vector<PlainSplat>& splats) const {
    std::size_t i = 0;
    open(name)->visit_all([&](const VoxelBatch& batch) {
      ASSERT_EQ(batch.places.size(), batch.splats.size());
      for (std::size_t k = 0; k < batch.places.size(); ++k, ++i) {
        ASSERT_LT(i, splats.size());
        const PlainSplat& want = splats[i];
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_NEAR(batch.places[k][axis], want.center[axis],
                      1e-9 * (1 + std::abs(want.center[axis])));
        for (std::size_t c = 0; c < 3; ++c) {
          const auto scale = static_cast<double>(batch.splats[k].scale[c]);
          EXPECT_NEAR(std::log(scale), want.log_scale[c], 1e-5);
          const Rgb8 channels = batch.colors[k];
          EXPECT_NEAR(channels[c], std::clamp(want.color[c], 0.0, 1.0) * 255, 0.5001);
        }
        for (std::size_t c = 0; c < 4; ++c)
          EXPECT_NEAR(static_cast<double>(batch.splats[k].rotation[c]), want.rotation[c], 1e-6);
        EXPECT_NEAR(static_cast<double>(batch.splats[k].extinction),
                    -std::log1p(-std::min(want.alpha, 0.99)), 1e-5);
      }
    });
    EXPECT_EQ(i, splats.size());
  }

  std::mt19937 rng_{5};
};

/// Returns a file and its splats.
TEST_F(SplatFiles, SpzIsRead) {
  for (const std::uint32_t version : {2u, 3u, 4u})
    for (const std::uint32_t degree : {0u, 3u}) {
      constexpr std::uint32_t kCount = 50, kBits = 12;
      std::string places, alphas, colors, scales, rotations;
      std::vector<PlainSplat> splats;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        PlainSplat splat{};
        for (int axis = 0; axis < 3; ++axis) {
          const int fixed = static_cast<int>(random(1 << 24)) - (1 << 23);
          add_little(places, static_cast<std::uint32_t>(fixed), 3);
          splat.center[axis] = fixed / double{1 << kBits};
        }
        const std::uint32_t alpha = random(256);
        add_little(alphas, alpha, 1);
        splat.alpha = alpha / 255.0;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::uint32_t color = random(256), scale = random(256);
          add_little(colors, color, 1);
          add_little(scales, scale, 1);
          splat.color[c] = 0.5 + 0.28209479177387814 * (color / 255.0 - 0.5) / 0.15;
          splat.log_scale[c] = scale / 16.0 - 10;
        }
        std::array<double, 4> xyzw{};
        if (version >= 3) {
          const std::uint32_t greatest = random(4);
          std::uint32_t word = greatest << 30;
          std::vector<double> parts;
          for (int k = 2; k >= 0; --k) {
            const std::uint32_t size = random(512), sign = random(2);
            word |= (size | sign << 9) << (10 * k);
            parts.push_back((sign != 0 ? -1 : 1) * (size / 511.0) * std::sqrt(0.5));
          }
          add_little(rotations, word, 4);
          xyzw = complete(parts, greatest);
        } else {
          std::vector<double> parts;
          for (int k = 0; k < 3; ++k) {
            const std::uint32_t part = random(256);
            add_little(rotations, part, 1);
            parts.push_back(part / 127.5 - 1);
          }
          xyzw = complete(parts, 3);
        }
        splat.rotation = {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
        splats.push_back(splat);
      }
      const std::string harmonics(kCount * (degree == 3 ? 45 : 0), 'h');
      std::string bytes = "NGSP";
      add_little(bytes, version, 4);
      add_little(bytes, kCount, 4);
      add_little(bytes, degree | kBits << 8, 3);
      if (version < 4) {
        bytes += '\0' + places + alphas + colors + scales + rotations + harmonics;
      } else {
        bytes += spz_streams({places, alphas, colors, scales, rotations, harmonics});
      }
      write("s.spz", bytes);
      expect("s.spz", splats);
      const auto error = [&](const std::string& of) {
        write("s.spz", of);
        return error_of([&] { open("s.spz"); });
      };
      // Nothing reads the harmonics of version 4.
      const std::size_t least = version < 4 || degree == 0 ? bytes.size() : 32;
      for (std::size_t size = 0; size < least; ++size)
        EXPECT_NE(error(bytes.substr(0, size)), "no error") << size;
      bytes[4] = 5;
      EXPECT_TRUE(has(error(bytes), "version 5"));
    }
}

std::string webp_of(const std::vector<std::uint8_t>& rgba, int width, int height) {
  std::uint8_t* out = nullptr;
  const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), width, height, 4 * width, &out);
  std::string bytes(reinterpret_cast<const char*>(out), size);
  WebPFree(out);
  return bytes;
}

TEST_F(SplatFiles, SogIsRead) {
  constexpr int kWidth = 8, kHeight = 5;
  constexpr std::size_t kCount = 37;  // the last pixels stand for nothing
  // Alpha of 255 wherever no value is: lossless WebP may drop the colours of clear pixels.
  std::array<std::vector<std::uint8_t>, 5> images;
  for (std::vector<std::uint8_t>& image : images) image.resize(4 * kWidth * kHeight, 255);
  std::string scale_book, color_book;
  std::vector<double> scale_values, color_values;
  for (int i = 0; i < 256; ++i) {
    scale_values.push_back(-6 + i / 32.0);
    color_values.push_back(-2 + i / 64.0);
    scale_book += (i > 0 ? "," : "") + std::to_string(scale_values.back());
    color_book += (i > 0 ? "," : "") + std::to_string(color_values.back());
  }
  std::vector<PlainSplat> splats;
  for (std::size_t i = 0; i < kCount; ++i) {
    PlainSplat splat{};
    const auto at = [&](std::size_t image, std::size_t channel) -> std::uint8_t& {
      return images[image][4 * i + channel];
    };
    std::vector<double> parts;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t place = random(65536);
      at(0, c) = static_cast<std::uint8_t>(place);
      at(1, c) = static_cast<std::uint8_t>(place >> 8);
      const double logarithm = -3 + place / 65535.0 * 7;
      splat.center[static_cast<int>(c)] =
          (logarithm < 0 ? -1 : 1) * (std::exp(std::abs(logarithm)) - 1);
      at(2, c) = static_cast<std::uint8_t>(random(256));
      splat.log_scale[c] = scale_values[at(2, c)];
      at(3, c) = static_cast<std::uint8_t>(random(256));
      parts.push_back((at(3, c) / 255.0 - 0.5) * std::sqrt(2.0));
      at(4, c) = static_cast<std::uint8_t>(random(256));
      splat.color[c] = 0.5 + 0.28209479177387814 * color_values[at(4, c)];
    }
    const std::uint32_t greatest = random(4);
    at(3, 3) = static_cast<std::uint8_t>(252 + greatest);
    splat.rotation = complete(parts, greatest);
    at(4, 3) = static_cast<std::uint8_t>(1 + random(255));
    splat.alpha = at(4, 3) / 255.0;
    splats.push_back(splat);
  }
  const auto meta = [&](const std::string& start) {
    return "{" + start +
           R"("means":{"mins":[-3,-3,-3],"maxs":[4,4,4],"files":["l.webp","u.webp"]},)"
           R"("scales":{"codebook":[)" +
           scale_book +
           R"(],"files":["s.webp"]},"quats":{"files":["q.webp"]},"sh0":{"codebook":[)" +
           color_book + R"(],"files":["c.webp"]}})";
  };
  const auto write_sog = [&](const std::string& text, std::size_t files = 5) {
    std::filesystem::remove(path("s.sog"));
    ZipFile zip(path("s.sog"));
    const auto add = [&](const std::string& name, const std::string& bytes) {
      zip.begin(name.c_str());
      zip.write(bytes);
    };
    add("meta.json", text);
    const char* const names[] = {"l.webp", "u.webp", "s.webp", "q.webp", "c.webp"};
    for (std::size_t i = 0; i < files; ++i) add(names[i], webp_of(images[i], kWidth, kHeight));
    zip.commit();
  };
  write_sog(meta(R"("version":2,"count":37,)"));
  expect("s.sog", splats);
  const auto error = [&] { return error_of([&] { import("s.sog"); }); };
  write_sog(meta(R"("version":2,"count":41,)"));
  EXPECT_TRUE(has(error(), "less pixels than the 41 splats")) << error();
  write_sog(meta(R"("version":1,"count":37,)"));
  EXPECT_TRUE(has(error(), "another version than 2")) << error();
  write_sog(meta(R"("version":2,"count":37,)"), 4);
  EXPECT_TRUE(has(error(), "has no 'c.webp'")) << error();
  write_sog("{}");
  EXPECT_TRUE(has(error(), "meta.json: is damaged")) << error();
}

TEST_F(SplatsTest, TextsAndSplatFilesAreRead) {
  const std::vector<RawSplat> splats = random_splats(60, 10, 1.5, 12);
  ImportOptions with = options();
  with.resolution = 40;
  EXPECT_EQ(import(ply_of(splats, true), with).dag, import(ply_of(splats), with).dag);
  // A .splat file has rounded colours and rotations.
  std::string bytes;
  std::vector<RawSplat> rounded;
  for (RawSplat s : splats) {
    const auto byte = [](double value) {
      return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0l, 255l));
    };
    for (const float value : s.center)
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    for (const float value : s.log_scale) {
      const auto scale = static_cast<float>(std::exp(double{value}));
      bytes.append(reinterpret_cast<const char*>(&scale), sizeof scale);
    }
    for (const float value : s.color)
      bytes.push_back(static_cast<char>(byte(255 * (0.5 + 0.28209479177387814 * double{value}))));
    const std::uint8_t alpha = byte(255 / (1 + std::exp(-double{s.opacity})));
    bytes.push_back(static_cast<char>(alpha));
    s.opacity = static_cast<float>(std::log(alpha / 255.0) - std::log1p(-alpha / 255.0));
    for (float& part : s.rotation) {
      const std::uint8_t q = byte(part * 64 + 128);
      bytes.push_back(static_cast<char>(q));
      part = static_cast<float>(q - 128);
    }
    rounded.push_back(s);
  }
  with.splats.opacity = 0.2;
  const ImportResult result = import_voxels(*open(bytes, "s.splat"), with);
  EXPECT_EQ(result.dag, import(ply_of(rounded), with).dag);
  EXPECT_NE(error_of([&] { open(bytes.substr(1), "s.splat"); }).find("inside a record"),
            std::string::npos);
}

}  // namespace
}  // namespace voxdag
