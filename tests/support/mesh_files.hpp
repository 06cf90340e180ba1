#pragma once
/// Mesh files with random triangles, for tests of readers.
#include <bit>
#include <cstdint>
#include <random>
#include <string>

namespace voxdag {

/// Appends the bytes of a value in the given order.
template <class T>
void append_bytes(std::string& bytes, T value, bool big_endian = false) {
  std::string raw(reinterpret_cast<const char*>(&value), sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) raw.assign(raw.rbegin(), raw.rend());
  bytes += raw;
}

/// Returns a coordinate between 0 and 1 with few digits, so that vertices repeat.
inline float coarse_coordinate(std::mt19937_64& random) {
  return static_cast<float>(random() % 8) / 8;
}

/// Returns an OBJ file with `faces` faces of three to seven corners, many of them not convex, and
/// with all that can stand between them.
inline std::string random_obj(int faces, const std::string& line_end) {
  std::mt19937_64 random(11);
  std::string text = "# made by a test \\" + line_end + "mtllib none.mtl" + line_end;
  int vertices = 0;
  for (int face = 0; face < faces; ++face) {
    const int corners = 3 + static_cast<int>(random() % 5);
    for (int i = 0; i < corners; ++i) {
      text += "v";
      for (int axis = 0; axis < 3; ++axis)
        text += ' ' + std::to_string(axis == 2 ? 0.5 : static_cast<double>(random() % 1000) / 1000);
      text += line_end;
    }
    vertices += corners;
    if (face % 7 == 0) text += "usemtl stone" + std::to_string(face) + line_end;
    if (face % 5 == 0) text += "vn 0 0 1" + line_end;
    text += "f";
    for (int i = 0; i < corners; ++i) {
      const bool is_relative = random() % 2 == 0;
      if (random() % 9 == 0) text += " \\" + line_end;
      text += ' ' + std::to_string(is_relative ? i - corners : vertices - corners + i + 1);
      if (random() % 4 == 0) text += "//1";
    }
    text += line_end;
  }
  // Faces may refer to later vertices.
  text += "f 1 2 " + std::to_string(vertices + 1) + line_end + "v 0.1 0.2 0.3" + line_end;
  return text;
}

/// Returns a binary PLY file with `faces` faces of `corners` corners, other properties and an
/// element behind the faces.
inline std::string random_ply(int faces, bool big_endian, std::uint8_t corners) {
  std::mt19937_64 random(12);
  const int vertices = faces + 4;
  std::string text =
      std::string("ply\nformat ") + (big_endian ? "binary_big_endian" : "binary_little_endian") +
      " 1.0\ncomment material 0 stone\ncomment material 1 wood\nelement vertex " +
      std::to_string(vertices) +
      "\nproperty short id\nproperty float x\nproperty double y\nproperty float z\n"
      "element face " +
      std::to_string(faces) +
      "\nproperty uchar flags\nproperty list uchar uint vertex_indices\n"
      "property float quality\nproperty uchar material_index\nelement edge 1\nproperty int end\n"
      "end_header\n";
  for (int i = 0; i < vertices; ++i) {
    append_bytes<std::int16_t>(text, 1, big_endian);
    append_bytes(text, coarse_coordinate(random), big_endian);
    append_bytes(text, static_cast<double>(random() % 1000) / 1000, big_endian);
    append_bytes(text, coarse_coordinate(random), big_endian);
  }
  for (int i = 0; i < faces; ++i) {
    append_bytes<std::uint8_t>(text, 7);
    append_bytes(text, corners);
    for (std::uint8_t corner = 0; corner < corners; ++corner)
      append_bytes(
          text,
          static_cast<std::uint32_t>(i == 0 && corner == 0 ? 0 : random() % unsigned(vertices)),
          big_endian);
    append_bytes(text, 0.5f, big_endian);
    append_bytes<std::uint8_t>(text, static_cast<std::uint8_t>(i % 2));
  }
  append_bytes<std::int32_t>(text, 0, big_endian);
  return text;
}

/// Returns a binary STL file with `facets` facets that share many corners.
inline std::string random_stl(std::uint32_t facets) {
  std::mt19937_64 random(13);
  std::string text(80, ' ');
  append_bytes(text, facets);
  for (std::uint32_t i = 0; i < facets; ++i) {
    for (int axis = 0; axis < 3; ++axis) append_bytes(text, 0.0f);
    for (int value = 0; value < 9; ++value) append_bytes(text, coarse_coordinate(random));
    append_bytes<std::uint16_t>(text, 0);
  }
  return text;
}

}  // namespace voxdag
