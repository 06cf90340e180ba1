// COLLADA: small files, their transforms, axes and colours, and damaged ones.
#include <gtest/gtest.h>

#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

std::string collada(const std::string& primitives, const std::string& node,
                    const std::string& more = "") {
  return "<COLLADA><asset><unit meter='0.01'/><up_axis>Z_UP</up_axis></asset><library_geometries>"
         "<geometry id='g'><mesh><source id='p'><float_array id='f' count='12'>0 0 0 100 0 0\n"
         "100 100 0 0 100 0</float_array><technique_common><accessor source='#f' count='4' "
         "stride='3'/></technique_common></source><vertices id='v'><input semantic='POSITION' "
         "source='#p'/></vertices>" +
         primitives + "</mesh></geometry></library_geometries>" + more +
         "<library_visual_scenes><visual_scene id='s'>" + node +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
         "</COLLADA>";
}

const std::string kInput = "<input semantic='VERTEX' source='#v' offset='0'/>";
const std::string kNode = "<node><instance_geometry url='#g'/></node>";

class Collada : public testing::Test {
 protected:
  MeshWithAppearance read(const std::string& text) const {
    std::filesystem::remove(dir_ / "a.dae");
    write_text(dir_ / "a.dae", text);
    return read_mesh_with_appearance(dir_ / "a.dae");
  }
  const TempDir dir_;
};

TEST_F(Collada, EveryPrimitiveMakesTriangles) {
  for (const auto& [primitive, count] :
       {std::pair{"<triangles count='1'>" + kInput + "<p>0 1 2</p></triangles>", 1u},
        {"<polylist count='2' material='m'>" + kInput +
             "<input semantic='NORMAL' source='#n' offset='1'/><vcount>3 4</vcount><p>0 0 1 0 2 0 "
             "0 0 1 0 2 0 3 0</p></polylist>",
         3u},
        {"<polygons count='1'>" + kInput + "<p>0 1 2 3</p></polygons>", 2u},
        {"<tristrips count='1'>" + kInput + "<p>0 1 3 2</p></tristrips>", 2u},
        {"<trifans count='1'>" + kInput + "<p>0 1 2 3</p></trifans>", 2u}}) {
    const Mesh mesh = read(collada(primitive, kNode)).mesh;
    ASSERT_EQ(mesh.triangles.size(), count) << primitive;
    for (const Triangle& t : mesh.triangles) {
      const Vec3f a = mesh.vertices[t[0]];
      EXPECT_GT(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a).z, 0) << primitive;
    }
    EXPECT_FLOAT_EQ(mesh.vertices[2].x, 1);  // Centimetres.
  }
}

TEST_F(Collada, NodesAreTransformedInOrderAndTheAxesStay) {
  const std::string triangle = "<triangles count='1'>" + kInput + "<p>0 1 2</p></triangles>";
  const Mesh mesh =
      read(collada(triangle,
                   "<node><translate>100 0 0</translate><rotate>0 0 1 90</rotate><node><scale>2 1 "
                   "-1</scale><matrix>1 0 0 0 0 1 0 0 0 0 1 300 0 0 0 1</matrix><instance_geometry "
                   "url='#g'/></node></node>"))
          .mesh;
  const Vec3f corner = mesh.vertices[2];
  EXPECT_NEAR(corner.x, 0, 1e-6);
  EXPECT_NEAR(corner.y, 2, 1e-6);
  EXPECT_NEAR(corner.z, -3, 1e-6);
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 2, 1}));  // Mirrored.
}

TEST_F(Collada, DiffuseColorsAreReadAndWhatIsLeftOutIsSaid) {
  const MeshWithAppearance result = read(collada(
      "<triangles count='1' material='sym'>" + kInput +
          "<input semantic='TEXCOORD' source='#t' offset='0'/><p>0 1 2</p></triangles>",
      "<node><instance_geometry url='#g'><bind_material><technique_common><instance_material "
      "symbol='sym' target='#m'/></technique_common></bind_material></instance_geometry></node>",
      "<library_effects><effect id='e'><profile_COMMON><technique><lambert><diffuse><color>1 0 0 "
      "1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>"
      "<library_materials><material id='m' name='red'><instance_effect url='#e'/></material>"
      "</library_materials>"));
  const Material& material = result.appearance.materials[result.mesh.triangle_materials[0]];
  EXPECT_EQ(material.name, "red");
  EXPECT_EQ(material.base_color, (Vec3f{1, 0, 0}));
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("textures are not read"), std::string::npos);
}

