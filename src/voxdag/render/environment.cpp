#include "voxdag/render/environment.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

constexpr int kMostSide = 2048, kBuiltInSide = 256;
constexpr int kExponentBias = 128;  // of packed texels

std::size_t texel_count(int side) {
  return static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
}

/// Returns the direction at a place of [-1,1]² of the octahedral map, of unit length, and the solid
/// angle there per area of the map.
struct MapPlace {
  Vec3d direction;
  double density;
};
MapPlace place_at(double x, double y) {
  Vec3d on{x, 1 - std::fabs(x) - std::fabs(y), y};
  if (on.y < 0) {
    on.x = std::copysign(1 - std::fabs(y), x);
    on.z = std::copysign(1 - std::fabs(x), y);
  }
  const double distance = length(on);
  return {on * (1 / distance), 1 / (distance * distance * distance)};
}

/// Returns the picture's light from a direction, bilinearly.
Vec3f equirectangular(const ImageF& picture, Vec3d d) {
  const double across = std::atan2(d.x, -d.z) / (2 * std::numbers::pi) + 0.5;
  const double down = std::acos(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi;
  const double x = across * picture.width - 0.5, y = down * picture.height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const auto texel = [&](double column, double row) {
    const int wrapped = (static_cast<int>(column) + picture.width) % picture.width;
    const float* p =
        picture.pixel(wrapped, std::clamp(static_cast<int>(row), 0, picture.height - 1));
    return Vec3f{p[0], p[1], p[2]};
  };
  const auto u = static_cast<float>(x - left), v = static_cast<float>(y - top);
  return mix(mix(texel(left, top), texel(left + 1, top), u),
             mix(texel(left, top + 1), texel(left + 1, top + 1), u), v);
}

/// Returns an even side of about the picture's resolution.
int side_for(const ImageF& picture) {
  if (picture.width != 2 * picture.height || picture.channels != 3)
    throw Error("an environment must be twice as wide as high (equirectangular), not " +
                std::to_string(picture.width) + " x " + std::to_string(picture.height));
  return std::clamp(picture.height / 2 * 2, 16, kMostSide);
}

/// Calls body(place, i) for each texel i, one row after another.
template <class Body>
void for_texels(int side, const Body& body) {
  std::size_t i = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x, ++i)
      body(place_at((2 * x + 1.0) / side - 1, (2 * y + 1.0) / side - 1), i);
}

}  // namespace

Environment::Environment(const ImageF& picture)
    : Environment(side_for(picture), [&](Vec3f direction) {
        return equirectangular(picture, static_cast<Vec3d>(direction));
      }) {}

Environment::Environment(int side, const std::function<Vec3f(Vec3f)>& radiance) : side_(side) {
  sample(radiance);
  take_sun_out();
  find_light();
}

Environment::Environment(const PackedEnvironment& packed)
    : side_(packed.side),
      sun_irradiance_(packed.sun_irradiance),
      sun_direction_(packed.sun_direction) {
  const std::string& bytes = packed.texels;
  assert(bytes.size() == 4 * texel_count(side_));
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  for (std::size_t at = 0; at < bytes.size(); at += 4) {
    const float unit = std::ldexp(1.0f, byte(at + 3) - kExponentBias - 8);
    texels_.push_back(Vec3f{static_cast<float>(byte(at)), static_cast<float>(byte(at + 1)),
                            static_cast<float>(byte(at + 2))} *
                      unit);
  }
  find_light();
}

PackedEnvironment Environment::packed(int most_side) const {
  const Environment* from = this;
  Environment smaller;
  if (side_ > most_side) {
    smaller.side_ = most_side;
    smaller.sample([&](Vec3f direction) { return map_radiance(light_, direction); });
    from = &smaller;
  }
  PackedEnvironment packed{from->side_, {}, sun_irradiance_, sun_direction_};
  for (const Vec3f texel : from->texels_) {
    const float most = std::max({texel.x, texel.y, texel.z});
    int exponent = 0;
    std::frexp(most, &exponent);
    exponent = std::clamp(exponent, -kExponentBias, 255 - kExponentBias);
    // Rounding must not carry the largest part to 256.
    if (std::lround(std::ldexp(most, 8 - exponent)) > 255) ++exponent;
    for (int c = 0; c < 3; ++c)
      packed.texels += static_cast<char>(std::lround(std::ldexp(texel[c], 8 - exponent)));
    packed.texels += static_cast<char>(exponent + kExponentBias);
  }
  return packed;
}

