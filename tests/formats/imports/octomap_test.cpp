// Maps of OctoMap, which the tests write node by node, against the voxels that they hold.
#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "support/brute_svdag.hpp"
#include "support/random_bits.hpp"
#include "support/voxel_sets.hpp"
#include "volume_files.hpp"

namespace voxdag {
namespace {

/// Keys of voxels, 0 to 65,535.
using MapKeys = std::vector<Vec3i>;

/// Returns the keys in a cell that begins at `corner`.
MapKeys keys_in(const MapKeys& keys, Vec3i corner, int side) {
  MapKeys inside;
  for (const Vec3i key : keys)
    if (min(key, corner) == corner && max(key, corner + Vec3i{side - 1, side - 1, side - 1}) ==
                                          corner + Vec3i{side - 1, side - 1, side - 1})
      inside.push_back(key);
  return inside;
}
Vec3i map_child(Vec3i corner, int child, int half) {
  return corner + Vec3i{child & 1, child >> 1 & 1, child >> 2 & 1} * half;
}
bool is_full(const MapKeys& keys, int side) {
  return side <= 64 && keys.size() == static_cast<std::size_t>(side) * side * side;
}

/// Writes the nodes of a .bt. Full cells are leaves; each 3rd cell without voxels is free, the
/// others are unknown.
std::string binary_nodes(const MapKeys& keys, Vec3i corner, int side) {
  std::string states(2, '\0'), below;
  for (int child = 0; child < 8; ++child) {
    const Vec3i at = map_child(corner, child, side / 2);
    const MapKeys inside = keys_in(keys, at, side / 2);
    const int state = inside.empty() ? (child % 3 == 0 ? 1 : 0) : is_full(inside, side / 2) ? 2 : 3;
    states[child / 4] |= static_cast<char>(state << 2 * (child % 4));
    if (state == 3) below += binary_nodes(inside, at, side / 2);
  }
  return states + below;
}

std::string map_float(float value) {
  std::string text;
  append(text, std::uint64_t{std::bit_cast<std::uint32_t>(value)}, 4);
  return text;
}
/// The log odds and the colour of a voxel, or of a full cell that begins there.
float map_odds(Vec3i key) { return static_cast<float>((key.x + key.y + key.z) % 4) * 0.5f; }
std::string map_color(Vec3i key) {
  return {static_cast<char>(key.x & 255), static_cast<char>(key.y & 255),
          static_cast<char>(key.z & 255)};
}
/// Writes the nodes of an .ot; the cells beside voxels are leaves that are free.
std::string value_nodes(const MapKeys& keys, Vec3i corner, int side, bool has_colors) {
  const std::string color = has_colors ? map_color(corner) : "";
  if (keys.empty()) return map_float(-2) + color + '\0';
  if (is_full(keys, side)) return map_float(map_odds(corner)) + color + '\0';
  std::string text = map_float(3) + color + '\xFF';
  for (int child = 0; child < 8; ++child) {
    const Vec3i at = map_child(corner, child, side / 2);
    text += value_nodes(keys_in(keys, at, side / 2), at, side / 2, has_colors);
  }
  return text;
}

std::string octomap(const std::string& kind, const std::string& type, const std::string& nodes) {
  return "# Octomap OcTree " + kind + "\n# (feel free to add / change comments)\n#\nid " + type +
         "\nsize " + (nodes.empty() ? "0" : "1") + "\nres 0.25\ndata\n" + nodes;
}

/// Returns voxels of a grid around the middle of the map.
MapKeys map_keys(const std::vector<Vec3i>& voxels) {
  MapKeys keys = voxels;
  for (Vec3i& key : keys) key = key + Vec3i{32763, 32760, 32768};
  return keys;
}

class OctoMapFile : public VolumeTest {
 protected:
  void expect_voxels(const std::string& name, std::vector<Vec3i> voxels,
                     std::optional<double> threshold = {}) const {
    const std::unique_ptr<VoxelSource> source = open(name, threshold);
    Vec3i lo{};
    if (!voxels.empty()) lo = voxels[0];
    for (const Vec3i v : voxels) lo = min(lo, v);
    for (Vec3i& v : voxels) v = v - lo;
    const ImportResult result = import(name, threshold);
    EXPECT_EQ(result.read, voxels.size());
    EXPECT_EQ(result.dag, brute_svdag(result.grid.levels, voxels));
    if (voxels.empty()) return;
    EXPECT_EQ(source->grid()->voxel_size, 0.25);
    EXPECT_EQ(source->grid()->origin, (static_cast<Vec3d>(lo) - Vec3d{32768, 32768, 32768}) * 0.25);
    EXPECT_EQ(source->up(), 'z');
  }
};

TEST_F(OctoMapFile, BinaryMapsHaveTheirVoxels) {
  for (const int levels : {2, 3, 4})
    for (const NamedVoxels& set : voxel_sets(levels, 3)) {
      const MapKeys keys = map_keys(set.voxels);
      write("m.bt", octomap("binary file", "OcTree", binary_nodes(keys, {}, 65536)));
      expect_voxels("m.bt", keys);
    }
  write("none.bt", octomap("binary file", "OcTree", ""));
  expect_voxels("none.bt", {});
}

TEST_F(OctoMapFile, ValuesAreComparedAsProbabilities) {
  for (const NamedVoxels& set : voxel_sets(3, 5)) {
    const MapKeys keys = map_keys(set.voxels);
    for (const bool has_colors : {false, true}) {
      write("m.ot", octomap("file", has_colors ? "ColorOcTree" : "OcTree",
                            value_nodes(keys, {}, 65536, has_colors)));
      expect_voxels("m.ot", keys);
      EXPECT_EQ(read("m.ot").colors.empty(), !has_colors || keys.empty());
    }
  }
  // Single voxels, whose odds are 0, 0.5, 1 and 1.5: probabilities 0.5, 0.62, 0.73 and 0.82.
  MapKeys keys;
  Random random(1);
  for (int i = 0; i < 40; ++i)
    keys.push_back(Vec3i{static_cast<int>(random() % 20), static_cast<int>(random() % 20),
                         static_cast<int>(random() % 20)} *
                   2);
  std::sort(keys.begin(), keys.end(),
            [](Vec3i a, Vec3i b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  write("m.ot", octomap("file", "ColorOcTree", value_nodes(keys, {}, 65536, true)));
  for (const double threshold : {0.5, 0.6, 0.7, 0.8}) {
    MapKeys kept;
    for (const Vec3i key : keys)
      if (1 / (1 + std::exp(-map_odds(key))) >= threshold) kept.push_back(key);
    expect_voxels("m.ot", kept, threshold);
  }
  const SourceVoxels all = read("m.ot");
  Vec3i lo = keys[0];
  for (const Vec3i key : keys) lo = min(lo, key);
  for (std::size_t i = 0; i < all.voxels.size(); ++i) {
    const Vec3i key = all.voxels[i] + lo;
    EXPECT_EQ(all.colors[i],
              (Rgb8{static_cast<std::uint8_t>(key.x), static_cast<std::uint8_t>(key.y),
                    static_cast<std::uint8_t>(key.z)}));
  }
}

TEST_F(OctoMapFile, DamageIsFound) {
  const MapKeys keys = map_keys({{0, 0, 0}, {3, 1, 2}, {3, 3, 3}});
  for (const auto& [name, good] :
       {std::pair<std::string, std::string>{
            "m.bt", octomap("binary file", "OcTree", binary_nodes(keys, {}, 65536))},
        {"m.ot", octomap("file", "OcTree", value_nodes(keys, {}, 65536, false))}}) {
    expect_no_prefix_is_read(name, good);
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
      std::string bad = good;
      bad[bit / 8] ^= static_cast<char>(1 << bit % 8);
      write(name, bad);
      // A flipped bit can make a leaf of a large part of the map.
      struct Enough {};
      try {
        std::size_t count = 0;
        open(name)->visit_all([&](const VoxelBatch& batch) {
          if ((count += batch.places.size()) > 100000) throw Enough{};
        });
      } catch (const Enough&) {
      } catch (const Error&) {
      }
    }
  }
}

TEST_F(OctoMapFile, ErrorsNameTheirPlace) {
  EXPECT_TRUE(has(error_of_bytes("m.bt", "nothing"), "does not begin with \"# Octomap OcTree\""));
  EXPECT_TRUE(has(error_of_bytes("m.bt", "# Octomap OcTree binary file\nid OcTree\n"),
                  "the header has no line \"data\""));
  EXPECT_TRUE(has(error_of_bytes("m.bt", octomap("binary file", "OcTreeStamped", "")),
                  "of type \"OcTreeStamped\""));
  EXPECT_TRUE(has(error_of_bytes("m.bt", octomap("binary file", "OcTree", std::string(40, '\xFF'))),
                  "deeper than 16 levels"));
  EXPECT_TRUE(has(error_of_bytes("m.bt", octomap("binary file", "OcTree", "")), "no error"));
  EXPECT_TRUE(has(error_of_bytes("m.bt", octomap("binary file", "OcTree", ""), 0.5),
                  "no values to compare"));
  EXPECT_TRUE(has(error_of_bytes("m.ot", octomap("file", "OcTree", ""), 1.0), "is a probability"));
}

}  // namespace
}  // namespace voxdag
