#include "voxdag/formats/readers/obj/obj_reader.hpp"

#include "formats/readers/mesh_text.hpp"
#include "support/with_threads.hpp"
#include "voxdag/formats/readers/used_vertices.hpp"

namespace voxdag {
namespace {

constexpr std::string_view kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Mesh square_with(std::string_view faces) {
  return read_text(read_obj, std::string(kSquare) + std::string(faces));
}

TEST(ObjReader, TriangleKeepsItsVerticesAndOrder) {
  const Mesh mesh = read_text(read_obj, "v 1 2 3\nv 4 5 6\nv 7 8 9.5\nf 3 1 2\n");
  EXPECT_EQ(mesh.vertices, (StoredVector<Vec3f>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9.5f}}));
  EXPECT_EQ(mesh.triangles, (StoredVector<Triangle>{{2, 0, 1}}));
  EXPECT_TRUE(mesh.materials.empty());
  EXPECT_TRUE(mesh.triangle_materials.empty());
}

TEST(ObjReader, EveryFormOfCornerGivesTheVertex) {
  const StoredVector<Triangle> expected{{0, 1, 2}};
  EXPECT_EQ(square_with("f 1 2 3").triangles, expected);
  EXPECT_EQ(square_with("f 1/7 2/8 3/9").triangles, expected);
  EXPECT_EQ(square_with("f 1//7 2//8 3//9").triangles, expected);
  EXPECT_EQ(square_with("f 1/4/7 2/5/8 3/6/9").triangles, expected);
  EXPECT_EQ(square_with("f -4 -3/1 -2/1/1").triangles, expected);
  EXPECT_EQ(square_with("\tf  1\t2   3  # a comment\r\n").triangles, expected);
}

