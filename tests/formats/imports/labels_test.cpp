// Labels of voxels and points against counts cell by cell, and as files of every format have them.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

#include "point_checks.hpp"
#include "voxdag/algebra/attributes/material_voxels.hpp"
#include "voxdag/formats/imports/import_model.hpp"
#include "voxdag/stored/attributes/cell_index_lookup.hpp"

namespace voxdag {
namespace {

using Place = std::tuple<int, int, int>;

struct LabelledVoxel {
  Vec3i voxel;
  Label label;
};

/// Voxels in memory, perhaps with colours.
class LabelledVoxels : public VoxelSource {
 public:
  explicit LabelledVoxels(const std::vector<LabelledVoxel>& voxels, bool has_palette = false)
      : has_palette_(has_palette) {
    for (const LabelledVoxel& v : voxels) {
      places_.push_back(static_cast<Vec3d>(v.voxel));
      labels_.push_back(v.label);
      colors_.push_back({static_cast<std::uint8_t>(v.label), 1, 2});
    }
  }
  bool has_points() const override { return false; }
  bool has_colors() const override { return has_palette_; }
  bool has_palette() const override { return has_palette_; }
  bool has_labels() const override { return true; }
  std::map<Label, std::string> label_names() const override {
    return {{1, "tree"}, {2, "rock"}, {3, "tree"}, {77, "not there"}};
  }
  void visit_all(const VisitBatch& visit) const override {
    for (std::size_t begin = 0; begin < places_.size(); begin += 100) {
      const std::size_t count = std::min<std::size_t>(100, places_.size() - begin);
      visit({{places_.data() + begin, count},
             has_palette_ ? std::span(colors_).subspan(begin, count) : std::span<const Rgb8>(),
             {},
             {labels_.data() + begin, count}});
    }
  }

 private:
  bool has_palette_;
  std::vector<Vec3d> places_;
  std::vector<Rgb8> colors_;
  std::vector<Label> labels_;
};

/// Voxels of which many are there several times, with labels from -2 to `most`.
std::vector<LabelledVoxel> random_labels(int levels, std::size_t count, int most, unsigned seed) {
  std::mt19937 rng(seed);
  std::vector<LabelledVoxel> voxels;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&] { return static_cast<std::int32_t>(rng() % (1u << levels)); };
    const auto labels = static_cast<unsigned>(most) + 3;
    voxels.push_back({{at(), at(), at()}, static_cast<Label>(rng() % labels) - 2});
  }
  return voxels;
}

ImportResult import_labels(const VoxelSource& source, int levels, MemoryBudget* memory = nullptr,
                           const std::vector<std::string>& labels = {}, bool drops = false) {
  const TempDir dir;
  ImportOptions options;
  options.resolution = std::int64_t{1} << levels;
  options.color_bound = 0;
  options.folder = dir.path();
  options.labels = labels;
  options.drops_labels = drops;
  return import_voxels(source, options, memory);
}

/// Returns the label with the largest count, the smallest of several.
Label most_frequent(const std::map<Label, std::uint64_t>& counts) {
  Label best = counts.begin()->first;
  for (const auto& [label, count] : counts)
    if (count > counts.at(best)) best = label;
  return best;
}

Label label_at(const ImportResult& result, Vec3i cell, int level) {
  std::uint64_t number = 0;
  EXPECT_TRUE(
      find_cell_number(result.dag.view(), result.attributes.index.view(), cell, level, number));
  return result.labels[read_material(result.attributes.materials.view(), number)];
}

