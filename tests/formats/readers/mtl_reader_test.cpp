/// Tests materials of MTL files, and the replacements of malformed ones.
#include "formats/readers/appearance_files.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

class ReadMtl : public ReadAppearance {};

TEST_F(ReadMtl, MtlStatementsFillTheirMaterial) {
  write("a.mtl",
        "newmtl stone wall\nKd 0.5 0.25 1\nmap_Kd -s 2 4 1 -o 0.5 0.25 a wall.png\n"
        "bump -bm 0.3 bumps.jpg\ndisp -mm 0.1 0.4 heights.png\n"
        "newmtl leaf\nmap_Kd tex\\leaf.png\nmap_d tex/leaf.png\nnorm -clamp on leaf_n.png\n"
        "newmtl glass\nd 0.25\nnewmtl other\nTr 0\nKd 1 1 1\n");
  const auto result = read("a.obj", "mtllib a.mtl\n" + kSquare +
                                        "usemtl stone wall\nf 1 2 3\nusemtl leaf\nf 1 3 4\n"
                                        "usemtl glass\nf 1 2 4\n");
  const Appearance& a = result.appearance;
  ASSERT_EQ(a.materials.size(), 3u);
  const Material& wall = a.materials[0];
  EXPECT_EQ(wall.name, "stone wall");
  expect_near(wall.base_color, {srgb_to_linear(0.5f), srgb_to_linear(0.25f), 1});
  EXPECT_EQ(wall.texture_tint, (Vec3f{1, 1, 1}));
  EXPECT_EQ(a.images[static_cast<std::size_t>(wall.color_map.image)].path,
            directory_.path() / "a wall.png");
  // The file's coordinates (u, v) become 2 u + 0.5 and 4 v + 0.25; then v is turned over.
  const Vec2f uv = wall.color_map.uv({0.1f, 1 - 0.2f});
  EXPECT_FLOAT_EQ(uv.x, 0.7f);
  EXPECT_FLOAT_EQ(uv.y, 1 - (4 * 0.2f + 0.25f));
  EXPECT_EQ(wall.normal_kind, NormalMapKind::kEither);
  EXPECT_FLOAT_EQ(wall.normal_scale, 0.3f);
  EXPECT_FLOAT_EQ(wall.displacement_base, 0.1f);
  EXPECT_FLOAT_EQ(wall.displacement_gain, 0.4f);
  EXPECT_TRUE(wall.displacement_map.exists());
  const Material& leaf = a.materials[1];
  EXPECT_EQ(leaf.alpha_mode, AlphaMode::kMask);
  EXPECT_EQ(leaf.alpha_map.image, leaf.color_map.image);
  EXPECT_EQ(leaf.normal_kind, NormalMapKind::kTangentSpace);
  EXPECT_EQ(leaf.normal_map.wrap_u, TextureWrap::kClamp);
  const Material& glass = a.materials[2];
  EXPECT_EQ(glass.alpha_mode, AlphaMode::kBlend);
  EXPECT_FLOAT_EQ(glass.alpha, 0.25f);
}

TEST_F(ReadMtl, MissingMaterialFilesAndMaterialsAreWarnings) {
  const auto missing = read_mesh_with_appearance(
      write("a.obj", "mtllib no.mtl\n" + kSquare + "usemtl x\nf 1 2 3\n"));
  EXPECT_EQ(missing.warnings,
            std::vector{path("no.mtl") +
                        ": cannot open: No such file or directory: its materials are grey"});
  expect_near(missing.appearance.materials[0].base_color,
              {srgb_to_linear(0.8f), srgb_to_linear(0.8f), srgb_to_linear(0.8f)});
}

TEST_F(ReadMtl, MaterialsThatNoFileDescribesAreOneWarning) {
  write("m.mtl", "newmtl a\nKd 1 0 0\n");
  std::string text = "mtllib m.mtl\n" + kSquare + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n";
  EXPECT_EQ(read_mesh_with_appearance(write("a.obj", text)).warnings,
            std::vector{path("a.obj") + ": no MTL file describes material 'b': it is grey"});
  text += "usemtl c\nf 1 2 3\n";
  EXPECT_EQ(read_mesh_with_appearance(write("a.obj", text)).warnings,
            std::vector{path("a.obj") +
                        ": no MTL file describes 2 materials, such as 'b': they are grey"});
}

