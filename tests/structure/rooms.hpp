#pragma once
/// Reads a table of rooms, such as src/voxdag/rooms.txt, and finds what breaks it: includes and
/// links between the folders.
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace voxdag {

/// The folders and packages that one folder may use.
struct Room {
  std::set<std::string> rooms;     ///< Folders, itself among them; transitively closed.
  std::set<std::string> packages;  ///< Packages that it may link itself.
};
using Rooms = std::map<std::string, Room>;

/// Parses lines of "folder: folders ... | packages ..."; '#' opens a comment line.
/// Throws std::runtime_error for a name that the table does not define.
Rooms read_rooms(const std::filesystem::path& table);

/// Returns one line, "folder/file.hpp:12: includes voxdag/mesh/mesh.hpp", for every include of
/// `PREFIXfolder/file`, of a folder under `root`, that the table does not allow or that names no
/// file, and one for every source in a folder that the table does not name. With an empty prefix
/// an include that names no file under `root` is one of another tree, and allowed.
std::vector<std::string> broken_includes(const std::filesystem::path& root, const Rooms& rooms,
                                         const std::string& prefix = "voxdag/");

/// Returns one line, "file.hpp:12: includes voxdag/image/image.hpp", for every include of a path
/// that begins with `prefix` in the sources below `folder`.
std::vector<std::string> includes_of(const std::filesystem::path& folder,
                                     const std::string& prefix);

/// Returns one line, "folder/CMakeLists.txt: links PNG::PNG", for every target that a folder's
/// CMakeLists.txt links and the table does not allow.
std::vector<std::string> broken_links(const std::filesystem::path& root, const Rooms& rooms);

}  // namespace voxdag
