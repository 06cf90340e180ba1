// Hostile meshes: few bytes that expand to many, and faces and names that trigger slow algorithms.
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "lab/untrusted/untrusted_case.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
}

/// Writes a glTF accessor without a buffer view: its elements are zero, so any count needs no
/// bytes.
void write_zeros_accessor(const fs::path& folder) {
  std::string nodes, indices;
  for (int i = 0; i < 20; ++i) {
    nodes += fmt::format(R"({}{{"mesh":0}})", i == 0 ? "" : ",");
    indices += fmt::format("{}{}", i == 0 ? "" : ",", i);
  }
  write_text(folder / "zeros.gltf",
             fmt::format(R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[{}]}}],)"
                         R"("nodes":[{}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}})"
                         R"(}}]}}],"accessors":[{{"componentType":5126,"count":30000000,)"
                         R"("type":"VEC3"}}]}})",
                         indices, nodes));
}

/// Writes glTF primitives that alternate between two large accessors.
void write_alternating_accessors(const fs::path& folder) {
  std::string primitives;
  for (int i = 0; i < 120; ++i)
    primitives += fmt::format(R"({}{{"attributes":{{"POSITION":{}}},"indices":2}})",
                              i == 0 ? "" : ",", i % 2);
  write_text(folder / "alternating.gltf",
             fmt::format(R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
                         R"("nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{}]}}],"accessors":[)"
                         R"({{"componentType":5126,"count":4000000,"type":"VEC3"}},)"
                         R"({{"componentType":5126,"count":4000001,"type":"VEC3"}},)"
                         R"({{"componentType":5123,"count":3,"type":"SCALAR"}}]}})",
                         primitives));
}

/// Writes one face of about 400 KB whose corners return to its first vertex many times.
void write_repeated_corners(const fs::path& folder) {
  constexpr int kRing = 20000;
  std::string text = "v 0 0 0\n";
  for (int i = 0; i < kRing; ++i) {
    const double angle = 2 * M_PI * i / kRing;
    text += fmt::format("v {:.6f} {:.6f} 0\n", std::cos(angle), std::sin(angle));
  }
  text += "f";
  for (int i = 0; i < kRing; ++i) text += fmt::format(" 1 {}", i + 2);
  write_text(folder / "corners.obj", text + "\n");
}

/// Writes a triangle and a material library of 2.2 MB in which every line is wrong.
void write_wrong_materials(const fs::path& folder) {
  write_text(folder / "warnings.obj",
             "mtllib warnings.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
  std::string text = "newmtl a\n";
  while (text.size() < 2200000) text += "Kd x\n";
  write_text(folder / "warnings.mtl", text);
}

/// 60,000 materials, each of one triangle, in another order.
void write_many_materials(const fs::path& folder) {
  constexpr int kMaterials = 60000, kPerRow = 250;
  std::string materials, mesh = "mtllib many.mtl\n";
  for (int i = 0; i < kMaterials; ++i) {
    materials += fmt::format("newmtl m{}\nKd 1 0 0\n", i);
    const int x = i % kPerRow, y = i / kPerRow;
    mesh += fmt::format("v {0} {1} 0\nv {2} {1} 0\nv {0} {3} 0\nusemtl m{4}\nf -3 -2 -1\n", x, y,
                        x + 1, y + 1, kMaterials - 1 - i);
  }
  write_text(folder / "many.mtl", materials);
  write_text(folder / "many.obj", mesh);
}

/// Writes 4,000 triangles around one vertex, with texture coordinates for displacement.
void write_fan(const fs::path& folder) {
  constexpr int kTriangles = 4000;
  std::string text = "v 0 0 0.2\nvt 0.5 0.5\n";
  for (int i = 0; i < kTriangles; ++i) {
    const double angle = 2 * M_PI * i / kTriangles;
    text +=
        fmt::format("v {0:.6f} {1:.6f} 0\nvt {0:.6f} {1:.6f}\n", std::cos(angle), std::sin(angle));
  }
  for (int i = 0; i < kTriangles; ++i)
    text += fmt::format("f 1/1 {0}/{0} {1}/{1}\n", i + 2, (i + 1) % kTriangles + 2);
  write_text(folder / "fan.obj", text);
}

/// Writes 4,000 triangles that share one edge.
void write_book(const fs::path& folder) {
  constexpr int kTriangles = 4000;
  std::string text = "v 0 0 0\nv 0 0 1\nvt 0 0\nvt 0 1\n";
  for (int i = 0; i < kTriangles; ++i) {
    const double angle = 2 * M_PI * i / kTriangles;
    text +=
        fmt::format("v {0:.6f} {1:.6f} 0.5\nvt {0:.6f} 0.5\n", std::cos(angle), std::sin(angle));
  }
  for (int i = 0; i < kTriangles; ++i) text += fmt::format("f 1/1 2/2 {0}/{0}\n", i + 3);
  write_text(folder / "book.obj", text);
}

/// Writes a cube whose faces are repeated a thousand times.
void write_thousand_cubes(const fs::path& folder) {
  std::string text;
  for (int i = 0; i < 8; ++i) text += fmt::format("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2 & 1);
  for (int i = 0; i < 1000; ++i)
    text += "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n";
  write_text(folder / "cubes.obj", text);
}

/// Writes 600,000 tiny triangles in one place, and two distant triangles that make the grid large.
void write_tiny_triangles(const fs::path& folder) {
  std::ofstream out(folder / "spot.stl", std::ios::binary);
  constexpr std::uint32_t kCount = 600002;
  const char header[80] = {};
  out.write(header, sizeof header);
  out.write(reinterpret_cast<const char*>(&kCount), 4);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    float facet[12] = {};
    const bool is_far = i >= kCount - 2;
    for (int corner = 0; corner < 3; ++corner) {
      const auto u =
          static_cast<float>((i * 7919u + static_cast<unsigned>(corner) * 104729u) % 1009u);
      const auto v =
          static_cast<float>((i * 6101u + static_cast<unsigned>(corner) * 75503u) % 1013u);
      facet[3 + 3 * corner] = is_far ? static_cast<float>(corner == 1) : 0.5f + u * 1e-7f;
      facet[4 + 3 * corner] = is_far ? static_cast<float>(corner == 2) : 0.5f + v * 1e-7f;
      facet[5 + 3 * corner] = is_far ? static_cast<float>(i & 1) : 0.5f + (u - v) * 1e-7f;
    }
    const std::uint16_t attribute = 0;
    out.write(reinterpret_cast<const char*>(facet), sizeof facet);
    out.write(reinterpret_cast<const char*>(&attribute), 2);
  }
}

}  // namespace

