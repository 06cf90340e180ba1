// Tests `voxdag trace` at an ESVO: the attributes of the voxels that rays hit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "colored_waves.hpp"
#include "npy_rays.hpp"
#include "process.hpp"
#include "support/temp_dir.hpp"
#include "support/test_rays.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/file/esvo_file.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/stored/esvo/color_block.hpp"
#include "voxdag/stored/esvo/normal_block.hpp"

namespace voxdag::cli {
namespace {

const std::string kPlace = "[('t', '<f4'), ('voxel', '<i4', (3,)), ('face', '|i1'), ('hit', '|b1')";
const std::string kAttributes = ", ('normal', '<f4', (3,)), ('color', '|u1', (3,))";
constexpr std::size_t kPlaceBytes = 18, kAttributeBytes = 15;

struct Attributes {
  Vec3f normal;
  Vec3<std::uint8_t> color;

  bool operator==(const Attributes&) const = default;
};

/// The attributes of every leaf, by its lowest voxel.
class Leaves {
 public:
  explicit Leaves(const EsvoView& esvo) : esvo_(esvo) { walk(esvo.root, {}, esvo.levels); }

  const Attributes& at(Vec3i voxel) const { return attributes_.at({voxel.x, voxel.y, voxel.z}); }
  /// Returns the attributes of the leaf around a voxel, or null.
  const Attributes* around(Vec3i voxel) const {
    for (int size = 1; size < 1 << esvo_.levels; size *= 2) {
      const auto found =
          attributes_.find({voxel.x / size * size, voxel.y / size * size, voxel.z / size * size});
      if (found != attributes_.end() && sizes_.at(found->first) == size) return &found->second;
    }
    return nullptr;
  }
  std::size_t coarse = 0;

 private:
  void walk(std::uint64_t slot, Vec3i origin, int log2_size) {
    const ChildDescriptor descriptor = esvo_.descriptor(slot);
    for (int child = 0; child < 8; ++child) {
      if ((descriptor.valid_mask() >> child & 1) == 0) continue;
      const Vec3i at = origin + child_offset(child) * (1 << (log2_size - 1));
      if ((descriptor.leaf_mask() >> child & 1) == 0) {
        walk(esvo_.child(slot, descriptor, child), at, log2_size - 1);
        continue;
      }
      coarse += log2_size > 1 ? 1 : 0;
      attributes_[{at.x, at.y, at.z}] = attributes_of({slot, child});
      sizes_[{at.x, at.y, at.z}] = 1 << (log2_size - 1);
    }
  }

  Attributes attributes_of(const EsvoVoxel& voxel) const {
    const std::uint64_t* const c = esvo_.attachment(voxel.slot, EsvoAttachmentKind::kColors);
    const std::uint64_t* const n = esvo_.attachment(voxel.slot, EsvoAttachmentKind::kNormals);
    NormalBlock normals;
    for (int i = 0; i < 4; ++i)
      normals.words[i] = static_cast<std::uint32_t>(n[i / 2] >> (i % 2 * 32));
    Attributes attributes;
    attributes.normal = normals.normal(attachment_value(voxel));
    const Vec3f srgb = ColorBlock{c[0]}.color(attachment_value(voxel));
    for (int i = 0; i < 3; ++i)
      attributes.color[i] = static_cast<std::uint8_t>(std::lround(255 * srgb[i]));
    return attributes;
  }

  EsvoView esvo_;
  std::map<std::array<std::int32_t, 3>, Attributes> attributes_;
  std::map<std::array<std::int32_t, 3>, int> sizes_;
};

class TraceCommand : public testing::Test {
 protected:
  TraceCommand() { write_text(dir_ / "waves.obj", colored_waves()); }

  std::string build(const std::string& name, std::vector<std::string> options = {},
                    const std::string& resolution = "64") const {
    options.insert(options.begin(),
                   {"build", dir_ / "waves.obj", "-r", resolution, "-o", dir_ / name});
    const ProcessResult result = run_voxdag(options);
    EXPECT_EQ(result.status, 0) << result.err;
    return dir_ / name;
  }
  /// Writes rays of every kind at a grid.
  void write_rays(const Grid& grid) const {
    TestRays source(grid, 1);
    std::vector<std::array<float, 8>> rays(4000);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Ray ray = source.make(static_cast<RayKind>(i % static_cast<int>(RayKind::kCount)));
      std::memcpy(rays[i].data(), &ray, sizeof ray);
    }
    write_text(dir_ / "rays.npy", rays_npy(rays));
  }
  std::string trace(const std::string& scene, const std::string& look = "") const {
    const std::string hits = dir_ / "hits.npy";
    std::vector<std::string> words = {"trace", scene, "--rays", dir_ / "rays.npy", "-o", hits};
    if (!look.empty()) words.insert(words.end(), {"--look", look});
    const ProcessResult result = run_voxdag(words);
    EXPECT_EQ(result.status, 0) << result.err;
    return hits;
  }
  /// Returns every row, as bytes.
  static std::vector<std::string> rows_of(const std::string& hits, const std::string& dtype,
                                          std::size_t row_bytes) {
    NpyReader reader(hits, dtype, {}, row_bytes);
    std::vector<std::string> rows(reader.rows(), std::string(row_bytes, '\0'));
    for (std::string& row : rows) reader.read_rows(row.data(), 1);
    return rows;
  }

