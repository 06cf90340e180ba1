// Tests `voxdag build --color --normal` and the commands that use such files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "colored_waves.hpp"
#include "json.hpp"
#include "npy_rays.hpp"
#include "process.hpp"
#include "support/temp_dir.hpp"
#include "support/test_rays.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/file/vdag_file.hpp"

namespace voxdag::cli {
namespace {

constexpr const char* kDtype =
    "[('t', '<f4'), ('voxel', '<i4', (3,)), ('face', '|i1'), ('hit', '|b1'), "
    "('normal', '<f4', (3,)), ('color', '|u1', (3,))]";
constexpr std::size_t kRowBytes = 33;
constexpr std::size_t kGeometryBytes = 18;  ///< The bytes of a row before the normal.

/// A row of the traced hits.
struct Hit {
  explicit Hit(const std::string& row)
      : geometry(row.substr(0, kGeometryBytes)), is_hit(row[kGeometryBytes - 1] != 0) {
    std::memcpy(&normal, row.data() + kGeometryBytes, sizeof normal);
    std::memcpy(color.data(), row.data() + kGeometryBytes + sizeof normal, sizeof color);
  }

  std::string geometry;  ///< The bytes of t, voxel, face and hit.
  bool is_hit;
  Vec3f normal;
  std::array<std::uint8_t, 3> color{};
};

class AttributesCommand : public testing::Test {
 protected:
  AttributesCommand() { write_text(dir_ / "waves.obj", colored_waves()); }

  ProcessResult run_build(const std::string& name, std::vector<std::string> options) const {
    options.insert(options.begin(), {"build", dir_ / "waves.obj", "-r", "64", "-o", dir_ / name});
    return run_voxdag(options);
  }
  std::string build(const std::string& name, const std::vector<std::string>& options) const {
    const ProcessResult result = run_build(name, options);
    EXPECT_EQ(result.status, 0) << result.err;
    return dir_ / name;
  }
  std::vector<std::string> trace(const std::string& scene,
                                 const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"trace",           scene, "--rays",
                                      dir_ / "rays.npy", "-o",  dir_ / "hits.npy"};
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    NpyReader reader(dir_ / "hits.npy", kDtype, {}, kRowBytes);
    std::vector<std::string> rows(reader.rows(), std::string(kRowBytes, '\0'));
    for (std::string& row : rows) reader.read_rows(row.data(), 1);
    return rows;
  }
  void write_rays(const Grid& grid) const {
    TestRays source(grid, 1);
    std::vector<std::array<float, 8>> rays(3000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray ray = source.make(static_cast<RayKind>(i % static_cast<int>(RayKind::kCount)));
      std::memcpy(rays[i].data(), &ray, sizeof ray);
    }
    write_text(dir_ / "rays.npy", rays_npy(rays));
  }