TEST(Labels, CellsHaveTheLabelOfMostOfTheirChildren) {
  for (const int levels : {2, 3, 4, 6})
    for (const std::size_t count : {std::size_t{1}, std::size_t{30}, std::size_t{3000}})
      for (const int most : {0, 5, 300}) {
        const std::vector<LabelledVoxel> voxels =
            random_labels(levels, count, most, static_cast<unsigned>(levels));
        const ImportResult result = import_labels(LabelledVoxels(voxels), levels);
        std::vector<Vec3i> places;
        std::map<Place, std::map<Label, std::uint64_t>> counts;
        for (const LabelledVoxel& v : voxels) {
          places.push_back(v.voxel);
          ++counts[{v.voxel.x, v.voxel.y, v.voxel.z}][v.label];
        }
        EXPECT_EQ(result.dag, brute_svdag(levels, places));
        std::map<Place, std::uint64_t> weights;
        for (const auto& [place, of] : counts) weights[place] = 1;
        for (int level = levels; level >= 0; --level) {
          std::map<Place, std::map<Label, std::uint64_t>> above;
          std::map<Place, std::uint64_t> weights_above;
          for (const auto& [place, of] : counts) {
            const auto [x, y, z] = place;
            const Label expected = most_frequent(of);
            ASSERT_EQ(label_at(result, {x, y, z}, level), expected) << level;
            const Place parent{x / 2, y / 2, z / 2};
            above[parent][expected] += weights[place];
            weights_above[parent] += weights[place];
          }
          counts = std::move(above);
          weights = std::move(weights_above);
        }
      }
}

