#pragma once
/// Options of mesh readers.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "voxdag/core/io/mapped_arrays.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

struct ReadOptions {
  Work work = {};  ///< Counts mesh and scratch memory.
  /// If not null: the arrays of the mesh are here, and do not count as memory. It must outlive the
  /// mesh. The arrays of the appearance stay on the heap.
  MappedArrays* arrays = nullptr;
  /// Whether a mesh file may name files outside its own folder. If false, such a name is an error.
  bool allow_outside = false;
  /// Whether assimp runs in this process, where its defects are the caller's and it can open other
  /// files. If false, it runs in a confined child.
  bool any_assimp_importer = false;
  /// Whether to read the objects of the mesh: `o` and `g` of OBJ, nodes of glTF.
  bool objects = false;
  /// The extension that tells the format, "obj"; empty: that of the file's name. Formats that the
  /// content tells need none.
  std::string format = {};
  /// If not null: receives the paths of all files that the mesh names (MTL, buffers, textures), so
  /// that the caller does not overwrite them. They need not exist.
  std::vector<std::filesystem::path>* named_files = nullptr;
  /// If not null: receives the warnings of read_mesh(), which returns none.
  std::vector<std::string>* warnings = nullptr;

  /// Returns how many bytes of an array of the mesh count as memory: none if it is in a file.
  std::uint64_t counted(std::uint64_t array_bytes) const {
    return arrays == nullptr ? array_bytes : 0;
  }
};

}  // namespace voxdag