  TempDir dir_;
};

/// The encoder of ESVOs rounds differently, so colours and normals are only similar.
TEST_F(AttributesCommand, HitsHaveTheColoursAndNormalsOfAnEsvoOfTheSameVoxels) {
  const std::string dag = build("a.vdag", {"--color", "--normal", "--color-bound", "0"});
  const std::string esvo = build("a.esvo", {"--no-contours"});
  write_rays(VdagFile(dag).grid());
  const std::vector<std::string> of_dag = trace(dag), of_esvo = trace(esvo);
  ASSERT_EQ(of_dag.size(), of_esvo.size());
  int hits = 0;
  double color_distances = 0, cosines = 0;
  for (std::size_t i = 0; i < of_dag.size(); ++i) {
    const Hit a(of_dag[i]), b(of_esvo[i]);
    ASSERT_EQ(a.geometry, b.geometry);
    if (!a.is_hit) continue;
    ++hits;
    cosines += static_cast<double>(dot(a.normal, b.normal));
    for (std::size_t c = 0; c < 3; ++c) color_distances += std::abs(a.color[c] - b.color[c]) / 3.0;
  }
  ASSERT_GT(hits, 300);
  EXPECT_LT(color_distances / hits, 8);
  EXPECT_GT(cosines / hits, 0.995);
}

TEST_F(AttributesCommand, ACopyOfTheLookGivesTheSameHits) {
  const std::string colored = build("a.vdag", {"--color", "--normal"}), grey = build("b.vdag", {});
  write_rays(VdagFile(colored).grid());
  EXPECT_EQ(trace(grey, {"--look", colored}), trace(colored));
}

TEST_F(AttributesCommand, TheGeometryIsThatOfABuildWithoutColours) {
  const VdagFile colored(build("a.vdag", {"--color"})), grey(build("b.vdag", {}));
  for (std::size_t i = 1; i < 4; ++i) {
    const VdagChunk &a = colored.chunks()[i], &b = grey.chunks()[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_TRUE(std::equal(a.bytes.begin(), a.bytes.end(), b.bytes.begin(), b.bytes.end()));
  }
  EXPECT_EQ(colored.metadata().counts, grey.metadata().counts);
  EXPECT_EQ(colored.metadata().source, grey.metadata().source);
}

TEST_F(AttributesCommand, AnyNumberOfThreadsWritesTheSameFile) {
  const std::vector<std::string> options = {"--color", "--normal", "--threads"};
  const auto with = [&](const std::string& name, const std::string& threads) {
    std::vector<std::string> all = options;
    all.push_back(threads);
    return read_text(build(name, all));
  };
  EXPECT_EQ(with("a.vdag", "1"), with("b.vdag", "3"));
}

TEST_F(AttributesCommand, InfoTellsTheirSizesAndErrors) {
  const std::string dag = build("a.vdag", {"--color", "--normal", "--attribute-resolution", "32"});
  const auto json = nlohmann::json::parse(run_voxdag({"info", dag, "--json"}).out);
  const auto& attributes = json.at("attributes");
  for (const char* kind : {"color", "normal"}) {
    EXPECT_EQ(attributes.at(kind).at("resolution"), 32);
    EXPECT_EQ(attributes.at(kind).at("cells"), json.at("svo_nodes"));
    EXPECT_GT(attributes.at(kind).at("bits_per_cell"), 0);
  }
  EXPECT_GT(attributes.at("color").at("psnr_db"), 25);
  EXPECT_LT(attributes.at("normal").at("mean_degrees"), 4);
  const std::string text = run_voxdag({"info", dag}).out;
  for (const char* part : {"colours", "normals", "bits/cell", "PSNR"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  const std::string lossless = build("b.vdag", {"--color", "--color-bound", "0"});
  const auto exact = nlohmann::json::parse(run_voxdag({"info", lossless, "--json"}).out);
  EXPECT_TRUE(exact.at("attributes").at("color").at("psnr_db").is_null());
  EXPECT_NE(run_voxdag({"info", lossless}).out.find("bits/cell, lossless"), std::string::npos);
}

TEST_F(AttributesCommand, VerifyChecksThem) {
  const std::string dag = build("a.vdag", {"--color", "--normal"});
  EXPECT_EQ(run_voxdag({"verify", dag}).status, 0);
  std::string bytes = read_text(dag);
  const VdagChunkEntry normals = find_entry(bytes, kChunkNormals);
  bytes[normals.offset + normals.length - 1] ^= 1;
  write_text(dag, bytes);
  EXPECT_EQ(run_voxdag({"verify", dag}).status, 1);
}

TEST_F(AttributesCommand, PicturesShowThem) {
  const std::string dag = build("a.vdag", {"--color"}), grey = build("b.vdag", {});
  const auto picture = [&](const std::string& scene) {
    const ProcessResult result =
        run_voxdag({"render", scene, "--size", "64x64", "--ao", "0", "-o", dir_ / "a.png"});
    EXPECT_EQ(result.status, 0) << result.err;
    return read_text(dir_ / "a.png");
  };
  EXPECT_NE(picture(dag), picture(grey));
}

TEST_F(AttributesCommand, ConvertKeepsOrDropsThem) {
  const std::string colored = build("a.vdag", {"--color", "--normal"}), grey = build("b.vdag", {});
  const auto convert = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"convert", colored, "-o", dir_ / "c.vdag"});
    return run_voxdag(options);
  };
  ASSERT_EQ(convert({}).status, 0);
  EXPECT_EQ(read_text(dir_ / "c.vdag"), read_text(colored));
  ASSERT_EQ(convert({"--drop-attributes"}).status, 0);
  EXPECT_EQ(read_text(dir_ / "c.vdag"), read_text(grey));
  EXPECT_EQ(convert({"--compact", "--drop-attributes"}).status, 0);
}

TEST_F(AttributesCommand, TheCompactFormKeepsThem) {
  const std::string plain = build("a.vdag", {"--color", "--normal"}), small = dir_ / "b.vdag";
  ASSERT_EQ(run_voxdag({"convert", plain, "--compact", "-o", small}).status, 0);
  EXPECT_EQ(read_text(build("c.vdag", {"--color", "--normal", "--compact"})), read_text(small));
  ASSERT_EQ(run_voxdag({"convert", small, "--plain", "-o", dir_ / "d.vdag"}).status, 0);
  EXPECT_EQ(read_text(dir_ / "d.vdag"), read_text(plain));
  EXPECT_EQ(run_voxdag({"verify", small}).status, 0);
  EXPECT_NE(run_voxdag({"info", small}).out.find("cell numbers"), std::string::npos);
  const auto info = [](const std::string& file) {
    return nlohmann::json::parse(run_voxdag({"info", file, "--json"}).out);
  };
  EXPECT_EQ(info(small).at("attributes"), info(plain).at("attributes"));
  EXPECT_GT(info(small).at("bytes").at("compact"), 0);
  write_rays(VdagFile(plain).grid());
  EXPECT_EQ(trace(small), trace(plain));
  const std::string grey = build("e.vdag", {});
  EXPECT_EQ(trace(grey, {"--look", small}), trace(plain));
}

TEST_F(AttributesCommand, DamagedColoursOfACompactFileAreRefusedByPlace) {
  const std::string dag = build("a.vdag", {"--color", "--compact"});
  std::string bytes = read_text(dag);
  bytes[bytes.size() - 65] ^= 1;
  write_text(dag, bytes);
  expect_failure(run_voxdag({"info", dag}), 1, "chunk COLR: checksum is wrong");
  expect_failure(run_voxdag({"verify", dag, "--quiet"}), 1, "chunk COLR: checksum is wrong");
}

TEST_F(AttributesCommand, ExportWritesThem) {
  const std::string plain = build("a.vdag", {"--color", "--normal"}), grey = build("b.vdag", {}),
                    small = build("c.vdag", {"--color", "--normal", "--compact"});
  const auto exported = [&](const std::string& file, const std::string& to,
                            std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"export", file, "--quiet", "-o", dir_ / to});
    const ProcessResult result = run_voxdag(options);
    EXPECT_EQ(result.status, 0) << result.err;
    return read_text(dir_ / to);
  };
  for (const char* to : {"v.npy", "v.ply"}) {
    const std::string colored = exported(plain, to), plainly = exported(grey, to);
    EXPECT_GT(colored.size(), 1.9 * static_cast<double>(plainly.size()));
    EXPECT_EQ(exported(small, to), colored);
    EXPECT_EQ(exported(plain, to, {"--grey"}), plainly);
    EXPECT_EQ(exported(grey, to, {"--look", small}), colored);
  }
  EXPECT_NE(exported(plain, "f.ply", {"--faces"}).find("property uchar red"), std::string::npos);
  expect_failure(run_voxdag({"export", plain, "--grey", "-o", dir_ / "v.raw"}), 2,
                 "cannot hold colours");
}