void Environment::sample(const std::function<Vec3f(Vec3f)>& radiance) {
  const int side = side_;
  texels_.resize(texel_count(side));
  // Four by four samples a texel, so that a small sun keeps its light.
  constexpr int kSamples = 4;
  parallel_for(static_cast<std::size_t>(side), [&](std::size_t row) {
    for (int column = 0; column < side; ++column) {
      Vec3f sum;
      for (int i = 0; i < kSamples * kSamples; ++i) {
        const double x = column + (i % kSamples + 0.5) / kSamples;
        const double y = static_cast<double>(row) + (i / kSamples + 0.5) / kSamples;
        sum = sum +
              radiance(static_cast<Vec3f>(place_at(2 * x / side - 1, 2 * y / side - 1).direction));
      }
      texels_[row * static_cast<std::size_t>(side) + static_cast<std::size_t>(column)] =
          sum * (1.0f / (kSamples * kSamples));
    }
  });
}

void Environment::take_sun_out() {
  constexpr double kTimesMean = 20, kLeast = 0.1;
  const double kCosine = std::cos(10 * std::numbers::pi / 180);
  const double area = 4.0 / (static_cast<double>(side_) * side_);
  double sum = 0;
  std::size_t brightest = 0;
  for_texels(side_, [&](const MapPlace& place, std::size_t i) {
    const double bright = static_cast<double>(luminance(texels_[i]));
    sum += bright * place.density * area;
    if (luminance(texels_[i]) > luminance(texels_[brightest])) brightest = i;
  });
  const double mean = sum / (4 * std::numbers::pi);
  if (!(mean > 0)) throw Error("the environment is black");
  const auto side = static_cast<std::size_t>(side_);
  const Vec3d middle = place_at((2 * static_cast<double>(brightest % side) + 1) / side_ - 1,
                                (2 * static_cast<double>(brightest / side) + 1) / side_ - 1)
                           .direction;
  Vec3d light, towards;
  const auto part_of_sun = [&](const MapPlace& place, std::size_t i) {
    const double bright = static_cast<double>(luminance(texels_[i]));
    if (!(bright > kTimesMean * mean) || dot(place.direction, middle) < kCosine) return 0.0;
    return 1 - kTimesMean * mean / bright;
  };
  for_texels(side_, [&](const MapPlace& place, std::size_t i) {
    const Vec3d given =
        static_cast<Vec3d>(texels_[i]) * (part_of_sun(place, i) * place.density * area);
    light = light + given;
    towards = towards + place.direction * static_cast<double>(luminance(static_cast<Vec3f>(given)));
  });
  const double given = static_cast<double>(luminance(static_cast<Vec3f>(light)));
  if (given < kLeast * (sum - given)) return;
  for_texels(side_, [&](const MapPlace& place, std::size_t i) {
    texels_[i] = texels_[i] * static_cast<float>(1 - part_of_sun(place, i));
  });
  sun_irradiance_ = static_cast<Vec3f>(light);
  sun_direction_ = static_cast<Vec3f>(normalized(towards));
}