TEST(Labels, OrderAndMemoryDoNotMatter) {
  std::vector<LabelledVoxel> voxels = random_labels(5, 40'000, 20, 9);
  const ImportResult whole = import_labels(LabelledVoxels(voxels), 5);
  std::mt19937 rng(1);
  std::shuffle(voxels.begin(), voxels.end(), rng);
  MemoryBudget memory(std::uint64_t{3} << 20);
  const ImportResult spilled = import_labels(LabelledVoxels(voxels), 5, &memory);
  EXPECT_EQ(memory.used(), 0u);
  EXPECT_EQ(whole.dag, spilled.dag);
  EXPECT_EQ(whole.labels, spilled.labels);
  EXPECT_EQ(whole.attributes.materials.words, spilled.attributes.materials.words);
}

TEST(Labels, TheLastOfAPaletteWinsAsItsColourDoes) {
  std::vector<LabelledVoxel> voxels = random_labels(3, 3000, 200, 4);
  std::map<Place, Label> last;
  for (LabelledVoxel& v : voxels) {
    v.label = std::max<Label>(v.label, 0);
    last[{v.voxel.x, v.voxel.y, v.voxel.z}] = v.label;
  }
  const ImportResult result = import_labels(LabelledVoxels(voxels, true), 3);
  EXPECT_TRUE(result.attributes.view().has_colors());
  for (const auto& [place, label] : last) {
    const auto [x, y, z] = place;
    EXPECT_EQ(label_at(result, {x, y, z}, 3), label);
  }
}

TEST(Labels, HaveNamesAndCanBeChosen) {
  const std::vector<LabelledVoxel> voxels{
      {{0, 0, 0}, 1}, {{1, 0, 0}, 2}, {{2, 0, 0}, 3}, {{3, 0, 0}, -40}};
  const LabelledVoxels source(voxels);
  const ImportResult all = import_labels(source, 2);
  EXPECT_EQ(all.labels, (std::vector<Label>{-40, 1, 2, 3}));
  EXPECT_EQ(all.label_names, (std::vector<std::string>{"-40", "tree 1", "rock", "tree 3"}));

  const auto kept = [&](const std::vector<std::string>& labels, bool drops) {
    const ImportResult result = import_labels(source, 2, nullptr, labels, drops);
    EXPECT_EQ(result.read, 4u);
    EXPECT_EQ(result.unwanted + result.labels.size(), 4u);
    return result.labels;
  };
  EXPECT_EQ(kept({"tree"}, false), (std::vector<Label>{1, 3}));
  EXPECT_EQ(kept({"-40", "rock", "500"}, false), (std::vector<Label>{-40, 2}));
  EXPECT_EQ(kept({"tree"}, true), (std::vector<Label>{-40, 2}));
  EXPECT_NE(error_of([&] { kept({"shrub"}, false); }).find("has no label 'shrub'"),
            std::string::npos);
}

TEST(Labels, AModelNamesItsMaterialsAndCountsThem) {
  const std::vector<LabelledVoxel> voxels = random_labels(4, 500, 3, 8);
  const LabelledVoxels source(voxels);
  ImportOptions options;
  options.resolution = 16;
  const TempDir dir;
  options.folder = dir.path();
  const DagModel model = import_model(source, options, "test").model;
  const AttributesMetadata& attributes = model.metadata().attributes;
  EXPECT_EQ(attributes.labels, (std::vector<Label>{-2, -1, 0, 1, 2, 3}));
  EXPECT_EQ(find_material(attributes, "rock"), 4u);
  EXPECT_EQ(find_material(attributes, "-2"), 0u);
  EXPECT_EQ(find_material(attributes, "5"), std::nullopt);

  std::vector<MaterialVoxels> expected(6);
  std::vector<Vec3i> kept;
  const ImportResult result = import_labels(source, 4);
  std::map<Place, bool> seen;
  for (const LabelledVoxel& v : voxels) {
    if (!seen.emplace(Place{v.voxel.x, v.voxel.y, v.voxel.z}, true).second) continue;
    const auto id = static_cast<std::size_t>(label_at(result, v.voxel, 4) + 2);
    MaterialVoxels& of = expected[id];
    const Vec3i end = v.voxel + Vec3i{1, 1, 1};
    of.bounds = of.voxels++ == 0 ? Box3i{v.voxel, end}
                                 : Box3i{min(of.bounds.lo, v.voxel), max(of.bounds.hi, end)};
    if (id == 1 || id == 4) kept.push_back(v.voxel);
  }
  EXPECT_EQ(material_voxels(model.view(), model.attributes()), expected);
  EXPECT_EQ(
      keep_materials(model.view(), model.attributes(), {false, true, false, false, true, false}),
      brute_svdag(4, kept));
}

TEST(Labels, OfAPaletteHaveTwentyOneBits) {
  const LabelledVoxels least({{{0, 0, 0}, 0}, {{1, 0, 0}, (1 << 21) - 1}}, true);
  EXPECT_EQ(import_labels(least, 2).labels, (std::vector<Label>{0, (1 << 21) - 1}));
  for (const Label label : {Label{-1}, Label{1} << 21})
    EXPECT_NE(error_of([&] {
                import_labels(LabelledVoxels({{{0, 0, 0}, label}}, true), 2);
              }).find("labels of a palette are from 0 to 2097151"),
              std::string::npos);
}

TEST(Labels, TooManyAreRefused) {
  std::vector<LabelledVoxel> voxels;
  for (int i = 0; i <= 65535; ++i) voxels.push_back({{i & 63, i >> 6 & 63, i >> 12}, i});
  EXPECT_NE(
      error_of([&] { import_labels(LabelledVoxels(voxels), 6); }).find("more than 65535 labels"),
      std::string::npos);
  voxels.pop_back();
  EXPECT_EQ(import_labels(LabelledVoxels(voxels), 6).labels.size(), 65535u);
}

/// Files of points with labels.
class LabelFiles : public testing::Test {
 protected:
  /// Returns the labels of a file of these bytes, in its order.
  std::vector<Label> labels(const std::string& name, const std::string& bytes,
                            const std::string& field = "") const {
    write_text(dir_ / name, bytes);
    std::vector<Label> found;
    open_voxel_source(dir_ / name, {.labels = field})->visit_all([&](const VoxelBatch& batch) {
      EXPECT_EQ(batch.labels.size(), batch.places.size());
      found.insert(found.end(), batch.labels.begin(), batch.labels.end());
    });
    return found;
  }
  std::string error(const std::string& name, const std::string& bytes,
                    const std::string& field = "") const {
    return error_of([&] { labels(name, bytes, field); });
  }
  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  TempDir dir_;
  const std::vector<Label> kExpected{7, 300, -2};
};

TEST_F(LabelFiles, PlyHasThemInAProperty) {
  const std::string header =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nproperty int ";
  const std::string rows = "end_header\n0 0 0 1 2 3 7\n1 0 0 1 2 3 300\n2 0 0 1 2 3 -2\n";
  for (const char* const name : {"label", "Classification", "instance_id", "scalar_Label"})
    EXPECT_EQ(labels("p.ply", "ply\nformat ascii 1.0\n" + header + name + "\n" + rows), kExpected);
  const std::string other = "ply\nformat ascii 1.0\n" + header + "house\n" + rows;
  EXPECT_EQ(labels("p.ply", other, "House"), kExpected);
  EXPECT_TRUE(has(error("p.ply", other), "its fields are x, y, z, red, green, blue, house"));
  std::string binary = "ply\nformat binary_little_endian 1.0\n" + header + "label\nend_header\n";
  for (int i = 0; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis) append(binary, axis == 0 ? static_cast<float>(i) : 0.0f);
    binary += "abc";
    append(binary, static_cast<std::int32_t>(kExpected[static_cast<std::size_t>(i)]));
  }
  EXPECT_EQ(labels("p.ply", binary), kExpected);
}

