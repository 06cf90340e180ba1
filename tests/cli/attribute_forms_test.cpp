// Tests colours, normals and materials in the compact form and the wire form, material ids, and
// alpha.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "attributes_command.hpp"
#include "json.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/file/attribute_chunks.hpp"
#include "voxdag/file/compact_file.hpp"
#include "voxdag/file/vdag_file.hpp"

namespace voxdag::cli {
namespace {

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