  static Vec3i voxel_of(const std::string& row) {
    Vec3i voxel;
    std::memcpy(&voxel, row.data() + 4, sizeof voxel);
    return voxel;
  }
  static Attributes attributes_of(const std::string& row) {
    Attributes attributes;
    std::memcpy(&attributes.normal, row.data() + kPlaceBytes, sizeof attributes.normal);
    std::memcpy(&attributes.color, row.data() + kPlaceBytes + sizeof attributes.normal,
                sizeof attributes.color);
    return attributes;
  }

  TempDir dir_;
};

TEST_F(TraceCommand, WritesTheStoredAttributesOfTheHitVoxels) {
  const std::string scene = build("waves.esvo", {"--color-error", "0.2", "--max-error", "2"});
  const EsvoFile file(scene);
  const Leaves leaves(file.view());
  ASSERT_GT(leaves.coarse, 0u);
  write_rays(file.grid());
  const auto rows =
      rows_of(trace(scene), kPlace + kAttributes + "]", kPlaceBytes + kAttributeBytes);
  std::size_t hits = 0;
  for (const std::string& row : rows) {
    const bool is_hit = row[17] != 0;
    hits += is_hit ? 1 : 0;
    EXPECT_EQ(attributes_of(row), is_hit ? leaves.at(voxel_of(row)) : Attributes{});
  }
  EXPECT_GT(hits, rows.size() / 10);
  EXPECT_LT(hits, rows.size());
}

TEST_F(TraceCommand, WithoutAttributesTheHitsAreTheSame) {
  const std::string with = build("with.esvo", {"--no-contours"});
  const std::string without = build("without.esvo", {"--no-contours", "--no-attributes"});
  const std::string dag = build("dag.vdag");
  write_rays(EsvoFile(with).grid());
  auto expected = rows_of(trace(with), kPlace + kAttributes + "]", kPlaceBytes + kAttributeBytes);
  for (std::string& row : expected) row.resize(kPlaceBytes);
  EXPECT_EQ(rows_of(trace(without), kPlace + "]", kPlaceBytes), expected);
  EXPECT_EQ(rows_of(trace(dag), kPlace + "]", kPlaceBytes), expected) << "cubes are a DAG's voxels";
}

TEST_F(TraceCommand, LooksUpTheAttributesOfADagsHitsInAnEsvo) {
  const std::string dag = build("dag.vdag");
  const std::vector<std::string> coarse_leaves = {"--color-error", "0.2", "--max-error", "2"};
  for (const int resolution : {64, 32, 128}) {
    SCOPED_TRACE(resolution);
    const std::string look = build("look.esvo", coarse_leaves, std::to_string(resolution));
    const EsvoFile file(look);
    const Leaves leaves(file.view());
    write_rays(EsvoFile(look).grid());
    const auto rows =
        rows_of(trace(dag, look), kPlace + kAttributes + "]", kPlaceBytes + kAttributeBytes);
    int hits = 0, found = 0;
    for (const std::string& row : rows) {
      if (row[17] == 0) {
        EXPECT_EQ(attributes_of(row), Attributes{});
        continue;
      }
      ++hits;
      EXPECT_NE(attributes_of(row), Attributes{});
      const Vec3i voxel = voxel_of(row);
      const int coarser = resolution == 32 ? 2 : 1;
      const Attributes* leaf =
          leaves.around({voxel.x / coarser, voxel.y / coarser, voxel.z / coarser});
      if (resolution == 128 || leaf == nullptr) continue;  // no leaf, but a voxel above leaves
      ++found;
      EXPECT_EQ(attributes_of(row), *leaf);
    }
    EXPECT_GT(hits, 400);
    if (resolution == 64) {
      EXPECT_EQ(found, hits);
    }
    if (resolution == 32) {
      EXPECT_GT(found, hits * 9 / 10) << "the grids differ by less than 1/64 voxel";
    }
  }
}

TEST_F(TraceCommand, RefusesTheLookOfSomethingElse) {
  const std::string dag = build("dag.vdag"), esvo = build("look.esvo");
  write_rays(EsvoFile(esvo).grid());
  ASSERT_EQ(run_voxdag({"scene", "hairball", "--size", "1", "-o", dir_ / "hair.ply"}).status, 0);
  ASSERT_EQ(
      run_voxdag({"build", dir_ / "hair.ply", "-r", "16", "--as", "esvo", "-o", dir_ / "hair.esvo"})
          .status,
      0);
  const auto refused = [&](const std::string& scene, const std::string& look,
                           const std::string& reason) {
    for (const bool is_trace : {true, false}) {
      std::vector<std::string> words = {is_trace ? "trace" : "render",
                                        scene,
                                        "--look",
                                        look,
                                        "-o",
                                        dir_ / (is_trace ? "out.npy" : "out.png")};
      if (is_trace) words.insert(words.end(), {"--rays", dir_ / "rays.npy"});
      expect_failure(run_voxdag(words), 1, reason);
    }
  };
  refused(dag, dag, "dag.vdag: is neither an ESVO nor a DAG with attributes");
  refused(dag, dir_ / "hair.esvo", "hair.esvo: is of another mesh");
  refused(dag, dir_ / "absent.esvo", "absent.esvo");
  refused(esvo, esvo, "--look: needs a DAG");
  EXPECT_FALSE(std::filesystem::exists(dir_ / "out.npy"));
}

TEST_F(TraceCommand, NoRaysMakeAnArrayWithTheSameFields) {
  const std::string scene = build("waves.esvo");
  write_text(dir_ / "rays.npy", rays_npy({}));
  EXPECT_TRUE(
      rows_of(trace(scene), kPlace + kAttributes + "]", kPlaceBytes + kAttributeBytes).empty());
}

}  // namespace
}  // namespace voxdag::cli
