/// Tests that the work of readers grows with the size of their input, not with its square.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <functional>

#include "formats/readers/appearance_files.hpp"
#include "voxdag/core/parallel/thread_count.hpp"

namespace voxdag {
namespace {

/// Returns the CPU time of this process, in seconds. Other processes do not affect it.
double processor_seconds() {
  std::timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

class ReaderCost : public ReadAppearance {
 protected:
  double cost(const std::filesystem::path& file) {
    double least = 1e9;
    for (int run = 0; run < 3; ++run) {
      const double start = processor_seconds();
      read_mesh_with_appearance(file);
      least = std::min(least, processor_seconds() - start);
    }
    return least;
  }

  /// Expects that eight times the input takes less than 30 times as long. n log n gives a factor
  /// below 12, n² a factor of 64. `make(n)` writes the files of an input of size `n` and returns
  /// the mesh file.
  void expect_no_square(int n, const std::function<std::filesystem::path(int)>& make) {
    const ThreadLimit one(1);
    constexpr double kClock = 0.004;  // Time that the clock and the system may add.
    // Page faults of a busy machine count as time of this process: the best of some tries counts.
    double small = 0, large = 1;
    for (int tries = 0; tries < 5 && large >= 30 * (small + kClock); ++tries) {
      small = cost(make(n));
      large = cost(make(8 * n));
    }
    EXPECT_LT(large, 30 * (small + kClock));
  }

  std::filesystem::path obj_with(const std::string& mtl, const std::string& statements) {
    write("a.mtl", mtl);
    return write("a.obj", "mtllib a.mtl\n" + kSquare + statements + "f 1 2 3\n");
  }
};

TEST_F(ReaderCost, MalformedMtlStatements) {
  expect_no_square(20'000, [this](int n) {
    std::string mtl = "newmtl m\n";
    for (int i = 0; i < n; ++i) mtl += "Kd bad\n";
    return obj_with(mtl, "usemtl m\n");
  });
}

TEST_F(ReaderCost, NamesOfMaterials) {
  expect_no_square(3000, [this](int n) {
    std::string mtl, statements;
    for (int i = 0; i < n; ++i) {
      const std::string name =
          std::string("a_long_common_prefix_").append(std::to_string(i)) + "\n";
      mtl += "newmtl " + name;
      statements += "usemtl " + name;
    }
    return obj_with(mtl, statements);
  });
}

TEST_F(ReaderCost, OneMtlFileUnderManyNames) {
  expect_no_square(1000, [this](int n) {
    std::string mtl = "newmtl m\n", libraries;
    for (int i = 0; i < n; ++i) {
      mtl += "Kd 1 1 1\n";
      libraries.append("mtllib ./a.mtl x").append(std::to_string(i)).append("\n");
    }
    return obj_with(mtl, libraries + "usemtl m\n");
  });
}

TEST_F(ReaderCost, PolygonsThatAreCutWithAttributes) {
  expect_no_square(2000, [this](int n) {
    std::string obj, face = "f";
    for (int i = 0; i < n; ++i) {  // A comb.
      const std::string x = std::to_string(i), odd = std::to_string(2 * i + 1),
                        even = std::to_string(2 * i + 2);
      obj.append("v ").append(x).append(" 0 0\nv ").append(x).append(i % 2 ? ".5 5" : ".5 9");
      obj.append(" 0\nvt 0.").append(x).append(" 0\n");
      face.append(" ").append(odd).append("/1 ").append(even).append("/2");
    }
    obj.append("v 0 -5 0\n").append(face).append(" ").append(std::to_string(2 * n + 1));
    return write("a.obj", obj + "/3\n");
  });
}

const std::string kGltfStart = R"({"asset":{"version":"2.0"},)";
const std::string kGltfBuffer =
    R"("bufferViews":[{"buffer":0,"byteLength":12}],"buffers":[{"byteLength":12,"uri":)"
    R"("data:;base64,AAAAAAAAAAAAAAAA"}])";

/// Returns positions of `count` zeros.
std::string zeros(int count) {
  return R"({"componentType":5126,"count":)" + std::to_string(count) +
         R"(,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"componentType":5121},)" +
         R"("values":{"bufferView":0}}})";
}

TEST_F(ReaderCost, PrimitivesThatAlternateAccessors) {
  expect_no_square(500, [this](int n) {
    std::string primitives;
    for (int i = 0; i < n; ++i)
      primitives += std::string(i ? "," : "") + R"({"attributes":{"POSITION":)" +
                    std::to_string(i % 2) + R"(,"NORMAL":)" + std::to_string(i % 2) +
                    R"(},"indices":2})";
    const std::string count = R"({"bufferView":0,"componentType":5121,"count":3,"type":"SCALAR"})";
    return write("a.gltf", kGltfStart + R"("meshes":[{"primitives":[)" + primitives +
                               R"(]}],"accessors":[)" + zeros(400 * n) + "," + zeros(400 * n) +
                               "," + count + "]," + kGltfBuffer + "}");
  });
}

TEST_F(ReaderCost, InstancesOfManyPrimitivesThatShowNothing) {
  expect_no_square(2000, [this](int n) {
    std::string primitives = R"({"attributes":{"POSITION":0}})", nodes, roots;
    for (int i = 0; i < n; ++i) {
      primitives += R"(,{"mode":0,"attributes":{"POSITION":0}},{"attributes":{}})";
      nodes += std::string(i ? "," : "") + R"({"mesh":0})";
      roots.append(i ? "," : "").append(std::to_string(i));
    }
    return write("a.gltf", kGltfStart + R"("scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" +
                               nodes + R"(],"meshes":[{"primitives":[)" + primitives +
                               R"(]}],"accessors":[)" + zeros(3) + "]," + kGltfBuffer + "}");
  });
}

TEST_F(ReaderCost, AccessorsThatAskForAnExtension) {
  expect_no_square(2000, [this](int n) {
    std::string primitives, accessors, extensions;
    for (int i = 0; i < n; ++i) {
      const std::string comma = i ? "," : "";
      primitives += comma + R"({"attributes":{"POSITION":)" + std::to_string(i) + "}}";
      accessors += comma + R"({"bufferView":0,"componentType":5120,"count":3,"type":"VEC3"})";
      extensions += "\"x\",";
    }
    return write("a.gltf", kGltfStart + R"("extensionsUsed":[)" + extensions +
                               R"("KHR_mesh_quantization"],"meshes":[{"primitives":[)" +
                               primitives + R"(]}],"accessors":[)" + accessors + "]," +
                               kGltfBuffer + "}");
  });
}

TEST_F(ReaderCost, MembersOfOneObject) {
  expect_no_square(2000, [this](int n) {
    std::string primitives, members;
    for (int i = 0; i < n; ++i) {
      primitives += std::string(i ? "," : "") + R"({"attributes":{"POSITION":0},"material":0})";
      members.append("\"m").append(std::to_string(i)).append("\":1,");
    }
    return write("a.gltf", kGltfStart + R"("meshes":[{"primitives":[)" + primitives +
                               R"(]}],"materials":[{)" + members + R"("name":"x"}],"accessors":[)" +
                               zeros(3) + "]," + kGltfBuffer + "}");
  });
}

}  // namespace
}  // namespace voxdag
