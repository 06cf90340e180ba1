#pragma once
/// The light around a scene, from a picture of all directions instead of the clear sky.
///
/// The picture is kept as an octahedral map, which kernels read without sines: a direction is
/// divided by the sum of its absolute components, and the lower half of that octahedron is folded
/// over the upper one. Source: Z. Cigolle and others, "A Survey of Efficient Representations for
/// Independent Unit Vectors", JCGT 3(2), 2014. What a diffuse surface receives is its nine
/// spherical harmonics: R. Ramamoorthi and P. Hanrahan, "An Efficient Representation for Irradiance
/// Environment Maps", SIGGRAPH 2001. The sun is taken out of the picture and becomes a light, so
/// that it casts shadows.
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/image/image.hpp"
#include "voxdag/render/sky.hpp"

namespace voxdag {

/// An environment as the settings of a view hold it.
struct PackedEnvironment {
  static constexpr int kMostSide = 512;

  int side = 0;  ///< Of the octahedral map: even, 2 to kMostSide.
  /// side² texels without the sun, row by row, of 4 bytes: red, green and blue, and the exponent
  /// that they share, as in a Radiance HDR file.
  std::string texels;
  Vec3f sun_irradiance{}, sun_direction{};  ///< As those of Environment.
};

/// A light from all directions. Its own axes: y is up, and -z is the middle of the picture. Units
/// of radiance are the file's.
class Environment {
 public:
  /// Samples an equirectangular picture of linear R, G and B: its top row is straight up, columns
  /// run to the right of a viewer inside, and its middle column is -z. Throws Error unless it is
  /// twice as wide as high, or if it is black.
  explicit Environment(const ImageF& picture);
  /// Samples radiance(direction) at side² directions of unit length. Throws Error if it is black.
  Environment(int side, const std::function<Vec3f(Vec3f)>& radiance);
  /// Unpacks an environment whose side and number of bytes are right. Throws Error if it is black.
  explicit Environment(const PackedEnvironment& packed);

  /// Returns the environment with a map of at most most_side² texels.
  PackedEnvironment packed(int most_side) const;

  /// Returns the light that the sun's part of the picture gives a surface that faces it, and the
  /// direction towards it; zero if there is no sun. A sun is what is more than 20 times as bright
  /// as the mean, within 10 degrees of the brightest place, if it gives at least a tenth as much
  /// light as the rest.
  Vec3f sun_irradiance() const { return sun_irradiance_; }
  Vec3f sun_direction() const { return sun_direction_; }

  /// Returns the mean luminance over all directions, without the sun.
  float mean_luminance() const { return mean_luminance_; }

  /// Returns the light for a scene, without the sun. `up` has unit length. `degrees` turns the
  /// picture to the left around `up`; at 0 its middle is -z, or y if z is up. The map stays this
  /// object's.
  SkyMap map(Vec3f up, double degrees = 0) const;

 private:
  Environment() = default;
  /// Sets the texels to the means of radiance(direction) over each of them.
  void sample(const std::function<Vec3f(Vec3f)>& radiance);
  void take_sun_out();
  void find_light();

  int side_ = 0;
  std::vector<Vec3f> texels_;
  SkyMap light_;
  Vec3f sun_irradiance_{}, sun_direction_{};
  float mean_luminance_ = 0;
};

/// Returns whether the name is that of a built-in environment: "studio", "overcast" or "sunset".
bool is_built_in_environment(std::string_view name);

/// Returns a built-in environment.
Environment built_in_environment(std::string_view name);

}  // namespace voxdag
