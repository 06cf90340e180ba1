// 3MF: small files, their transforms, units and colours, and damaged ones.
#include <gtest/gtest.h>
#include <minizip/zip.h>

#include <map>

#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

using Parts = std::map<std::string, std::string>;

void write_zip(const std::filesystem::path& path, const Parts& parts) {
  const zipFile zip = zipOpen64(path.c_str(), 0);
  for (const auto& [name, text] : parts) {
    zip_fileinfo info{};
    zipOpenNewFileInZip(zip, name.c_str(), &info, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 9);
    zipWriteInFileInZip(zip, text.data(), static_cast<unsigned>(text.size()));
    zipCloseFileInZip(zip);
  }
  zipClose(zip, nullptr);
}

const std::string kMesh3mf =
    "<mesh><vertices><vertex x='1' y='2' z='3'/><vertex x='2' y='2' z='3'/><vertex x='1' y='4' "
    "z='3'/></vertices><triangles><triangle v1='0' v2='1' v3='2'";

std::string model_3mf(const std::string& resources, const std::string& items,
                      const std::string& attributes = "") {
  return "<?xml version='1.0'?><model " + attributes +
         " xmlns='http://schemas.microsoft.com/3dmanufacturing/core/2015/02' "
         "xmlns:m='http://schemas.microsoft.com/3dmanufacturing/material/2015/02' xmlns:p='p'>"
         "<resources>" +
         resources + "</resources><build>" + items + "</build></model>";
}

class Threemf : public testing::Test {
 protected:
  std::filesystem::path write(const Parts& parts) const {
    std::filesystem::remove(dir_ / "a.3mf");
    write_zip(dir_ / "a.3mf", parts);
    return dir_ / "a.3mf";
  }
  MeshWithAppearance read(const std::string& model) const {
    return read_mesh_with_appearance(write({{"3D/3dmodel.model", model}}));
  }
  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }
  std::string refusal(const std::string& model) const {
    return error_of([&] { read(model); });
  }
  const TempDir dir_;
};

TEST_F(Threemf, ItemsAndComponentsAreTransformed) {
  const Mesh mesh =
      read(model_3mf(
               "<object id='1'>" + kMesh3mf +
                   "/></triangles></mesh></object><object id='2'>"
                   "<components><component objectid='1' transform='0 1 0 -1 0 0 0 0 1 10 0 0'/>"
                   "</components></object><object id='3' type='support'>" +
                   kMesh3mf + "/></triangles></mesh></object>",
               "<item objectid='2' transform='1 0 0 0 1 0 0 0 1 0 0 5'/><item objectid='3'/>"))
          .mesh;
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0], (Vec3f{8, 1, 8}));
  EXPECT_EQ(mesh.vertices[1], (Vec3f{8, 2, 8}));
  EXPECT_EQ(mesh.vertices[2], (Vec3f{6, 1, 8}));
}

TEST_F(Threemf, WhatIsOfNoBodyIsLeftOut) {
  const std::string end = "/></triangles></mesh></object>";
  const MeshWithAppearance read_one = read(model_3mf(
      "<object id='1'>" + kMesh3mf + end + "<object id='2' type='other'>" + kMesh3mf + end +
          "<object id='3'><components><component objectid='1'/><component "
          "objectid='2'/></components></object>",
      "<item objectid='3'/>"));
  EXPECT_EQ(read_one.mesh.triangles.size(), 1u);
  ASSERT_EQ(read_one.warnings.size(), 1u);
  EXPECT_TRUE(has(read_one.warnings[0], "1 objects of the type \"other\" are left out"));
}

TEST_F(Threemf, RequiredExtensionsAreKnownOrRefused) {
  const auto model = [](const std::string& attributes) {
    return model_3mf("<object id='1'>" + kMesh3mf + "/></triangles></mesh></object>",
                     "<item objectid='1'/>", attributes);
  };
  EXPECT_EQ(read(model("requiredextensions='m'")).mesh.triangles.size(), 1u);
  const std::string booleans =
      " xmlns:bo='http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07'";
  EXPECT_EQ(read(model(booleans)).mesh.triangles.size(), 1u);
  EXPECT_TRUE(has(refusal(model("requiredextensions='m  bo'" + booleans)),
                  "line 1: needs an extension of 3MF that is not read: "
                  "'http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07'"));
}