void Environment::find_light() {
  const double area = 4.0 / (static_cast<double>(side_) * side_);
  const auto basis = [](Vec3d d) {
    return std::array{1.0,
                      d.x,
                      d.y,
                      d.z,
                      d.x * d.y,
                      d.y * d.z,
                      d.z * d.x,
                      d.x * d.x - d.y * d.y,
                      3 * d.z * d.z - 1};
  };
  // 1 / the integral of each basis function squared, times the factor of a cosine lobe for its
  // band, divided by pi: 1, 2/3 and 1/4.
  constexpr double kPi4 = 4 * std::numbers::pi;
  constexpr std::array kFactors{1 / kPi4,      2 / kPi4,       2 / kPi4,
                                2 / kPi4,      15 / kPi4 / 4,  15 / kPi4 / 4,
                                15 / kPi4 / 4, 15 / kPi4 / 16, 5 / kPi4 / 16};
  Vec3d sums[9];
  for_texels(side_, [&](const MapPlace& place, std::size_t i) {
    const std::array values = basis(place.direction);
    for (std::size_t k = 0; k < 9; ++k)
      sums[k] = sums[k] + static_cast<Vec3d>(texels_[i]) * (values[k] * place.density * area);
  });
  for (std::size_t k = 0; k < 9; ++k)
    light_.harmonics[k] = static_cast<Vec3f>(sums[k] * kFactors[k]);
  mean_luminance_ = luminance(light_.harmonics[0]);
  if (!(mean_luminance_ > 0)) throw Error("the environment is black");
  light_.texels = texels_.data();
  light_.side = side_;
}

SkyMap Environment::map(Vec3f up, double degrees) const {
  SkyMap map = light_;
  const auto up_d = static_cast<Vec3d>(up);
  const Vec3d front = std::fabs(up_d.z) > 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, -1};
  const Vec3d right = normalized(cross(front, up_d));
  const Vec3d ahead = cross(up_d, right);
  const double angle = degrees * std::numbers::pi / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  map.up = up;
  map.right = static_cast<Vec3f>(right * c + ahead * s);
  map.back = static_cast<Vec3f>(right * s - ahead * c);
  return map;
}

bool is_built_in_environment(std::string_view name) {
  return name == "studio" || name == "overcast" || name == "sunset";
}

Environment built_in_environment(std::string_view name) {
  const auto wide = [](float cosine, float from, float to) {
    return smooth_step(from, to, cosine);
  };
  if (name == "overcast")
    return Environment(kBuiltInSide, [&](Vec3f d) {
      // The CIE's overcast sky (Moon and Spencer): three times as bright above as at the horizon.
      const Vec3f sky = Vec3f{0.78f, 0.86f, 0.95f} * ((1 + 2 * std::max(d.y, 0.0f)) / 3);
      return mix(sky, {0.16f, 0.15f, 0.14f}, wide(-d.y, -0.02f, 0.12f));
    });
  if (name == "sunset")
    return Environment(kBuiltInSide, [&](Vec3f d) {
      const Vec3f sun = normalized(Vec3f{-0.8f, 0.14f, -0.55f});
      const float near = std::max(dot(d, sun), 0.0f), high = std::max(d.y, 0.0f);
      const Vec3f warm{1.0f, 0.46f, 0.2f}, blue{0.1f, 0.17f, 0.36f}, rose{0.5f, 0.34f, 0.38f};
      Vec3f sky = mix(mix(rose, warm, near * near), blue, 1 - (1 - high) * (1 - high) * (1 - high));
      sky = sky + warm * (0.8f * std::pow(near, 24.0f));
      if (near > 0.9994f) sky = sky + Vec3f{1.0f, 0.5f, 0.22f} * 1400.0f;
      return mix(sky, {0.09f, 0.07f, 0.065f}, wide(-d.y, -0.02f, 0.1f));
    });
  assert(name == "studio");
  return Environment(kBuiltInSide, [&](Vec3f d) {
    // A large key light at the upper left, a weak one at the right, and one behind the scene.
    const Vec3f key = normalized(Vec3f{-0.7f, 0.65f, 0.45f});
    const Vec3f fill = normalized(Vec3f{0.9f, 0.25f, 0.35f});
    const Vec3f rim = normalized(Vec3f{0.25f, 0.5f, -0.85f});
    Vec3f light{0.12f, 0.12f, 0.125f};
    light = light + Vec3f{5.0f, 4.8f, 4.5f} * wide(dot(d, key), 0.86f, 0.9f);
    light = light + Vec3f{0.8f, 0.9f, 1.1f} * wide(dot(d, fill), 0.8f, 0.9f);
    light = light + Vec3f{2.4f, 2.5f, 2.7f} * wide(dot(d, rim), 0.92f, 0.95f);
    return light;
  });
}

}  // namespace voxdag