TEST_F(ReadMtl, NamesMayHaveQuotesAndComments) {
  write("m.mtl",
        "newmtl a # red\nKd 1 0 0\nnewmtl b\nKd 0 1 0\nnewmtl b #blue\nKd 0 0 1\n"
        "newmtl Material #25\nKd 1 1 0\nnewmtl Material\nKd 0 1 1\n");
  const auto colour_of = [&](const std::string& name) {
    const auto result = read(
        "a.obj", "mtllib m.mtl\n" + kSquare + "usemtl " + name + "\nf 1 2 3\nusemtl b\nf 1 3 4\n");
    EXPECT_EQ(result.mesh.materials[0], name);
    EXPECT_EQ(result.appearance.materials[0].name, name);
    return result.appearance.materials[0].base_color;
  };
  for (const char* name : {"a", "\"a\"", "a # scarlet"})
    EXPECT_EQ(colour_of(name), (Vec3f{1, 0, 0}));
  for (const char* name : {"b ", "\"b\"", "b # green"})
    EXPECT_EQ(read("a.obj", "mtllib m.mtl\n" + kSquare + "usemtl " + name + "\nf 1 2 3\n")
                  .appearance.materials[0]
                  .base_color,
              (Vec3f{0, 1, 0}))
        << name;
  EXPECT_EQ(colour_of("b #blue"), (Vec3f{0, 0, 1}));
  EXPECT_EQ(colour_of("Material #25"), (Vec3f{1, 1, 0}));
  EXPECT_EQ(colour_of("Material"), (Vec3f{0, 1, 1}));
  const auto unknown = read_mesh_with_appearance(
      write("a.obj", "mtllib m.mtl\n" + kSquare + "usemtl Material #26\nf 1 2 3\n"));
  EXPECT_EQ(unknown.warnings.size(), 1u);  // The number is part of the name.
}

TEST_F(ReadMtl, MapsMayHaveCommentsAndUnknownOptions) {
  const auto file_of = [&](const std::string& arguments) {
    write("m.mtl", "newmtl a\nmap_Kd " + arguments + "\n");
    const auto result = read_mesh_with_appearance(
        write("a.obj", "mtllib m.mtl\n" + kSquare + "usemtl a\nf 1 2 3\n"));
    const auto& images = result.appearance.images;
    return images.empty() ? "" : images[0].path.filename().string();
  };
  for (const char* name : {"t.png", "my tex.png", "t #a.png", "-my tex.png"}) write(name, "");
  EXPECT_EQ(file_of("t.png # a comment"), "t.png");
  EXPECT_EQ(file_of("-colorspace sRGB t.png"), "t.png");
  EXPECT_EQ(file_of("-colorspace sRGB -s 1 1 1 my tex.png -colorspace sRGB # all"), "my tex.png");
  EXPECT_EQ(file_of("t.png -colorspace sRGB"), "t.png");
  EXPECT_EQ(file_of("my%20tex.png"), "my tex.png");
  EXPECT_EQ(file_of("t #a.png"), "t #a.png");
  EXPECT_EQ(file_of("-my tex.png"), "-my tex.png");
  EXPECT_EQ(file_of("none.png # a"), "none.png # a");
}