TEST_F(LabelFiles, PcdHasThemInAField) {
  const std::string header =
      "VERSION .7\nFIELDS x y z rgb label\nSIZE 4 4 4 4 4\nTYPE F F F U I\nCOUNT 1 1 1 1 1\n"
      "WIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA ";
  EXPECT_EQ(labels("p.pcd", header + "ascii\n0 0 0 255 7\n1 0 0 9 300\n2 0 0 1 -2\n"), kExpected);
  std::string binary = header + "binary\n";
  for (const Label label : kExpected) {
    for (int i = 0; i < 3; ++i) append(binary, 1.5f);
    append(binary, std::uint32_t{5});
    append(binary, static_cast<std::int32_t>(label));
  }
  EXPECT_EQ(labels("p.pcd", binary), kExpected);
  EXPECT_TRUE(has(error("p.pcd", binary, "ring"), "has no field 'ring'"));
}

TEST_F(LabelFiles, TextsHaveThemInAColumn) {
  EXPECT_EQ(labels("p.csv", "x,y,z,class\n0,0,0,7\n1,0,0,300\n2,0,0,-2\n"), kExpected);
  EXPECT_EQ(labels("p.xyz", "0 0 0 9 7\n1 0 0 9 300\n2 0 0 9 -2\n", "5"), kExpected);
  EXPECT_EQ(labels("p.txt", "# X Y Z kind\n0 0 0 7\n1 0 0 300\n2 0 0 -2\n", "kind"), kExpected);
  EXPECT_TRUE(has(error("p.xyz", "0 0 0 9\n1 0 0\n", "4"), "line 2: has no label in column 4"));
  EXPECT_TRUE(has(error("p.xyz", "0 0 0 1.5\n", "4"), "has the label 1.5"));
  EXPECT_TRUE(has(error("p.xyz", "0 0 0 1\n"), "its fields are without names"));
}