TEST_F(Threemf, NamesOfPartsMayHaveBackslashes) {
  EXPECT_EQ(read_mesh(write({{"3D\\3dmodel.model", model_3mf("<object id='1'>" + kMesh3mf +
                                                                 "/></triangles></mesh></object>",
                                                             "<item objectid='1'/>")}}))
                .triangles.size(),
            1u);
}

TEST_F(Threemf, UnitsBecomeMillimetres) {
  for (const auto& [unit, size] :
       {std::pair{"inch", 25.4f}, {"micron", 0.001f}, {"meter", 1000.f}}) {
    const Mesh mesh =
        read(model_3mf("<object id='1'>" + kMesh3mf + "/></triangles></mesh></object>",
                       "<item objectid='1' transform='1 0 0 0 1 0 0 0 1 1 0 0'/>",
                       std::string("unit='") + unit + "'"))
            .mesh;
    EXPECT_FLOAT_EQ(mesh.vertices[0].x, 2 * size);
    EXPECT_FLOAT_EQ(mesh.vertices[2].y, 4 * size);
  }
  EXPECT_NE(refusal(model_3mf("", "", "unit='parsec'")).find("unknown unit 'parsec'"),
            std::string::npos);
}

TEST_F(Threemf, MirroredCopiesAreTurned) {
  const Mesh mesh = read(model_3mf("<object id='1'>" + kMesh3mf + "/></triangles></mesh></object>",
                                   "<item objectid='1' transform='-1 0 0 0 1 0 0 0 1 0 0 0'/>"))
                        .mesh;
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 2, 1}));
}

TEST_F(Threemf, ColorsComeFromMaterialsAndGroups) {
  const std::string groups =
      "<basematerials id='5'><base name='red' displaycolor='#FF0000'/><base name='blue' "
      "displaycolor='#0000FF80'/></basematerials><m:colorgroup id='6'><m:color color='#008000FF'/>"
      "<m:color color='#FFFFFF'/></m:colorgroup>";
  const auto color_of = [&](const std::string& object, const std::string& triangle) {
    const MeshWithAppearance read_one =
        read(model_3mf(groups + "<object id='1' " + object + ">" + kMesh3mf + triangle +
                           "/></triangles></mesh></object>",
                       "<item objectid='1'/>"));
    const Material& material = read_one.appearance.materials[read_one.mesh.triangle_materials[0]];
    Vec3f color = material.base_color;
    if (!read_one.appearance.colors.empty()) color = color * read_one.appearance.colors[1].color();
    return std::array{linear_to_srgb8(color.x), linear_to_srgb8(color.y), linear_to_srgb8(color.z)};
  };
  using Rgb = std::array<std::uint8_t, 3>;
  EXPECT_EQ(color_of("pid='5' pindex='1'", ""), (Rgb{0, 0, 255}));
  EXPECT_EQ(color_of("pid='5' pindex='1'", " p1='0'"), (Rgb{255, 0, 0}));
  EXPECT_EQ(color_of("", " pid='6' p1='0'"), (Rgb{0, 128, 0}));
  EXPECT_EQ(color_of("", " pid='6' p1='0' p2='1' p3='0'"), (Rgb{255, 255, 255}));
  EXPECT_EQ(color_of("", ""), (Rgb{204, 204, 204}));
  const MeshWithAppearance late = read(model_3mf(
      "<object id='1' pid='5' pindex='0'>" + kMesh3mf + "/></triangles></mesh></object>" + groups,
      "<item objectid='1'/>"));
  ASSERT_EQ(late.warnings.size(), 1u);
  EXPECT_TRUE(has(late.warnings[0], "a group of materials after the objects that name it"));
}

