/// Measures quality and speed of the encoders of attribute blocks: angles between normals and their
/// decoded values, signal-to-noise ratio of colours, microseconds per block.
///
///   attribute_codecs [TEXTURE.png|.jpg ...]
///
/// Normals are those of shapes, in the voxels of two sibling nodes. Colours are those on random
/// lines through the colour cube, and those of 4x4 pixels of the textures: all of them, and a
/// random half.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "voxdag/builders/esvo/encode/encode_color_block.hpp"
#include "voxdag/builders/esvo/encode/encode_normal_block.hpp"
#include "voxdag/image/decode.hpp"

namespace {

using namespace voxdag;

struct Block {
  std::array<Vec3f, kValuesPerBlock> values{};
  std::uint32_t used = 0;
};
using Blocks = std::vector<Block>;

constexpr int kBlocks = 20000;

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) / 16777216.0f; }

Vec3f direction(std::mt19937& random) {
  for (;;) {
    const Vec3f v{2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1};
    const float squared = dot(v, v);
    if (squared > 0.01f && squared < 1) return v * (1 / std::sqrt(squared));
  }
}

/// Returns the voxels of 4x2x2 around the origin that the surface of a shape meets, each with the
/// normal at its centre. The shape is given by its signed distance in voxels, negative inside.
Block voxels_of(const std::function<float(Vec3f)>& distance) {
  Block block;
  for (int i = 0; i < kValuesPerBlock; ++i) {
    const Vec3f center{static_cast<float>((i >> 3) * 2 + (i & 1)) - 1.5f,
                       static_cast<float>(i >> 1 & 1) - 0.5f,
                       static_cast<float>(i >> 2 & 1) - 0.5f};
    if (std::fabs(distance(center)) > 0.6f) continue;
    constexpr float h = 0.01f;
    const Vec3f gradient{distance(center + Vec3f{h, 0, 0}) - distance(center - Vec3f{h, 0, 0}),
                         distance(center + Vec3f{0, h, 0}) - distance(center - Vec3f{0, h, 0}),
                         distance(center + Vec3f{0, 0, h}) - distance(center - Vec3f{0, 0, h})};
    const float squared = dot(gradient, gradient);
    if (!(squared > 0)) continue;
    block.values[static_cast<std::size_t>(i)] = gradient * (1 / std::sqrt(squared));
    block.used |= 1u << i;
  }
  return block;
}

Blocks make(const std::function<Block(std::mt19937&)>& one) {
  std::mt19937 random(1);
  Blocks blocks;
  while (blocks.size() < kBlocks) {
    blocks.push_back(one(random));
    if (blocks.back().used == 0) blocks.pop_back();
  }
  return blocks;
}

Blocks spheres(float radius) {
  return make([radius](std::mt19937& random) {
    // In double, because the gradient of a large sphere is a difference of nearly equal numbers.
    const Vec3d center = Vec3d(direction(random)) * static_cast<double>(radius);
    Block block = voxels_of([center, radius](Vec3f p) {
      const Vec3d d = Vec3d(p) - center;
      return static_cast<float>(std::sqrt(dot(d, d)) - static_cast<double>(radius));
    });
    for (int i = 0; i < kValuesPerBlock; ++i)
      block.values[static_cast<std::size_t>(i)] = Vec3f(
          Vec3d{(i >> 3) * 2 + (i & 1) - 1.5, (i >> 1 & 1) - 0.5, (i >> 2 & 1) - 0.5} - center);
    return block;
  });
}

Blocks cylinders(float radius) {
  return make([radius](std::mt19937& random) {
    const Vec3f axis = direction(random), out = direction(random);
    const Vec3f side = cross(axis, out);
    const Vec3f center = side * (radius / std::sqrt(dot(side, side)));
    return voxels_of([axis, center, radius](Vec3f p) {
      const Vec3f d = p - center, across = d - axis * dot(d, axis);
      return std::sqrt(dot(across, across)) - radius;
    });
  });
}

/// Returns corners where `planes` planes of random directions meet.
Blocks corners(int planes) {
  return make([planes](std::mt19937& random) {
    std::vector<Vec3f> normals(static_cast<std::size_t>(planes));
    for (Vec3f& normal : normals) normal = direction(random);
    return voxels_of([normals](Vec3f p) {
      float nearest = -INFINITY;
      for (const Vec3f& n : normals) nearest = std::max(nearest, dot(n, p));
      return nearest;
    });
  });
}

/// Returns both sides of sheets that are bent by `bend` radians.
Blocks sheets(float bend) {
  return make([bend](std::mt19937& random) {
    const Vec3f n = direction(random);
    Block block;
    for (Vec3f& value : block.values) {
      const Vec3f v = n + direction(random) * bend;
      value = (random() & 1) != 0 ? v : -v;
    }
    block.used = static_cast<std::uint32_t>(random()) & random() & 0xFFFFu;
    return block;
  });
}

Blocks random_directions() {
  return make([](std::mt19937& random) {
    Block block;
    for (Vec3f& value : block.values) value = direction(random);
    block.used = static_cast<std::uint32_t>(random()) & 0xFFFFu;
    return block;
  });
}

/// Returns the CPU time of work() per block, in microseconds.
double microseconds_per_block(const Blocks& blocks, const std::function<void(const Block&)>& work) {
  double least = 1e30;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const std::clock_t start = std::clock();
    for (const Block& block : blocks) work(block);
    least = std::min(least, static_cast<double>(std::clock() - start) * 1e6 / CLOCKS_PER_SEC);
  }
  return least / static_cast<double>(blocks.size());
}