TEST_F(AttributesCommand, ACoarserGridKeepsTheColoursOfItsCells) {
  const std::string fine = build("a.vdag", {"--color", "--normal", "--color-bound", "0.03",
                                            "--normal-bound", "4"}),
                    coarse = dir_ / "b.vdag", same = dir_ / "c.vdag";
  ASSERT_EQ(run_voxdag({"convert", fine, "--levels", "4", "-o", coarse}).status, 0);
  EXPECT_EQ(run_voxdag({"verify", coarse}).status, 0);
  const auto attributes = [](const std::string& file) {
    return nlohmann::json::parse(run_voxdag({"info", file, "--json"}).out).at("attributes");
  };
  EXPECT_EQ(attributes(coarse).at("color").at("resolution"), 16);
  EXPECT_EQ(attributes(coarse).at("color").at("bound"), 0.03);
  EXPECT_FALSE(attributes(coarse).at("color").contains("psnr_db"));
  EXPECT_FALSE(attributes(coarse).at("normal").contains("mean_degrees"));
  ASSERT_EQ(run_voxdag({"convert", fine, "--levels", "4", "--color-bound", "0.02", "--normal-bound",
                        "3", "-o", same})
                .status,
            0);
  EXPECT_EQ(attributes(same).at("color").at("bound"), 0.05);
  EXPECT_EQ(attributes(same).at("normal").at("bound"), 7);
  EXPECT_LT(attributes(same).at("color").at("bytes"), attributes(coarse).at("color").at("bytes"));
  expect_failure(run_voxdag({"convert", fine, "--color-bound", "0.1", "-o", same}), 2,
                 "without --levels");
  // Attributes that are as coarse as the coarse grid keep their bytes and errors.
  const std::string coarsely = build("d.vdag", {"--color", "--attribute-resolution", "16"});
  ASSERT_EQ(run_voxdag({"convert", coarsely, "--levels", "4", "--compact", "-o", same}).status, 0);
  EXPECT_EQ(attributes(same).at("color"), attributes(coarsely).at("color"));
  // Hits at the coarse voxels show what the fine file stores for these cells.
  write_rays(VdagFile(coarse).grid());
  EXPECT_EQ(trace(coarse), trace(coarse, {"--look", fine}));
}