TEST_F(ReadMtl, MalformedMtlStatementsAreWarningsThatNameTheReplacement) {
  const std::string grey = "the material's colour is grey", opaque = "the material is opaque",
                    numbers = "not one or three finite numbers: " + grey,
                    mm = "-mm takes two finite numbers: the surface is not displaced",
                    clamped = "outside of 0 to 1: it is clamped";
  const std::vector<std::pair<std::string, std::string>> lines = {
      {"Kd nan 0 0", numbers},
      {"Kd foo bar", numbers},
      {"Kd 0.5 0.5", numbers},
      {"Kd", numbers},
      {"Kd xyz 1 1 1", "spectral curves and CIEXYZ are not supported: " + grey},
      {"Kd spectral f.rfl", "spectral curves and CIEXYZ are not supported: " + grey},
      {"Kd 5 -3 0", clamped},
      {"d foo", "not a finite number: " + opaque},
      {"Tr inf", "not a finite number: " + opaque},
      {"d 1.5", clamped},
      {"map_Kd", "it names no file: the material's colour replaces the texture"},
      {"map_Kd -s x 1 a.png",
       "-s takes one to three finite numbers: the material's colour replaces the texture"},
      {"map_d -clamp on", "it names no file: the material is opaque without its alpha map"},
      {"norm -bm 1e300 n.png",
       "-bm takes a finite number: the mesh's own normals replace the normal map"},
      {"bump -clamp maybe n.png",
       "-clamp takes on or off: the mesh's own normals replace the normal map"},
      {"disp -mm nan nan B.JPG", mm},
      {"disp -mm 1 B.JPG", mm}};
  for (const auto& [line, expected] : lines) {
    write("a.mtl", "# colours\nnewmtl m\n" + line + "\n");
    const auto result = read_mesh_with_appearance(
        write("a.obj", "mtllib a.mtl\n" + kSquare + "usemtl m\nf 1 2 3\n"));
    EXPECT_EQ(result.warnings,
              std::vector{path("a.mtl") + ": line 3: '" + line + "': " + expected});
    const Material& m = result.appearance.materials[0];
    EXPECT_EQ(m.base_color, expected.ends_with(grey) ? kDefaultColor
                            : line == "Kd 5 -3 0"    ? (Vec3f{1, 0, 0})
                                                     : (Vec3f{1, 1, 1}));
    EXPECT_EQ(m.alpha, 1);
    EXPECT_FALSE(m.color_map.exists() || m.alpha_map.exists() || m.normal_map.exists() ||
                 m.displacement_map.exists());
    EXPECT_EQ(m.alpha_mode, AlphaMode::kOpaque);
  }
}

TEST_F(ReadMtl, OpacityIsOfDOrElseOfTrUnlessThatWouldHideTheMaterial) {
  const auto alpha_of = [&](const std::string& lines, std::size_t warnings) {
    write("a.mtl", "newmtl m\n" + lines);
    const auto result = read_mesh_with_appearance(
        write("a.obj", "mtllib a.mtl\n" + kSquare + "usemtl m\nf 1 2 3\n"));
    EXPECT_EQ(result.warnings.size(), warnings) << lines;
    EXPECT_EQ(result.appearance.materials[0].alpha_mode,
              result.appearance.materials[0].alpha < 1 ? AlphaMode::kBlend : AlphaMode::kOpaque);
    return result.appearance.materials[0].alpha;
  };
  EXPECT_EQ(alpha_of("Tr 0.25\n", 0), 0.75f);
  EXPECT_EQ(alpha_of("Tr 1\n", 1), 1);
  EXPECT_EQ(alpha_of("Tr 1\nd 1\n", 0), 1);
  EXPECT_EQ(alpha_of("d 1\nTr 1\n", 0), 1);
  EXPECT_EQ(alpha_of("d 0.5\nTr 0\n", 0), 0.5f);
  EXPECT_EQ(alpha_of("d 0\n", 0), 0);
  EXPECT_EQ(alpha_of("Tr 1\nnewmtl other\nd 1\n", 1), 1);
}

TEST_F(ReadMtl, TheAlphaOfAColourTextureIsAMask) {
  write("a.mtl", "newmtl m\nd 1\nmap_Kd a.png\nnewmtl n\nmap_Kd a.png\nd 0.5\n");
  const auto result =
      read("a.obj", "mtllib a.mtl\n" + kSquare + "usemtl m\nf 1 2 3\nusemtl n\nf 1 2 3\n");
  EXPECT_EQ(result.appearance.materials[0].alpha_mode, AlphaMode::kImpliedMask);
  EXPECT_EQ(result.appearance.materials[0].alpha_cutoff, 0.5f);
  EXPECT_EQ(result.appearance.materials[1].alpha_mode, AlphaMode::kBlend);
}