double used_per_block(const Blocks& blocks) {
  double used = 0;
  for (const Block& block : blocks) used += __builtin_popcount(block.used);
  return used / static_cast<double>(blocks.size());
}

void report_normals(const char* name, const Blocks& blocks) {
  std::uint32_t kept = 0;
  const double time = microseconds_per_block(blocks, [&kept](const Block& block) {
    kept ^= encode_normal_block(block.values, block.used).words[2];
  });
  std::vector<double> angles;
  for (const Block& block : blocks) {
    const NormalBlock encoded = encode_normal_block(block.values, block.used);
    for (int i = 0; i < kValuesPerBlock; ++i) {
      if ((block.used >> i & 1) == 0) continue;
      const Vec3d a(block.values[static_cast<std::size_t>(i)]), b(encoded.normal(i));
      const Vec3d c = cross(a, b);
      angles.push_back(std::atan2(std::sqrt(dot(c, c)), dot(a, b)) * 57.29577951308232);
    }
  }
  std::sort(angles.begin(), angles.end());
  double sum = 0;
  for (const double angle : angles) sum += angle;
  const auto count = static_cast<double>(angles.size());
  std::printf("%-34s %5.1f %11.5f %11.5f %11.5f %8.2f\n", name, used_per_block(blocks), sum / count,
              angles[static_cast<std::size_t>(0.99 * (count - 1))], angles.back(), time);
  if (kept == 1) std::puts("");
}

void report_colors(const std::string& name, const Blocks& blocks) {
  std::uint64_t kept = 0;
  const double time = microseconds_per_block(blocks, [&kept](const Block& block) {
    kept ^= encode_color_block(block.values, block.used).bits;
  });
  double sum = 0, count = 0;
  for (const Block& block : blocks) {
    const ColorBlock encoded = encode_color_block(block.values, block.used);
    for (int i = 0; i < kValuesPerBlock; ++i) {
      if ((block.used >> i & 1) == 0) continue;
      const Vec3d d = Vec3d(block.values[static_cast<std::size_t>(i)]) - Vec3d(encoded.color(i));
      sum += dot(d, d);
      count += 3;
    }
  }
  std::printf("%-34s %5.1f %11.2f %32.2f\n", name.c_str(), used_per_block(blocks),
              -10 * std::log10(sum / count), time);
  if (kept == 1) std::puts("");
}

Blocks lines(float noise) {
  return make([noise](std::mt19937& random) {
    Block block;
    const auto color = [&random] {
      return Vec3f{uniform(random), uniform(random), uniform(random)};
    };
    const Vec3f a = color(), b = a + (color() - a) * 0.5f;
    for (Vec3f& value : block.values)
      value = a + (b - a) * uniform(random) + direction(random) * noise;
    for (Vec3f& value : block.values) value = min(max(value, Vec3f{}), Vec3f{1, 1, 1});
    block.used = static_cast<std::uint32_t>(random()) & 0xFFFFu;
    return block;
  });
}

Blocks pixels(const DecodedImage& image, bool half) {
  std::mt19937 random(2);
  Blocks blocks;
  const int columns = image.width() / 4, rows = image.height() / 4;
  const int every = std::max(1, columns * rows / kBlocks);
  for (int at = 0; at < columns * rows; at += every) {
    Block block;
    for (int i = 0; i < kValuesPerBlock; ++i) {
      const DecodedImage::Rgba rgb =
          image.pixel(at % columns * 4 + i % 4, at / columns * 4 + i / 4);
      block.values[static_cast<std::size_t>(i)] =
          Vec3f{static_cast<float>(rgb[0]), static_cast<float>(rgb[1]),
                static_cast<float>(rgb[2])} *
          (1.0f / 65535.0f);
    }
    block.used = half ? static_cast<std::uint32_t>(random()) & 0xFFFFu : 0xFFFFu;
    if (block.used != 0) blocks.push_back(block);
  }
  return blocks;
}

}  // namespace

int main(int count, char** arguments) try {
  std::printf("%-34s %5s %11s %11s %11s %8s\n", "normals (degrees)", "used", "mean", "99 %", "max",
              "us");
  report_normals("plane", spheres(1e7f));
  report_normals("sphere of radius 1000 voxels", spheres(1000));
  report_normals("sphere of radius 100 voxels", spheres(100));
  report_normals("sphere of radius 20 voxels", spheres(20));
  report_normals("sphere of radius 5 voxels", spheres(5));
  report_normals("cylinder of radius 100 voxels", cylinders(100));
  report_normals("cylinder of radius 5 voxels", cylinders(5));
  report_normals("edge of two planes", corners(2));
  report_normals("corner of three planes", corners(3));
  report_normals("sheet, both sides", sheets(0));
  report_normals("sheet, both sides, bent by 0.2", sheets(0.2f));
  report_normals("random directions", random_directions());
  std::printf("\n%-34s %5s %11s %32s\n", "colours (sRGB)", "used", "PSNR (dB)", "us");
  report_colors("random lines", lines(0));
  report_colors("random lines with noise of 0.02", lines(0.02f));
  for (int i = 1; i < count; ++i) {
    const std::string file = arguments[i];
    const DecodedImage image = read_image(file);
    const std::string name = file.substr(file.find_last_of('/') + 1);
    report_colors(name, pixels(image, false));
    report_colors(name + ", half", pixels(image, true));
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
