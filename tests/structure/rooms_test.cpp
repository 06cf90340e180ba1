#include "rooms.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

const fs::path kSourceDir = VOXDAG_SOURCE_DIR;
const fs::path kTable = kSourceDir / "src/voxdag/rooms.txt";

void write_source(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  write_text(file, text);
}

/// Returns the rooms that the picture in HACKING.md shows: lines "  folder/  text  -> a b".
Rooms read_map(const fs::path& document) {
  const std::regex folder(R"(^  (\w+)/ .* -> ([\w ]+)$)");
  std::istringstream lines(read_text(document));
  std::string table;
  for (std::string line; std::getline(lines, line);)
    if (std::smatch parts; std::regex_match(line, parts, folder))
      table += parts[1].str() + ": " + (parts[2] == "nothing" ? "" : parts[2].str()) + "\n";
  const TempDir dir;
  write_text(dir / "map.txt", table);
  return read_rooms(dir / "map.txt");
}

TEST(Rooms, TheMapInHackingShowsTheTable) {
  const Rooms map = read_map(kSourceDir / "HACKING.md"), table = read_rooms(kTable);
  for (const auto& [folder, room] : table)
    EXPECT_TRUE(map.count(folder) != 0 && map.at(folder).rooms == room.rooms)
        << "HACKING.md: correct the line of " << folder << "/ in the map";
  for (const auto& [folder, room] : map)
    EXPECT_TRUE(table.count(folder)) << "HACKING.md: remove " << folder << "/ from the map";
}

TEST(Rooms, EverySourceIncludesOnlyWhatItsRoomMay) {
  const auto broken = broken_includes(kSourceDir / "src/voxdag", read_rooms(kTable));
  for (const std::string& line : broken) ADD_FAILURE() << line;
}

TEST(Rooms, EverySourceOfTheCommandLineIncludesOnlyWhatItsRoomMay) {
  const fs::path root = kSourceDir / "apps/voxdag";
  for (const std::string& line : broken_includes(root, read_rooms(root / "rooms.txt"), ""))
    ADD_FAILURE() << line;
}

TEST(Rooms, EverySourceOfTheViewerIncludesOnlyWhatItsRoomMay) {
  const fs::path root = kSourceDir / "apps/viewer";
  for (const std::string& line : broken_includes(root, read_rooms(root / "rooms.txt"), "viewer/"))
    ADD_FAILURE() << line;
}

TEST(Rooms, EveryBenchmarkIncludesOnlyWhatItsRoomMay) {
  const fs::path root = kSourceDir / "lab";
  for (const std::string& line : broken_includes(root, read_rooms(root / "rooms.txt"), "lab/"))
    ADD_FAILURE() << line;
}

TEST(Rooms, EveryTargetLinksOnlyWhatItsRoomMay) {
  const auto broken = broken_links(kSourceDir / "src/voxdag", read_rooms(kTable));
  for (const std::string& line : broken) ADD_FAILURE() << line;
}

TEST(Rooms, ForbiddenLinksAreFound) {
  const TempDir tree;
  write_source(tree / "builders/CMakeLists.txt",
               "voxdag_library(builders\n  LINK voxdag_mesh PNG::PNG)\n"
               "target_link_libraries(voxdag_builders PRIVATE voxdag_file)\n"
               "target_compile_options(voxdag_builders PRIVATE -O3)\n");
  const auto broken = broken_links(tree.path(), read_rooms(kTable));
  ASSERT_EQ(broken.size(), 2u);
  EXPECT_EQ(broken[0], "builders/CMakeLists.txt: links PNG::PNG");
  EXPECT_EQ(broken[1], "builders/CMakeLists.txt: links voxdag_file");
}

TEST(Rooms, UseWhatTheirRoomsUse) {
  const Rooms rooms = read_rooms(kTable);
  EXPECT_TRUE(rooms.at("builders").rooms.count("image"));
  EXPECT_TRUE(rooms.at("cpu").rooms.count("stored"));
}

TEST(Rooms, AViewerNeedsNoBuilder) {
  const Rooms rooms = read_rooms(kTable);
  for (const char* viewer : {"trace", "render", "file", "stored", "cpu", "cuda"})
    for (const char* builder : {"mesh", "builders", "formats"})
      EXPECT_FALSE(rooms.at(viewer).rooms.count(builder)) << viewer << " may include " << builder;
}

TEST(Rooms, TheDagBuilderNeedsNoFileFormats) {
  const Rooms rooms = read_rooms(kTable);
  for (const char* format : {"formats", "file"})
    EXPECT_FALSE(rooms.at("builders").rooms.count(format)) << "builders may include " << format;
  // Folders of a room may be stricter than the room.
  const fs::path root = kSourceDir / "src/voxdag";
  for (const char* folder : {"builders/voxelize", "builders/dag"})
    for (const char* format : {"core/io", "image", "mesh/surface", "mesh/displace"})
      for (const std::string& line :
           includes_of(root / folder, std::string("voxdag/") + format + "/"))
        ADD_FAILURE() << line;
}

TEST(Rooms, AForbiddenIncludeIsFoundWithItsLine) {
  const TempDir tree;
  write_source(tree / "mesh/mesh.hpp", "#include \"voxdag/mesh/other.hpp\"\n");
  write_source(tree / "mesh/other.hpp", "#include <vector>\n");
  write_source(tree / "trace/cast.hpp", "#pragma once\n  #  include \"voxdag/mesh/mesh.hpp\"\n");
  const auto broken = broken_includes(tree.path(), read_rooms(kTable));
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_EQ(broken[0], "trace/cast.hpp:2: includes voxdag/mesh/mesh.hpp");
}

TEST(Rooms, AFolderThatTheTableDoesNotNameIsFound) {
  const TempDir tree;
  write_source(tree / "misc/odd.cpp", "");
  EXPECT_EQ(broken_includes(tree.path(), read_rooms(kTable)).size(), 1u);
}

}  // namespace
}  // namespace voxdag
