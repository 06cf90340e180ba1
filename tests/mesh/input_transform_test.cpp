#include "voxdag/mesh/input_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace voxdag {
namespace {

TransformRequest up(const std::string& text) {
  TransformRequest request;
  request.up = text;
  return request;
}

TEST(InputTransform, TheUpAxisOfTheFormatIsTurned) {
  const InputTransform turn(up("z"), custom_of("a.glb"));
  EXPECT_EQ(turn.point({1, 2, 3}), (Vec3d{1, -3, 2}));
  EXPECT_TRUE(InputTransform(up("z"), custom_of("A.STL")).is_identity());
  EXPECT_TRUE(InputTransform(up("y"), custom_of("a.obj")).is_identity());
  EXPECT_EQ(InputTransform(up("y"), custom_of("a.las.gz")).point({1, 2, 3}), (Vec3d{1, 3, -2}));
  EXPECT_TRUE(InputTransform(up("z"), custom_of("A.STL.GZ")).is_identity());
  EXPECT_TRUE(InputTransform(up("y"), custom_of("-", "obj")).is_identity());
}

TEST(InputTransform, AssimpTurnsSomeFormatsButNotAll) {
  for (const std::string name : {"a.dxf", "A.ASE", "a.3ds", "a.md2", "a.ifc", "a.x3d"}) {
    const InputTransform turn(up("z"), custom_of(name));
    EXPECT_EQ(turn.point({1, 2, 3}), (Vec3d{1, -3, 2})) << name;
  }
  for (const std::string name : {"a.blend", "a.amf", "a.smd"})
    EXPECT_TRUE(InputTransform(up("z"), custom_of(name)).is_identity()) << name;
}

TEST(InputTransform, TheInputsAxisCanBeGiven) {
  EXPECT_TRUE(InputTransform(up("z:z"), custom_of("a.obj")).is_identity());
  for (const char* from : {"x", "y", "z"})
    for (const char* to : {"x", "y", "z"}) {
      const InputTransform turn(up(std::string(from) + ":" + to), {});
      Vec3d axis{}, expected{};
      axis[from[0] - 'x'] = expected[to[0] - 'x'] = 1;
      EXPECT_EQ(turn.turned(axis), expected);
      EXPECT_TRUE(turn.keeps_axes());
      // A turn, not a mirror.
      const Vec3d x = turn.turned({1, 0, 0}), y = turn.turned({0, 1, 0});
      EXPECT_EQ(cross(x, y), turn.turned({0, 0, 1}));
    }
}

TEST(InputTransform, UnitsAreConverted) {
  TransformRequest request;
  request.unit = "mm";
  EXPECT_EQ(InputTransform(request, custom_of("a.gltf")).factor(), 1000);
  EXPECT_EQ(InputTransform(request, custom_of("a.stl")).factor(), 1);
  request.unit = "in:mm";
  EXPECT_DOUBLE_EQ(InputTransform(request, custom_of("a.stl")).factor(), 25.4);
}

TEST(InputTransform, ScaleTurnsAndTranslationFollowEachOther) {
  TransformRequest request;
  request.scale = 2;
  request.rotate = "z:90,x:-90";
  request.translate = {10, 0, 0.5};
  const InputTransform transform(request, {});
  // (1, 2, 3) * 2, about z to (-4, 2, 6), about x to (-4, 6, -2).
  EXPECT_EQ(transform.point({1, 2, 3}), (Vec3d{6, 6, -1.5}));
  request.rotate = "y:30";
  const Vec3d turned = InputTransform(request, {}).turned({0, 0, 1});
  EXPECT_NEAR(turned.x, 0.5, 1e-15);
  EXPECT_NEAR(turned.z, std::sqrt(0.75), 1e-15);
  EXPECT_FALSE(InputTransform(request, {}).keeps_axes());
}

TEST(InputTransform, SettingsReadBackAsTheyWere) {
  TransformRequest request{"y:z", "mm", 0.1, "z:12.5", {1, 2e-7, 3}};
  std::map<std::string, std::string> settings;
  add_settings(request, settings);
  EXPECT_EQ(settings.at("up"), "z");
  EXPECT_EQ(settings.at("up_from"), "y");
  EXPECT_EQ(settings.at("unit"), "mm");
  EXPECT_EQ(transform_request(settings), request);
  settings.clear();
  add_settings({}, settings);
  EXPECT_TRUE(settings.empty());
}

TEST(InputTransform, MalformedTextsAreRefused) {
  TransformRequest unit, rotate;
  unit.unit = "yard";
  rotate.rotate = "z90";
  for (const TransformRequest& request : {up("w"), up("y:"), unit, rotate})
    EXPECT_THROW(InputTransform(request, {}), std::invalid_argument);
}

TEST(InputTransform, NormalsTurnAndHeightsScaleWithTheMesh) {
  MeshWithAppearance source;
  source.mesh.vertices.assign({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  source.mesh.triangles.push_back({0, 1, 2});
  source.appearance.normals.assign(3, {0, 0, 1});
  source.appearance.materials.resize(1);
  TransformRequest request = up("z:y");
  request.scale = 3;
  move_mesh(source, InputTransform(request, {}));
  EXPECT_EQ(source.mesh.vertices[2], (Vec3f{0, 0, -3}));
  EXPECT_EQ(source.appearance.normals[1], (Vec3f{0, 1, 0}));
  EXPECT_EQ(source.appearance.materials[0].displacement_gain, 3);
  // Turned and scaled alike, the triangle still looks along its normal.
  const auto& v = source.mesh.vertices;
  EXPECT_EQ(cross(v[1] - v[0], v[2] - v[0]), (Vec3f{0, 9, 0}));
}

TEST(InputTransform, TheUpAxisAndTheUnitFollowTheMove) {
  const auto after = [](const TransformRequest& request, const char* file) {
    const FormatCustom custom = custom_after(request, custom_of(file));
    return (custom.has_up ? std::string(1, static_cast<char>('x' + custom.up)) : "?") + custom.unit;
  };
  EXPECT_EQ(after({}, "a.glb"), "ym");
  EXPECT_EQ(after({}, "a.vox"), "z");
  EXPECT_EQ(after({}, "a.obj"), "?");
  EXPECT_EQ(after(up("z"), "a.obj"), "z");
  EXPECT_EQ(after(up("x:z"), "a.glb"), "zm");
  TransformRequest request = up("z");
  request.unit = "mm";
  EXPECT_EQ(after(request, "a.glb"), "zmm");
  request.rotate = "x:90";  // From z to -y.
  EXPECT_EQ(after(request, "a.glb"), "?mm");
  request.rotate = "x:-90,z:45";
  request.scale = 2;  // The unit of the result has no name.
  EXPECT_EQ(after(request, "a.glb"), "?");
  request.rotate = "x:-90,y:45";
  EXPECT_EQ(after(request, "a.glb"), "y");
}

}  // namespace
}  // namespace voxdag
