// Colours of imported points against means that are computed cell by cell.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "support/brute_svdag.hpp"
#include "support/temp_dir.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/formats/imports/colors/linear_color.hpp"
#include "voxdag/formats/imports/import_voxels.hpp"
#include "voxdag/stored/attributes/cell_index_lookup.hpp"
#include "voxdag/stored/attributes/page_reader.hpp"

namespace voxdag {
namespace {

struct ColoredVoxel {
  Vec3i voxel;
  Rgb8 color;
};

/// Voxels in memory.
class ListedVoxels : public VoxelSource {
 public:
  explicit ListedVoxels(const std::vector<ColoredVoxel>& voxels) {
    for (const ColoredVoxel& v : voxels) {
      places_.push_back(static_cast<Vec3d>(v.voxel));
      colors_.push_back(v.color);
    }
  }
  bool has_points() const override { return false; }
  bool has_colors() const override { return true; }
  void visit_all(const VisitBatch& visit) const override {
    for (std::size_t begin = 0; begin < places_.size(); begin += 100) {
      const std::size_t count = std::min<std::size_t>(100, places_.size() - begin);
      visit({{places_.data() + begin, count}, {colors_.data() + begin, count}});
    }
  }

 private:
  std::vector<Vec3d> places_;
  std::vector<Rgb8> colors_;
};

std::vector<ColoredVoxel> random_voxels(int levels, std::size_t count, unsigned seed) {
  std::mt19937 rng(seed);
  const auto byte = [&] { return static_cast<std::uint8_t>(rng()); };
  std::vector<ColoredVoxel> voxels;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&] { return static_cast<std::int32_t>(rng() % (1u << levels)); };
    voxels.push_back({{at(), at(), at()}, {byte(), byte(), byte()}});
  }
  return voxels;
}

ImportResult import_listed(const std::vector<ColoredVoxel>& voxels, int levels,
                           MemoryBudget* memory = nullptr) {
  const TempDir dir;
  ImportOptions options;
  options.resolution = std::int64_t{1} << levels;
  options.color_bound = 0;
  options.folder = dir.path();
  return import_voxels(ListedVoxels(voxels), options, memory);
}

using LinearSum = std::array<double, 4>;  ///< Red, green and blue in linear light; the number.

LinearSum mean_of(LinearSum sum) {
  for (std::size_t c = 0; c < 3; ++c) sum[c] /= sum[3];
  sum[3] = 1;
  return sum;
}

void add_to(LinearSum& sum, const LinearSum& more) {
  for (std::size_t c = 0; c < 4; ++c) sum[c] += more[c];
}

TEST(LinearColor, GoesBackToItself) {
  for (int c = 0; c < 256; ++c) EXPECT_EQ(encoded_of(linear_of(static_cast<std::uint8_t>(c))), c);
  for (int linear = 0; linear < 65536; ++linear) {
    const double encoded = 255 * linear_to_srgb(static_cast<float>(linear) / 65535.0f);
    EXPECT_NEAR(encoded_of(static_cast<std::uint16_t>(linear)), encoded, 0.51) << linear;
  }
}

TEST(ImportColors, CellsHaveTheMeansOfTheirVoxels) {
  for (const int levels : {2, 3, 4, 6})
    for (const std::size_t count : {std::size_t{1}, std::size_t{30}, std::size_t{3000}}) {
      const std::vector<ColoredVoxel> voxels =
          random_voxels(levels, count, static_cast<unsigned>(levels));
      const ImportResult result = import_listed(voxels, levels);
      std::vector<Vec3i> places;
      for (const ColoredVoxel& v : voxels) places.push_back(v.voxel);
      EXPECT_EQ(result.dag, brute_svdag(levels, places));

      const SvdagView dag = result.dag.view();
      const CellIndexView index = result.attributes.index.view();
      PageReader colors(result.attributes.colors.view());
      using Place = std::tuple<int, int, int>;
      std::map<Place, LinearSum> cells;
      for (const ColoredVoxel& v : voxels) {
        LinearSum sum{0, 0, 0, 1};
        for (std::size_t c = 0; c < 3; ++c)
          sum[c] = srgb_to_linear(static_cast<float>(v.color[c]) / 255.0f);
        add_to(cells[{v.voxel.x, v.voxel.y, v.voxel.z}], sum);
      }
      for (auto& [place, sum] : cells) sum = mean_of(sum);
      for (int level = levels; level >= 0; --level) {
        std::map<Place, LinearSum> above;
        for (const auto& [place, sum] : cells) {
          const auto [x, y, z] = place;
          std::uint64_t number = 0;
          ASSERT_TRUE(find_cell_number(dag, index, {x, y, z}, level, number));
          const Value8 stored = colors.value(number);
          const LinearSum mean = mean_of(sum);
          const std::uint8_t channels[] = {stored.x, stored.y, stored.z};
          for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(channels[c], 255 * linear_to_srgb(static_cast<float>(mean[c])), 0.6);
          add_to(above[{x / 2, y / 2, z / 2}], sum);
        }
        cells = std::move(above);
      }
    }
}

TEST(ImportColors, OneColorOfAVoxelStaysExact) {
  std::vector<ColoredVoxel> voxels;
  for (int i = 0; i < 64; ++i) {
    const auto c = static_cast<std::uint8_t>(4 * i + 1);
    voxels.push_back({{i % 4, i / 4 % 4, i / 16}, {c, static_cast<std::uint8_t>(255 - c), 7}});
  }
  const ImportResult result = import_listed(voxels, 2);
  PageReader colors(result.attributes.colors.view());
  for (const ColoredVoxel& v : voxels) {
    std::uint64_t number = 0;
    ASSERT_TRUE(
        find_cell_number(result.dag.view(), result.attributes.index.view(), v.voxel, 2, number));
    EXPECT_EQ(colors.value(number), (Value8{v.color[0], v.color[1], v.color[2]}));
  }
}

TEST(ImportColors, OrderAndMemoryDoNotMatter) {
  std::vector<ColoredVoxel> voxels = random_voxels(5, 20'000, 9);
  const ImportResult whole = import_listed(voxels, 5);
  std::mt19937 rng(1);
  std::shuffle(voxels.begin(), voxels.end(), rng);
  MemoryBudget memory(std::uint64_t{3} << 20);
  const ImportResult sorted_in_files = import_listed(voxels, 5, &memory);
  EXPECT_EQ(memory.used(), 0u);
  EXPECT_EQ(whole.dag, sorted_in_files.dag);
  EXPECT_EQ(whole.attributes.index, sorted_in_files.attributes.index);
  const ValuePagesView a = whole.attributes.colors.view(),
                       b = sorted_in_files.attributes.colors.view();
  ASSERT_EQ(a.bytes(), b.bytes());
  PageReader first(a), second(b);
  for (std::uint64_t i = 0; i < whole.attributes.index.cells; ++i)
    ASSERT_EQ(first.value(i), second.value(i));
}

TEST(ImportColors, NoVoxelsHaveNoColors) {
  const ImportResult result = import_listed({}, 4);
  EXPECT_TRUE(result.dag.view().is_empty());
  EXPECT_EQ(result.attributes.index.cells, 0u);
}

}  // namespace
}  // namespace voxdag