TEST_F(AttributesCommand, VerifyComparesThemWithTheMesh) {
  const std::string dag = build("a.vdag", {"--color", "--normal", "--compact"}),
                    mesh = dir_ / "waves.obj";
  const ProcessResult result = run_voxdag({"verify", dag, "--mesh", mesh});
  EXPECT_EQ(result.status, 0) << result.err;
  for (const char* text : {"colours         passed", "normals         passed", "largest error 0.0"})
    EXPECT_NE(result.out.find(text), std::string::npos) << text << "\n" << result.out;
  // The red of the first block of colours changes; all checksums are right. Its bits follow the 9
  // bits of the block's header at the start of the chunk's words.
  std::string bytes = read_text(dag);
  const std::uint64_t chunk = find_entry(bytes, kChunkColors).offset;
  const CellPagesView pages{.values = peek<ValuePagesHeader>(bytes, chunk).values};
  const std::uint64_t words = chunk + sizeof(ValuePagesHeader) + 8 * pages.group_count();
  bytes[words + 1] ^= 0x30;
  repair_checksums(bytes);
  write_text(dag, bytes);
  EXPECT_EQ(run_voxdag({"verify", dag}).status, 0);
  expect_failure(run_voxdag({"verify", dag, "--mesh", mesh, "--quiet"}), 1,
                 "the bound and rounding allow");
}

