#pragma once
/// Parses the chunks of MagicaVoxel's .vox files.
///
/// Format: "MagicaVoxel .vox File Format" and its extension (github.com/ephtracy/voxel-model).
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "voxdag/core/vec.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// A box of voxels. In the file, a voxel is 4 bytes: x, y, z and the index of its colour; index 0
/// is an empty voxel.
struct VoxModel {
  Vec3i size;                     ///< Voxels, 1 to 256 a side.
  std::uint64_t first_voxel = 0;  ///< Byte in the file.
  std::uint32_t count = 0;        ///< Voxels in the file, also empty ones.
  Vec3i lo{256, 256, 256}, hi{};  ///< Least and greatest coordinates of the voxels.
  bool is_empty() const { return lo.x > hi.x; }
  bool contains(Vec3i voxel) const {
    return voxel.x < size.x && voxel.y < size.y && voxel.z < size.z;
  }
};

/// A signed permutation of the axes: component `row` of the result is component `axis[row]`,
/// negated if `is_negative[row]`.
struct VoxRotation {
  std::array<std::uint8_t, 3> axis{0, 1, 2};
  std::array<bool, 3> is_negative{};
};

struct VoxNode {
  enum class Kind : std::uint8_t { kTransform, kGroup, kShape };
  Kind kind = Kind::kGroup;
  bool is_hidden = false;
  std::int32_t layer = -1;
  VoxRotation rotation;
  Vec3i translation;
  std::vector<std::int32_t> children;  ///< Ids of nodes; the index of a shape's first model.
  std::uint64_t byte = 0;              ///< Of the chunk, for errors.
};

struct VoxFile {
  std::vector<VoxModel> models;
  std::array<Rgb8, 256> palette{};
  std::map<std::int32_t, VoxNode> nodes;  ///< By id; empty for a file without a scene.
  std::set<std::int32_t> hidden_layers;
  std::vector<std::string> warnings;
};

/// Parses a file's bytes; memory is a small multiple of them. Ignores chunks of other kinds; IMAP
/// is one of them, because it only sorts the palette that MagicaVoxel shows. Throws Error with the
/// byte.
VoxFile parse_vox(const std::filesystem::path& path, std::string_view bytes);

}  // namespace voxdag