TEST_F(ReadMtl, OptionsMayFollowTheName) {
  write("a.mtl", "newmtl m\nmap_Kd a wall.png -s 2 3 1 -clamp on\nbump my -bm map.png\n");
  const auto result = read("a.obj", "mtllib a.mtl\n" + kSquare + "usemtl m\nf 1 2 3\n");
  const Material& m = result.appearance.materials[0];
  EXPECT_EQ(result.appearance.images[0].path, directory_.path() / "a wall.png");
  EXPECT_EQ(m.color_map.uv.xx, 2);
  EXPECT_EQ(m.color_map.wrap_u, TextureWrap::kClamp);
  EXPECT_EQ(result.appearance.images[1].path, directory_.path() / "my -bm map.png");
}

TEST_F(ReadMtl, EmissionIsReadAndItsTextureAloneCountsInFull) {
  write("a.mtl", "newmtl m\nKe 1 0 0\nnewmtl n\nKe 0 0 0\nmap_Ke a.png\n");
  const auto result =
      read("a.obj", "mtllib a.mtl\n" + kSquare + "usemtl m\nf 1 2 3\nusemtl n\nf 1 2 3\n");
  const std::vector<Material>& materials = result.appearance.materials;
  EXPECT_EQ(materials[0].emission, (Vec3f{1, 0, 0}));
  EXPECT_FALSE(materials[0].emission_map.exists());
  EXPECT_EQ(materials[1].emission, (Vec3f{1, 1, 1}));
  EXPECT_EQ(materials[1].emission_map.image, 0);
}

TEST_F(ReadMtl, PmAndPrAreMetallicAndRoughness) {
  write("a.mtl",
        "newmtl m\nPm 0.75\nPr 0.25\nmap_Pr -s 2 2 1 r.png\nnewmtl n\nmap_Pm m.png\n"
        "newmtl o\nPm 1\nPm x\nPr 2\n");
  const auto result = read_mesh_with_appearance(write(
      "a.obj",
      "mtllib a.mtl\n" + kSquare + "usemtl m\nf 1 2 3\nusemtl n\nf 1 3 4\nusemtl o\nf 1 2 4\n"));
  ASSERT_EQ(result.warnings.size(), 2u);
  EXPECT_EQ(result.warnings[0],
            path("a.mtl") + ": line 9: 'Pm x': not a finite number: the material is no metal");
  EXPECT_EQ(result.warnings[1],
            path("a.mtl") + ": line 10: 'Pr 2': outside of 0 to 1: it is clamped");
  const std::vector<Material>& m = result.appearance.materials;
  EXPECT_EQ(m[0].metallic_roughness, (MetallicRoughness{0.75f, 0.25f}));
  EXPECT_TRUE(m[0].roughness_map.exists());
  EXPECT_FLOAT_EQ(m[0].roughness_map.uv({0.1f, 0}).x, 0.2f);
  EXPECT_EQ(m[0].map_factors, (MetallicRoughness{1, 1}));
  EXPECT_EQ(m[1].metallic_roughness, (MetallicRoughness{0, 1}));
  EXPECT_TRUE(m[1].metallic_map.exists());
  EXPECT_EQ(m[2].metallic_roughness, (MetallicRoughness{0, 1}));
}

TEST_F(ReadMtl, OneNumberOfKdIsForAllChannels) {
  write("a.mtl", "newmtl m\nKd 1 # white\nnewmtl n\nKd 0\n");
  const auto result = read("a.obj", "mtllib a.mtl\n" + kSquare + "usemtl n\nf 1 2 3\n");
  EXPECT_EQ(result.appearance.materials[0].base_color, (Vec3f{0, 0, 0}));
}

}  // namespace
}  // namespace voxdag