TEST_F(LabelFiles, TextsHaveChannelsInColumns) {
  const auto read = [&](const std::string& name, const std::string& bytes,
                        const VoxelSourceOptions& options) {
    write_text(dir_ / name, bytes);
    std::vector<double> values;
    const auto source = open_voxel_source(dir_ / name, options);
    for (const ChannelSpec& spec : source->channels()) EXPECT_EQ(spec.kind, ChannelKind::kF32);
    EXPECT_TRUE(source->warnings().empty());
    source->visit_all([&](const VoxelBatch& batch) {
      values.insert(values.end(), batch.channels.begin(), batch.channels.end());
    });
    return values;
  };
  EXPECT_EQ(read("p.csv", "x,y,z,heat,class\n0,0,0,1.5,7\n1,0,0,-2,300\n",
                 {.labels = "class", .channels = {{"Heat", {}}, {"5", "kind"}}}),
            (std::vector<double>{1.5, 7, -2, 300}));
  const std::string rows = "0 0 0 0.5 1 2 9\n1 0 0 0.5 1 2 -8.25\n";
  EXPECT_EQ(read("p.xyz", rows, {.channels = {{"7", {}}}}), (std::vector<double>{9, -8.25}));
  EXPECT_EQ(open_voxel_source(dir_ / "p.xyz", {.channels = {{"7", {}}}})->channels()[0].name, "7");
  const auto error = [&](const std::string& bytes, const std::string& field) {
    return error_of([&] { read("p.xyz", bytes, {.channels = {{field, {}}}}); });
  };
  EXPECT_TRUE(has(error(rows, "8"), "line 1: has no number in column 8"));
  EXPECT_TRUE(has(error("0 0 0 1\n1 0 0\n", "4"), "line 2: has no number in column 4"));
  EXPECT_TRUE(has(error(rows, "2"), "has no field '2'; its fields are without names"));
  EXPECT_TRUE(has(error("# x y z heat\n" + rows, "cold"),
                  "has no field 'cold'; its fields are x, y, z, heat"));
  EXPECT_TRUE(has(error(rows, ""), "a channel needs the name of a field"));
}

/// Returns a .npy file.
std::string npy(const std::string& dtype, const std::string& shape, const std::string& data) {
  std::string header = "{'descr': " + dtype + ", 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize((header.size() + 10) / 64 * 64 + 64 - 11, ' ');
  header += '\n';
  std::string bytes = "\x93NUMPY\x01";
  bytes += '\0';
  append(bytes, static_cast<std::uint16_t>(header.size()));
  return bytes + header + data;
}

TEST_F(LabelFiles, NpyHasThemInAFieldOrAsValues) {
  std::string rows;
  for (const Label label : kExpected) {
    for (int i = 0; i < 3; ++i) append(rows, std::int32_t{4});
    append(rows, label);
  }
  EXPECT_EQ(labels("p.npy", npy("[('voxel', '<i4', (3,)), ('label', '<i8')]", "(3,)", rows)),
            kExpected);
  std::string volume;
  for (const int value : {7, 0, 300, 0, 0, -2}) append(volume, static_cast<std::int16_t>(value));
  EXPECT_EQ(labels("v.npy", npy("'<i2'", "(1, 2, 3)", volume)), kExpected);
  EXPECT_TRUE(has(error("c.npy", npy("'|u1'", "(1, 1, 2, 3)", "abcdef")), "holds colours"));
  EXPECT_TRUE(has(error("p.npy", npy("'<i2'", "(1, 3)", "abcdef")), "without fields"));
  EXPECT_TRUE(has(error("v.npy", npy("'<i2'", "(1, 2, 3)", volume), "organ"),
                  "has no fields, of which 'organ' could have labels"));
  std::string real;
  append(real, 2.5);
  EXPECT_TRUE(has(error("v.npy", npy("'<f8'", "(1, 1, 1)", real)), "has the label 2.5"));
}

TEST_F(LabelFiles, SplatsHaveNone) {
  const std::string splats =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nproperty float opacity\nproperty float scale_0\nproperty float scale_1\n"
      "property float scale_2\nproperty float rot_0\nproperty float rot_1\nproperty float rot_2\n"
      "property float rot_3\nproperty int label\nend_header\n0 0 0 1 1 1 1 1 0 0 0 5\n";
  EXPECT_TRUE(has(error("s.ply", splats), "holds splats, which have no labels"));
}

TEST_F(LabelFiles, FormatsWithoutLabelsSaySo) {
  EXPECT_TRUE(has(error("b.binvox", "#binvox 1\ndim 2 2 2\ntranslate 0 0 0\nscale 1\ndata\n" +
                                        std::string("\x01\x08", 2)),
                  "has a format of which no labels are read"));
}

}  // namespace
}  // namespace voxdag