std::vector<UntrustedCase> untrusted_mesh_cases() {
  const auto nothing = [](const fs::path&) {};
  return {
      {"glTF: 30 M zeros, 20 instances",
       write_zeros_accessor,
       {},
       {"build", "zeros.gltf", "-r", "256", "-o", "x.vdag", "--memory", "100M"},
       100 * kMiB,
       1},
      {"glTF: accessors in turns",
       write_alternating_accessors,
       {},
       {"build", "alternating.gltf", "-r", "256", "-o", "x.vdag", "--memory", "500M"},
       500 * kMiB},
      {"OBJ: one face, repeated corners",
       write_repeated_corners,
       {},
       {"build", "corners.obj", "-r", "256", "-o", "x.vdag"}},
      {"MTL: 440,000 wrong lines",
       write_wrong_materials,
       {},
       {"build", "warnings.obj", "-r", "256", "-o", "x.esvo", "--quiet"}},
      {"MTL: 60,000 materials",
       write_many_materials,
       {},
       {"build", "many.obj", "-r", "256", "-o", "x.esvo", "--quiet"}},
      {"displacement around one vertex",
       write_fan,
       {},
       {"build", "fan.obj", "-r", "256", "-o", "x.esvo", "--displace", "stone:0.05", "--memory",
        "500M"},
       500 * kMiB},
      {"displacement around one edge",
       write_book,
       {},
       {"build", "book.obj", "-r", "256", "-o", "x.esvo", "--displace", "stone:0.05", "--memory",
        "500M"},
       500 * kMiB},
      {"every face 1,000 times: ESVO",
       write_thousand_cubes,
       {},
       {"build", "cubes.obj", "-r", "256", "-o", "x.esvo"}},
      {"every face 1,000 times: DAG",
       write_thousand_cubes,
       {},
       {"build", "cubes.obj", "-r", "4096", "-o", "x.vdag"}},
      {"600,000 triangles in one spot",
       write_tiny_triangles,
       {},
       {"build", "spot.stl", "-r", "1024", "-o", "x.vdag", "--memory", "100M"},
       100 * kMiB},
      {"hairball, by sorting",
       nothing,
       {"scene", "hairball", "--size", "1500", "-o", "hairball.ply"},
       {"build", "hairball.ply", "-r", "64", "-o", "x.vdag", "--method", "sort", "--memory",
        "150M"},
       150 * kMiB},
      {"hairball, as an ESVO",
       nothing,
       {"scene", "hairball", "--size", "1500", "-o", "hairball.ply"},
       {"build", "hairball.ply", "-r", "64", "-o", "x.esvo", "--memory", "150M"},
       150 * kMiB},
  };
}

}  // namespace voxdag::lab