TEST_F(AttributesCommand, MaterialsAreStoredShownAndChecked) {
  const std::string mesh = dir_ / "parts.obj", dag = dir_ / "a.vdag", small = dir_ / "b.vdag";
  write_text(mesh, colored_waves(true));
  const auto run = [](const std::vector<std::string>& words) {
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  };
  run({"build", mesh, "-r", "64", "--material-ids", "-o", dag});
  run({"convert", dag, "--compact", "-o", small});
  const auto material =
      nlohmann::json::parse(run({"info", small, "--json"})).at("attributes").at("material");
  EXPECT_EQ(material.at("names"), nlohmann::json({"left", "middle", "right"}));
  EXPECT_EQ(material.at("resolution"), 64);
  EXPECT_NE(run({"info", dag}).find("3 materials"), std::string::npos);
  EXPECT_NE(run({"verify", small, "--mesh", mesh}).find("material ids    passed"),
            std::string::npos);

  // The materials lie side by side in x.
  std::vector<std::array<float, 8>> rays;
  for (int x = 0; x < 20; ++x)
    rays.push_back({static_cast<float>(x) + 0.5f, 100, 9.3f, 0, 0, -1, 0, 1000});
  rays.push_back({-5, 100, 9, 0, 0, -1, 0, 1000});  // misses
  write_text(dir_ / "rays.npy", rays_npy(rays));
  run({"trace", small, "--rays", dir_ / "rays.npy", "-o", dir_ / "hits.npy"});
  NpyReader reader(dir_ / "hits.npy",
                   "[('t', '<f4'), ('voxel', '<i4', (3,)), ('face', '|i1'), ('hit', '|b1'), "
                   "('material', '<u2')]",
                   {}, 20);
  std::string row(20, '\0');
  for (int x = 0; x <= 20; ++x) {
    ASSERT_EQ(reader.read_rows(row.data(), 1), 1u);
    EXPECT_EQ(peek<std::uint16_t>(row, 18), x == 20 ? 65535 : x / 7) << x;
  }

  const auto picture = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"render", small, "--size", "64x64",
                                      "--ao",   "0",   "-o",     dir_ / "a.png"};
    words.insert(words.end(), more.begin(), more.end());
    run(words);
    return read_text(dir_ / "a.png");
  };
  EXPECT_NE(picture({"--materials"}), picture({}));
}

TEST_F(AttributesCommand, MaterialIdsNeedMaterials) {
  expect_failure(run_build("a.vdag", {"--material-ids"}), 1, "waves.obj: has no materials");
  const std::string dag = build("b.vdag", {"--color"});
  expect_failure(run_voxdag({"render", dag, "--materials", "-o", dir_ / "a.png"}), 1,
                 "has no material ids");
  EXPECT_EQ(dir_.count(), 2);
}

TEST_F(AttributesCommand, OptionsWithoutEffectAreRefused) {
  expect_failure(run_build("a.vdag", {"--attribute-resolution", "32"}), 2, "without --color");
  expect_failure(run_build("a.vdag", {"--normal", "--color-bound", "0.1"}), 2, "without --color");
  expect_failure(run_build("a.vdag", {"--color", "--normal-bound", "3"}), 2, "without --normal");
  expect_failure(run_build("a.vdag", {"--color", "--attribute-resolution", "128"}), 2,
                 "128 is more than the grid's resolution, 64");
  expect_failure(run_voxdag({"build", dir_ / "waves.obj", "--voxel-size", "1", "-o",
                             dir_ / "a.vdag", "--color", "--attribute-resolution", "1024"}),
                 1, "1024 is more than the grid's resolution, ");
  expect_failure(run_build("a.esvo", {"--color"}), 2, "is for DAGs only");
  EXPECT_EQ(dir_.count(), 1);
}

