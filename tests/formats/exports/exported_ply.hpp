#pragma once
/// Reads the PLY files that exports write.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "exported_scene.hpp"

namespace voxdag {

/// The elements of a binary PLY file that an export wrote.
struct ExportedPly {
  explicit ExportedPly(const std::string& bytes) {
    const std::size_t end = bytes.find("end_header\n") + 11;
    std::istringstream header(bytes.substr(0, end));
    std::size_t vertex_count = 0, face_count = 0;
    bool is_double = false, has_normals = false, has_colors = false, has_materials = false;
    for (std::string line; std::getline(header, line);) {
      if (line.starts_with("element vertex ")) vertex_count = std::stoull(line.substr(15));
      if (line.starts_with("element face ")) face_count = std::stoull(line.substr(13));
      if (line == "property double x") is_double = true;
      if (line == "property float nx") has_normals = true;
      if (line == "property uchar red") has_colors = true;
      if (line == "property ushort material") has_materials = true;
    }
    std::size_t at = end;
    const auto take = [&]<class T>(T& value) {
      std::memcpy(&value, bytes.data() + at, sizeof value);
      at += sizeof value;
    };
    for (std::size_t i = 0; i < vertex_count; ++i) {
      Vec3f small;
      Vec3d large;
      if (is_double)
        take(large);
      else
        take(small), large = Vec3d(small);
      vertices.push_back(large);
      if (has_normals) take(normals.emplace_back());
      if (has_colors) take(colors.emplace_back());
      if (has_materials) take(materials.emplace_back());
    }
    for (std::size_t i = 0; i < face_count; ++i) {
      unsigned char corners;
      take(corners);
      EXPECT_EQ(corners, 4);
      take(faces.emplace_back());
    }
    EXPECT_EQ(at, bytes.size());
    has_doubles = is_double;
  }
  std::vector<Vec3d> vertices;
  std::vector<Vec3f> normals;
  std::vector<Value8> colors;
  std::vector<std::uint16_t> materials;
  std::vector<std::array<std::uint32_t, 4>> faces;
  bool has_doubles = false;
};

/// Returns the faces by voxel and outward direction, computed from the centre and normal of each
/// quad of the PLY.
inline std::map<std::pair<VoxelKey, VoxelKey>, int> faces_of(const ExportedPly& ply,
                                                             const Grid& grid) {
  std::map<std::pair<VoxelKey, VoxelKey>, int> faces;
  for (const auto& face : ply.faces) {
    std::array<Vec3d, 4> p;
    for (int i = 0; i < 4; ++i)
      p[i] = (ply.vertices.at(face[i]) - grid.origin) * (1 / grid.voxel_size);
    const Vec3d normal = cross(p[1] - p[0], p[2] - p[1]);
    EXPECT_EQ(p[0] + p[2], p[1] + p[3]);
    EXPECT_EQ(dot(normal, normal), 1);
    const Vec3d inside = (p[0] + p[2]) * 0.5 - normal * 0.5 - Vec3d{0.5, 0.5, 0.5};
    ++faces[{{int(inside.x), int(inside.y), int(inside.z)},
             {int(normal.x), int(normal.y), int(normal.z)}}];
  }
  return faces;
}

}  // namespace voxdag
