#pragma once
/// Small meshes for the tests, read from strings.
#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// A reader of meshes without appearance.
class Reader {
 public:
  Reader(MeshWithAppearance (*read)(const MeshSource&, ReadParts))
      : read_([read](const MeshSource& source) { return read(source, ReadParts::kMesh).mesh; }) {}

  Mesh operator()(const MeshSource& source) const { return read_(source); }

 private:
  std::function<Mesh(const MeshSource&)> read_;
};

inline Mesh read_text(const Reader& reader, std::string_view text) {
  return reader({text, "mesh", {}, nullptr, {}});
}

/// Returns the message of the Error that reading throws. Fails the test if there is none.
inline std::string refusal(const Reader& reader, std::string_view text) {
  try {
    read_text(reader, text);
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  ADD_FAILURE() << "the mesh was accepted";
  return "";
}

/// Expects that reading a prefix of any length gives a mesh or an Error, nothing else.
inline void expect_any_prefix_is_safe(const Reader& reader, std::string_view text) {
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const std::vector<char> exact(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size));
    try {
      const Mesh mesh = read_text(reader, {exact.data(), exact.size()});
      EXPECT_FALSE(mesh.triangles.empty());
      for (const Triangle& triangle : mesh.triangles)
        for (const std::uint32_t index : triangle) EXPECT_LT(index, mesh.vertices.size());
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), "mesh");
    }
  }
}

/// Appends the bytes of `value`, in the given order.
template <class T>
void append(std::string& bytes, T value, bool big_endian = false) {
  std::string raw(reinterpret_cast<const char*>(&value), sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) raw.assign(raw.rbegin(), raw.rend());
  bytes += raw;
}

inline bool operator==(const Mesh& a, const Mesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles &&
         a.triangle_materials == b.triangle_materials && a.materials == b.materials;
}

}  // namespace voxdag