TEST_F(AttributesCommand, TheWireFormIsSmallerAndGoesThroughEveryCommand) {
  write_text(dir_ / "waves.obj", colored_waves(true));
  const std::string pages =
      build("pages.vdag", {"--color", "--normal", "--material-ids", "--compact"});
  const std::string wire = dir_ / "wire.vdag";
  const auto succeed = [](const std::vector<std::string>& words) {
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return result.out;
  };
  succeed({"convert", pages, "--wire", "-o", wire});
  EXPECT_LT(std::filesystem::file_size(wire), std::filesystem::file_size(pages));
  const auto json = nlohmann::json::parse(succeed({"info", wire, "--json"}));
  EXPECT_EQ(json.at("attributes").at("color").at("form"), "wire");
  EXPECT_EQ(json.at("attributes").at("material").at("form"), "wire");
  EXPECT_NE(succeed({"info", wire}).find("wire form"), std::string::npos);
  succeed({"verify", wire, "--mesh", dir_ / "waves.obj"});
  // The way back, from the compact and from the plain form.
  succeed({"convert", wire, "-o", dir_ / "back.vdag"});
  EXPECT_EQ(read_text(dir_ / "back.vdag"), read_text(pages));
  succeed({"convert", wire, "--plain", "--wire", "-o", dir_ / "plain_wire.vdag"});
  succeed({"verify", dir_ / "plain_wire.vdag"});
  succeed({"convert", dir_ / "plain_wire.vdag", "--compact", "-o", dir_ / "back.vdag"});
  EXPECT_EQ(read_text(dir_ / "back.vdag"), read_text(pages));
  write_rays(CompactFile(wire).grid());
  const auto hits = [&](const std::string& scene) {
    succeed({"trace", scene, "--rays", dir_ / "rays.npy", "-o", dir_ / "hits.npy"});
    return read_text(dir_ / "hits.npy");
  };
  EXPECT_EQ(hits(wire), hits(pages));
  EXPECT_EQ(hits(dir_ / "plain_wire.vdag"), hits(pages));
  // A limit below the expanded attributes is refused, and nothing is written.
  const ProcessResult refused =
      run_voxdag({"convert", wire, "--memory", "1M", "-o", dir_ / "none.vdag"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_FALSE(std::filesystem::exists(dir_ / "none.vdag"));
  // Broken bytes of the coded values, with a right checksum of none.
  std::string bytes = read_text(wire);
  bytes[bytes.size() - 200] ^= 1;
  write_text(dir_ / "broken.vdag", bytes);
  const ProcessResult broken = run_voxdag({"info", dir_ / "broken.vdag"});
  EXPECT_EQ(broken.status, 1);
  EXPECT_NE(broken.err.find("checksum"), std::string::npos) << broken.err;
}

/// A square whose texture is red and visible in its left half only.
TEST_F(AttributesCommand, AlphaCutsVoxelsOrKeepsThemWithTheNearestVisibleColour) {
  std::string tga("\0\0\2\0\0\0\0\0\0\0\0\0\x40\0\x40\0\x20\x08", 18);
  for (int i = 0; i < 64 * 64; ++i)
    tga += i % 64 < 32 ? std::string("\0\0\xFF\xFF", 4) : std::string(4, '\0');
  write_text(dir_ / "leaf.tga", tga);
  write_text(dir_ / "leaf.mtl", "newmtl leaf\nmap_Kd leaf.tga\n");
  write_text(dir_ / "leaf.obj",
             "mtllib leaf.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
             "vt 0 1\nusemtl leaf\nf 1/1 2/2 3/3 4/4\n");
  const auto voxels = [&](const std::string& name, std::vector<std::string> options) {
    options.insert(options.begin(),
                   {"build", dir_ / "leaf.obj", "-r", "256", "-o", dir_ / name, "--json"});
    const ProcessResult result = run_voxdag(options);
    EXPECT_EQ(result.status, 0) << result.err;
    const ProcessResult check = run_voxdag({"verify", dir_ / name, "--mesh", dir_ / "leaf.obj"});
    EXPECT_EQ(check.status, 0) << check.err;
    return nlohmann::json::parse(result.out)["voxels"].get<int>();
  };
  EXPECT_EQ(voxels("shape.vdag", {}), 256 * 256);
  EXPECT_EQ(voxels("kept.vdag", {"--color", "--color-bound", "0", "--alpha", "keep"}), 256 * 256);
  const int cut = voxels("cut.vdag", {"--color"});
  EXPECT_EQ(cut, voxels("cut_shape.vdag", {"--alpha", "cut"}));
  EXPECT_NEAR(cut, 128 * 256, 256);  // The grid is 1/256 voxel wider than the square.
  ASSERT_EQ(run_voxdag({"export", dir_ / "kept.vdag", "-o", dir_ / "kept.npy"}).status, 0);
  constexpr std::size_t kRow = 15;  // a voxel's three numbers and its colour
  NpyReader reader(dir_ / "kept.npy", "[('voxel', '<i4', (3,)), ('color', '|u1', (3,))]", {}, kRow);
  std::string row(kRow, '\0');
  for (std::uint64_t i = 0; i < reader.rows(); ++i) {
    reader.read_rows(row.data(), 1);
    ASSERT_EQ(row.substr(12), std::string("\xFF\0\0", 3)) << i;
  }
  expect_failure(run_voxdag({"build", dir_ / "leaf.obj", "-r", "64", "-o", dir_ / "a.vdag",
                             "--solid", "--alpha", "cut"}),
                 2, "--solid fills the whole surface");
}

}  // namespace
}  // namespace voxdag::cli