TEST(ObjReader, PolygonBecomesAFan) {
  EXPECT_EQ(square_with("f 1 2 3 4").triangles, (StoredVector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ObjReader, NegativeIndicesCountFromTheLineTheyAreOn) {
  const Mesh mesh = read_text(read_obj,
                              "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n"
                              "v 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n");
  EXPECT_EQ(mesh.triangles, (StoredVector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
}

TEST(ObjReader, FacesMayComeBeforeTheirVertices) {
  EXPECT_EQ(read_text(read_obj, "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles.size(), 1u);
}

TEST(ObjReader, PointsLinesAndSmallPolygonsAreLeftOut) {
  EXPECT_EQ(square_with("p 1 2\nl 1 2 3\nf 1\nf 1 2\nf 1 2 3\n").triangles.size(), 1u);
}

TEST(ObjReader, WeightAndColourOfAVertexAreIgnored) {
  const Mesh mesh =
      read_text(read_obj, "v 1 2 3 0.5\nv 0 0 1 0.1 0.2 0.3\nv 0 1 0 1 1 1 1\nf 1 2 3\n");
  EXPECT_EQ(mesh.vertices[0], (Vec3f{1, 2, 3}));
}

TEST(ObjReader, MaterialNamesAreKeptInOrderOfUse) {
  const Mesh mesh = square_with(
      "mtllib none.mtl\nusemtl red wine \r\nf 1 2 3\nusemtl blue\nf 1 3 4\n"
      "usemtl red wine\nf 1 2 4\n");
  EXPECT_EQ(mesh.materials, (std::vector<std::string>{"red wine", "blue"}));
  EXPECT_EQ(mesh.triangle_materials, (StoredVector<std::uint32_t>{0, 1, 0}));
}

TEST(ObjReader, ObjectsAndGroupsAreKeptOnRequest) {
  const std::string text = std::string(kSquare) +
                           "f 1 2 3\no box one \nv 0 0 0\ng lid\nf 1 2 3 4\ng empty\no box two\n"
                           "f 1 2 4\ng lid\nf 2 3 4\n";
  MeshSource source{text, "mesh", {}, nullptr, {}};
  EXPECT_TRUE(read_obj(source, ReadParts::kMesh).mesh.objects.empty());
  source.options.objects = true;
  const Mesh mesh = read_obj(source, ReadParts::kMesh).mesh;
  EXPECT_EQ(mesh.objects,
            (std::vector<std::string>{"default", "box one/lid", "box two", "box two/lid"}));
  EXPECT_EQ(mesh.object_runs, (std::vector<ObjectRun>{{0, 0}, {1, 1}, {3, 2}, {4, 3}}));
}

TEST(ObjReader, GroupsOfOneNameInSeveralObjectsAreSeveralObjectsInAnyChunk) {
  std::string text = std::string(kSquare) + "g alone\nf 1 2 3\n";
  for (const char* object : {"a", "b", "x"}) {
    text += "o " + std::string(object) + "\n# " + std::string(kChunkBytes, '#');
    text += "\ng x\nf 1 2 3\nf 1 3 4\n";
  }
  MeshSource source{text, "mesh", {}, nullptr, {}};
  source.options.objects = true;
  for (const int threads : {1, 3}) {
    const Mesh mesh =
        with_threads(threads, [&] { return read_obj(source, ReadParts::kMesh).mesh; });
    EXPECT_EQ(mesh.objects, (std::vector<std::string>{"alone", "a/x", "b/x", "x"}));
    EXPECT_EQ(mesh.object_runs, (std::vector<ObjectRun>{{0, 0}, {1, 1}, {3, 2}, {5, 3}}));
  }
}

TEST(ObjReader, ObjectsKeepTheirTrianglesIfOthersAreLeftOut) {
  const std::string text =
      std::string(kSquare) + "v nan 0 0\no a\nf 1 2 5\nf 1 2 3\no b\nf 3 4 5\no c\nf 1 3 4\n";
  MeshSource source{text, "mesh", {}, nullptr, {}};
  source.options.objects = true;
  MeshWithAppearance read = read_obj(source, ReadParts::kMesh);
  remove_bad_triangles(source, used_vertices(source, read.mesh).bad_triangles, read);
  EXPECT_EQ(read.mesh.triangles.size(), 2u);
  EXPECT_EQ(read.mesh.object_runs, (std::vector<ObjectRun>{{0, 0}, {1, 1}, {1, 2}}));
}

TEST(ObjReader, FacesBeforeAnyMaterialHaveTheUnnamedOne) {
  const Mesh mesh = square_with("f 1 2 3\nusemtl blue\nf 1 3 4\n");
  EXPECT_EQ(mesh.materials, (std::vector<std::string>{"", "blue"}));
  EXPECT_EQ(mesh.triangle_materials, (StoredVector<std::uint32_t>{0, 1}));
}

TEST(ObjReader, BackslashContinuesALine) {
  EXPECT_EQ(square_with("f 1 2 \\\n 3 \\\r\n 4\n").triangles.size(), 2u);
  EXPECT_EQ(square_with("# comment \\\nf 1 2 3\n").triangles.size(), 1u);
}

TEST(ObjReader, EveryLineEndIsUnderstood) {
  const Mesh unix_ends = square_with("usemtl a\nf 1 2 3\n");
  for (const std::string end : {"\r\n", "\r"}) {
    std::string text = "\xEF\xBB\xBF";
    for (const char c : std::string(kSquare) + "usemtl a\nf 1 2 3\n")
      c == '\n' ? text += end : text += c;
    EXPECT_TRUE(read_text(read_obj, text) == unix_ends);
  }
}

TEST(ObjReader, UnusedVertexMayBeNotFinite) {
  EXPECT_EQ(square_with("v nan inf -inf\nf 1 2 3\n").vertices.size(), 5u);
}

TEST(ObjReader, RefusalsNameTheLineAndTheReason) {
  const auto refused = [](std::string_view text) {
    return refusal(read_obj, std::string(kSquare) + std::string(text));
  };
  EXPECT_EQ(refusal(read_obj, ""), "mesh: the file is empty");
  EXPECT_EQ(refused(""), "mesh: OBJ without faces: there is no surface to read");
  EXPECT_EQ(refused("f 1 2 5"), "mesh: line 5: vertex index 5 is out of range: 4 vertices");
  EXPECT_EQ(refused("f 1 2 0"), "mesh: line 5: vertex index 0 is out of range: 4 vertices");
  EXPECT_EQ(refused("\nf 1 2 -5"),
            "mesh: line 6: vertex index -5 is out of range: 4 vertices so far");
  EXPECT_EQ(refused("f 1 2 99999999999999999999"),
            "mesh: line 5: face corner '99999999999999999999' is not a vertex index");
  EXPECT_EQ(refused("f 1 2 x"), "mesh: line 5: face corner 'x' is not a vertex index");
  EXPECT_EQ(refused("v 1 2\nf 1 2 3"), "mesh: line 5: the vertex has fewer than three coordinates");
  EXPECT_EQ(refused("v 1 2 3,5\nf 1 2 3"), "mesh: line 5: coordinate '3,5' is not a number");
  EXPECT_EQ(refusal(read_obj, std::string_view("\xFF\xFEv\0", 4)),
            "mesh: OBJ in UTF-16: save it as ASCII or UTF-8");
}

TEST(ObjReader, ValuesAndFacesMayAlternateOften) {
  // Beyond ObjChunk::kMaxRuns the passes no longer skip each other's lines.
  for (const int groups : {1, 3, 400, 3'000}) {
    std::string text = "f 1 2 3\n";
    StoredVector<Vec3f> vertices;
    StoredVector<Triangle> triangles{{0, 1, 2}};
    for (int g = 0; g < groups; ++g) {
      const std::uint32_t first = 3 * static_cast<std::uint32_t>(g);
      const auto x = static_cast<float>(g);
      text += "# a group\nusemtl m" + std::to_string(g % 5) + "\n";
      for (const Vec3f v : {Vec3f{x, 0, 0}, Vec3f{x, 1, 0}, Vec3f{x, 0, 1}}) {
        vertices.push_back(v);
        text += "v " + std::to_string(g) + (v.y > 0 ? " 1" : " 0") + (v.z > 0 ? " 1" : " 0") + "\n";
        text += "  vt 0 0\n";
      }
      text += "vn 0 0 1\ns off\nf -3/-1 -2/-2 -1/-3\nf 1 -1 -2\n";
      triangles.push_back({first, first + 1, first + 2});
      triangles.push_back({0, first + 2, first + 1});
    }
    const Mesh mesh = read_text(read_obj, text);
    EXPECT_EQ(mesh.vertices, vertices) << groups;
    EXPECT_EQ(mesh.triangles, triangles) << groups;
    for (std::size_t t = 1; t < triangles.size(); ++t)
      EXPECT_EQ(mesh.materials[mesh.triangle_materials[t]], "m" + std::to_string((t - 1) / 2 % 5));
  }
}

TEST(ObjReader, AnyPrefixIsSafe) {
  expect_any_prefix_is_safe(read_obj,
                            "# c\nmtllib a.mtl\nv 0 0 0 \\\n 1\r\nv 1e0 0 0\nv 0 -1.5 0\n"
                            "usemtl m\nf 1/1/1 2//2 \\\n -1 1\nf 1 2 3\n");
}

TEST(ObjReader, ALargeFileReadsLikeItsParts) {
  std::string text;
  StoredVector<Triangle> expected;
  for (std::uint32_t i = 0; i < 60'000; ++i) {
    for (const char* rest : {" 0 0\n", " 1 0.5\n", " 0 1\n"})
      text.append("v ").append(std::to_string(i)).append(rest);
    const std::string first = i % 2 ? "-3" : std::to_string(3 * i + 1);
    text.append("f ").append(first).append(" -2 -1\n");
    if (i % 1000 == 0) text.append("usemtl m").append(std::to_string(i / 1000 % 7)).append("\n");
    expected.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Mesh mesh = read_text(read_obj, text);
  EXPECT_EQ(mesh.triangles, expected);
  ASSERT_EQ(mesh.vertices.size(), 180'000u);
  for (std::size_t i = 0; i < 60'000; ++i)
    EXPECT_EQ(mesh.vertices[3 * i + 1], (Vec3f{static_cast<float>(i), 1, 0.5f}));
  EXPECT_EQ(mesh.materials[mesh.triangle_materials[0]], "");
  for (std::size_t i = 1; i < 60'000; ++i)
    EXPECT_EQ(mesh.materials[mesh.triangle_materials[i]],
              std::string("m").append(std::to_string((i - 1) / 1000 % 7)));
  EXPECT_EQ(refusal(read_obj, text + "f 1 2 bad\n"),
            "mesh: line 240061: face corner 'bad' is not a vertex index");
}

}  // namespace
}  // namespace voxdag