/// Returns a document whose one triangle has a material with this profile of its effect.
std::string collada_with_effect(const std::string& effect) {
  return collada(
      "<triangles count='1' material='sym'>" + kInput + "<p>0 1 2</p></triangles>",
      "<node><instance_geometry url='#g'><bind_material><technique_common><instance_material "
      "symbol='sym' target='#m'/></technique_common></bind_material></instance_geometry></node>",
      "<library_effects><effect id='e'><profile_COMMON>" + effect +
          "</profile_COMMON></effect></library_effects><library_materials><material id='m'>"
          "<instance_effect url='#e'/></material></library_materials>");
}

TEST_F(Collada, ColorsMayBeParametersHaveThreeNumbersAndBeEmitted) {
  const auto material_of = [&](const std::string& effect, std::size_t warnings) {
    const MeshWithAppearance result = read(collada_with_effect(effect));
    EXPECT_EQ(result.warnings.size(), warnings) << effect;
    return result.appearance.materials[result.mesh.triangle_materials[0]];
  };
  const auto phong = [](const std::string& properties) {
    return "<technique><phong>" + properties + "</phong></technique>";
  };
  const Vec3f red{1, 0, 0}, green{0, 1, 0};
  EXPECT_EQ(material_of(phong("<diffuse><color>1 0 0</color></diffuse>"), 0).base_color, red);
  EXPECT_EQ(material_of("<newparam sid='c'><float4>1 0 0 1</float4></newparam>" +
                            phong("<diffuse><param ref='c'/></diffuse>"),
                        0)
                .base_color,
            red);
  EXPECT_EQ(material_of(phong("<diffuse><color>1 0</color></diffuse>"), 1).base_color,
            kDefaultColor);
  const Material both = material_of(phong("<emission><color>0 1 0 1</color></emission><diffuse>"
                                          "<color>1 0 0 1</color></diffuse>"),
                                    0);
  EXPECT_EQ(both.base_color, red);
  EXPECT_EQ(both.emission, green);
  const Material constant = material_of(
      "<technique><constant><emission><color>0 1 0 1</color></emission></constant></technique>", 0);
  EXPECT_EQ(constant.base_color + constant.emission, green);
}

TEST_F(Collada, HolesAreAWarningWithoutTheAppearanceToo) {
  write_text(dir_ / "a.dae", collada("<polygons count='1'>" + kInput +
                                         "<ph><p>0 1 2 3</p><h>0 1 2</h></ph></polygons>",
                                     kNode));
  std::vector<std::string> warnings;
  ReadOptions options;
  options.warnings = &warnings;
  EXPECT_EQ(read_mesh(dir_ / "a.dae", options).triangles.size(), 2u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("holes of polygons are not read"), std::string::npos);
}

TEST_F(Collada, TheFileSaysWhichAxisPointsUp) {
  const std::string text =
      collada("<triangles count='1'>" + kInput + "<p>0 1 2</p></triangles>", kNode);
  for (const char* name : {"a.dae", "a"}) {
    write_text(dir_ / name, text);
    EXPECT_EQ(mesh_custom(dir_ / name).up, 2);
    EXPECT_EQ(mesh_custom(dir_ / name).unit, "m");
    EXPECT_EQ(read_mesh(dir_ / name).triangles.size(), 1u);
    std::filesystem::remove(dir_ / name);
  }
  write_text(dir_ / "b.dae", "<COLLADA><asset></asset></COLLADA>");
  EXPECT_EQ(mesh_custom(dir_ / "b.dae").up, 1);
}

TEST_F(Collada, RefusesWhatIsDamagedOrWouldGrow) {
  const auto refusal = [&](const std::string& text) { return error_of([&] { read(text); }); };
  const std::string triangle = "<triangles count='1'>" + kInput + "<p>0 1 2</p></triangles>";
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(
      has(refusal(collada("<triangles count='1'>" + kInput + "<p>0 1 4</p></triangles>", kNode)),
          "vertex '4' is no whole number from 0 to 4 (excluded)"));
  EXPECT_TRUE(has(refusal(collada(triangle, "<node><instance_geometry url='#h'/></node>")),
                  "there is no <geometry> of that id"));
  EXPECT_TRUE(has(refusal(collada(triangle, "<node id='n'><instance_node url='#n'/></node>")),
                  "nodes are nested more than 200 deep"));
  EXPECT_TRUE(has(refusal(collada("", kNode)), "no triangles"));
  const std::string good = collada(triangle, kNode);
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_NE(refusal(good.substr(0, size)), "no error") << size;
}

}  // namespace
}  // namespace voxdag