TEST_F(Threemf, ModelsOfOtherPartsAreRead) {
  const Mesh mesh = read_mesh(
      write({{"_rels/.rels",
              "<Relationships><Relationship Target='/3D/root.model' "
              "Type='http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel'/>"
              "</Relationships>"},
             {"3D/root.model", model_3mf("<object id='1'><components><component objectid='1' "
                                         "p:path='/3D/other.model'/></components></object>",
                                         "<item objectid='1'/>")},
             {"3D/other.model",
              model_3mf("<object id='1'>" + kMesh3mf + "/></triangles></mesh></object>", "")}}));
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST_F(Threemf, RefusesWhatIsDamagedOrWouldGrow) {
  const std::string file = (dir_ / "a.3mf").string();
  EXPECT_TRUE(
      has(refusal(model_3mf("<object id='1'>" + kMesh3mf +
                                " /></triangles></mesh>"
                                "<components><component objectid='1'/></components></object>",
                            "<item objectid='1'/>")),
          "components are nested more than 64 deep"));
  EXPECT_TRUE(has(refusal("<!DOCTYPE model [<!ENTITY a 'b'>]><model/>"),
                  (file + ": 3D/3dmodel.model, line 1: has a document type").c_str()));
  EXPECT_TRUE(has(refusal(model_3mf("<object id='1'>", "")), "is not well-formed XML"));
  EXPECT_TRUE(has(refusal(model_3mf("", "<item objectid='7'/>")), "has no object '7'"));
  EXPECT_TRUE(has(refusal(model_3mf("", "")), "its build has no items"));
  EXPECT_TRUE(has(refusal("<model>" + std::string(300, '\n') + "<a b='" +
                          std::string(3 << 20, 'x') + "'/></model>"),
                  "a name or a value has more than 1 MiB"));
  std::string deep;
  for (int i = 0; i < 300; ++i) deep += "<a>";
  EXPECT_TRUE(has(refusal(deep), "nested more than 200 deep"));
  EXPECT_TRUE(has(refusal(model_3mf("<object id='1'>" + kMesh3mf +
                                        " /><triangle v1='0' v2='1' "
                                        "v3='3'/></triangles></mesh></object>",
                                    "<item objectid='1'/>")),
                  "vertex '3' is no whole number from 0 to 3 (excluded)"));
  // Objects that are doubled in each of 40 steps.
  std::string doubled = "<object id='0'>" + kMesh3mf + "/></triangles></mesh></object>";
  for (int i = 1; i <= 40; ++i) {
    const std::string use = "<component objectid='" + std::to_string(i - 1) + "'/>";
    doubled += "<object id='" + std::to_string(i) + "'><components>" + use + use +
               "</components></object>";
  }
  MemoryBudget memory(64 << 20);
  ReadOptions options;
  options.work = &memory;
  write({{"3D/3dmodel.model", model_3mf(doubled, "<item objectid='40'/>")}});
  EXPECT_THROW(read_mesh(dir_ / "a.3mf", options), Error);
  EXPECT_EQ(memory.used(), 0u);
}

TEST_F(Threemf, BeamsAreAWarningWithoutTheAppearanceToo) {
  const std::string model =
      model_3mf("<object id='1'>" + kMesh3mf + "/></triangles><beamlattice/></mesh></object>",
                "<item objectid='1'/>");
  std::vector<std::string> warnings;
  ReadOptions options;
  options.warnings = &warnings;
  read_mesh(write({{"3D/3dmodel.model", model}}), options);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("beamlattice is not read"), std::string::npos);
}

TEST_F(Threemf, TheContentTellsItWithoutAnExtension) {
  std::filesystem::rename(
      write({{"3D/3dmodel.model",
              model_3mf("<object id='1'>" + kMesh3mf + "/></triangles></mesh></object>",
                        "<item objectid='1'/>")}}),
      dir_ / "a");
  EXPECT_EQ(read_mesh(dir_ / "a").triangles.size(), 1u);
  EXPECT_EQ(mesh_custom(dir_ / "a").up, 2);
}

TEST_F(Threemf, NoPrefixIsRead) {
  write({{"3D/3dmodel.model",
          model_3mf("<object id='1'>" + kMesh3mf + "/></triangles></mesh></object>",
                    "<item objectid='1'/>")}});
  const std::string good = read_text(dir_ / "a.3mf");
  // minizip does without the last bytes: the length of a comment.
  for (std::size_t size = 0; size + 4 < good.size(); ++size) {
    std::filesystem::remove(dir_ / "b.3mf");
    write_text(dir_ / "b.3mf", good.substr(0, size));
    EXPECT_NE(error_of([&] { read_mesh(dir_ / "b.3mf"); }), "no error") << size;
  }
}

}  // namespace
}  // namespace voxdag
