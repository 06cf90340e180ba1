#include "viewer/scene/scene_bytes.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "http_client.hpp"
#include "support/error_of.hpp"
#include "support/vdag_bytes.hpp"
#include "viewer/server/page_server.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_bytes.hpp"

namespace voxdag {
namespace {

using namespace std::chrono_literals;

std::string all_bytes(const SceneBytes& scene) {
  std::string bytes(scene.size(), '\0');
  EXPECT_TRUE(scene.read(0, std::as_writable_bytes(std::span(bytes))));
  return bytes;
}

Svdag example_dag() { return brute_svdag(6, random_voxels(6, 300, 5)); }

/// Returns the bytes of a valid file that is as large as wanted: readers skip its chunk FILL.
std::string large_file(std::size_t filler_bytes) {
  const Svdag dag = example_dag();
  const std::string json = checked_metadata_json(example_metadata(dag.view()));
  const std::string filler(filler_bytes, 'f');
  const auto chunk = [](std::uint32_t id, std::uint32_t flags, const auto& values) {
    return OutputChunk{id, flags, {std::as_bytes(std::span(values))}};
  };
  const VdagBytes bytes(
      {chunk(kChunkMeta, 1, json),
       chunk(kChunkLevels, 1,
             std::span(dag.level_begin).first(static_cast<std::size_t>(dag.levels - 1))),
       chunk(kChunkNodes, 1, dag.nodes), chunk(kChunkLeafBlocks, 1, dag.leaf_blocks),
       chunk(vdag_chunk_id("FILL"), 0, filler)});
  std::string text;
  for (const auto& part : bytes.parts())
    text.append(reinterpret_cast<const char*>(part.data()), part.size());
  return text;
}

TEST(SceneBytes, AFileIsReadAsItIs) {
  const TempDir dir;
  const std::string bytes = vdag_file_bytes(example_dag());
  write_text(dir / "a.vdag", bytes);
  EXPECT_EQ(all_bytes(*open_scene_bytes(dir / "a.vdag")), bytes);
}

TEST(SceneBytes, ADagInMemoryHasTheBytesOfItsFile) {
  const Svdag dag = example_dag();
  const std::string bytes = vdag_file_bytes(dag);
  const auto scene = make_scene_bytes(dag.view(), example_metadata(dag.view()));
  ASSERT_EQ(scene->size(), bytes.size());
  EXPECT_EQ(all_bytes(*scene), bytes);
  for (std::size_t first = 0; first < bytes.size(); first += 61)
    for (const std::size_t count : {1, 17, 500}) {
      std::string part(std::min(count, bytes.size() - first), '\0');
      EXPECT_TRUE(scene->read(first, std::as_writable_bytes(std::span(part))));
      EXPECT_EQ(part, bytes.substr(first, count));
    }
}

TEST(SceneBytes, EqualBytesHaveEqualTags) {
  const TempDir dir;
  const Svdag dag = example_dag(), other = brute_svdag(6, random_voxels(6, 300, 6));
  write_vdag(dir / "a.vdag", dag.view(), example_metadata(dag.view()));
  const std::string tag = open_scene_bytes(dir / "a.vdag")->tag();
  EXPECT_EQ(make_scene_bytes(dag.view(), example_metadata(dag.view()))->tag(), tag);
  EXPECT_NE(make_scene_bytes(other.view(), example_metadata(other.view()))->tag(), tag);
}

TEST(SceneBytes, ADamagedFileIsRefused) {
  const TempDir dir;
  const std::string bytes = vdag_file_bytes(example_dag()), name = dir / "a.vdag";
  for (std::size_t at = 0; at < bytes.size(); at += 37) {
    std::string damaged = bytes;
    damaged[at] ^= 4;
    write_text(dir / "a.vdag", damaged);
    EXPECT_TRUE(error_of([&] { open_scene_bytes(dir / "a.vdag"); }).starts_with(name)) << at;
    write_text(dir / "a.vdag", bytes.substr(0, at));
    EXPECT_TRUE(error_of([&] { open_scene_bytes(dir / "a.vdag"); }).starts_with(name)) << at;
  }
}

TEST(SceneBytes, TheOutlineOfALargeFileIsChecked) {
  const TempDir dir;
  std::string bytes = large_file(kWholeCheckBytes), name = dir / "a.vdag";
  write_text(dir / "a.vdag", bytes);
  EXPECT_EQ(open_scene_bytes(dir / "a.vdag")->size(), bytes.size());
  const std::size_t meta = peek<std::uint64_t>(bytes, entry_offset(0) + 8);
  for (const std::size_t at : {std::size_t{8}, entry_offset(2) + 8, meta + 3}) {
    bytes[at] ^= 4;
    write_text(dir / "a.vdag", bytes);
    EXPECT_TRUE(error_of([&] { open_scene_bytes(dir / "a.vdag"); }).starts_with(name)) << at;
    bytes[at] ^= 4;
  }
  write_text(dir / "a.vdag", bytes.substr(0, bytes.size() - 64));
  EXPECT_NE(error_of([&] { open_scene_bytes(dir / "a.vdag"); }).find("truncated"),
            std::string::npos);
}

TEST(SceneBytes, AFileThatTakesTheNameDoesNotMatter) {
  const TempDir dir;
  const std::string bytes = vdag_file_bytes(example_dag());
  write_text(dir / "a.vdag", bytes);
  const auto scene = open_scene_bytes(dir / "a.vdag");
  write_text(dir / "b.vdag", "other");
  std::filesystem::rename(dir / "b.vdag", dir / "a.vdag");
  EXPECT_TRUE(scene->is_unchanged());
  EXPECT_EQ(all_bytes(*scene), bytes);
}

TEST(SceneBytes, AFileThatShrinksWhileServedIsAnError) {
  const TempDir dir;
  const std::string bytes = large_file(std::size_t{40} << 20);
  write_text(dir / "a.vdag", bytes);
  const auto scene = open_scene_bytes(dir / "a.vdag");
  PageServer server(*scene, {});
  server.start();
  EXPECT_EQ(get(server.port(), "/scene.vdag", "Range: bytes=0-99\r\n").body, bytes.substr(0, 100));
  HttpClient client(server.port(), 4096);
  client.send(request("/scene.vdag"));
  ASSERT_TRUE(client.fill(1000));
  std::filesystem::resize_file(dir / "a.vdag", 1'000'000);
  EXPECT_FALSE(client.answer().is_complete);
  EXPECT_EQ(get(server.port(), "/scene.vdag").status, 500);
  EXPECT_EQ(get(server.port(), "/scene.vdag", "Range: bytes=0-99\r\n").status, 500);
  EXPECT_EQ(get(server.port(), "/").status, 200);
}

}  // namespace
}  // namespace voxdag
