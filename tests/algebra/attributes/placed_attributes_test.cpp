#include "voxdag/algebra/attributes/placed_attributes.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "algebra/voxel_grid.hpp"
#include "support/number_colors.hpp"
#include "support/with_threads.hpp"
#include "voxdag/algebra/combine.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/algebra/grow.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/algebra/reorient.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace {

/// Cells of one level by their places.
using Cells = std::map<std::uint64_t, CellValues>;

/// The rules of placed_attributes(), cell by cell.
class Reference {
 public:
  Reference(const SvdagView& dag, std::span<const AttributeLayer> layers, const NewValues& given,
            const ValueKinds& kinds)
      : dag_(dag), layers_(layers), given_(given), kinds_(kinds) {
    int cut = kMaxLevels;
    for (const AttributeLayer& layer : layers)
      cut = std::min(cut, layer.colored.dag.levels - finest_of(layer));
    finest_ = std::max(dag.levels - cut, 0);
    for (int level = 0; level <= dag.levels; ++level) {
      levels_.emplace_back();
      for_each_voxel(dag, whole_grid(dag.levels), [&](Vec3i v) {
        levels_.back().insert(morton_encode(v) >> 3 * (dag.levels - level));
      });
    }
  }

  int finest() const { return finest_; }
  const std::set<std::uint64_t>& cells(int level) const {
    return levels_[static_cast<std::size_t>(level)];
  }

  CellValues values(int level, std::uint64_t code) const {
    if (const auto kept = kept_values(level, code)) return *kept;
    const int below = level == finest_ ? dag_.levels : level + 1;
    CellMean mean(kinds_);
    for (const std::uint64_t child : below_cell(level, code, below))
      if (level == finest_)
        mean.add(voxel_values(morton_decode(child)), 1);
      else
        mean.add(values(below, child), below_cell(below, child, finest_).size());
    return mean.result();
  }

 private:
  static int finest_of(const AttributeLayer& layer) {
    return layer.colored.attributes.index.finest_level;
  }

  std::vector<std::uint64_t> below_cell(int level, std::uint64_t code, int below) const {
    const int shift = 3 * (below - level);
    std::vector<std::uint64_t> found;
    for (auto at = cells(below).lower_bound(code << shift);
         at != cells(below).end() && *at >> shift == code; ++at)
      found.push_back(*at);
    return found;
  }

  static CellValues read(const AttributeLayer& layer, std::uint64_t number) {
    const DagAttributesView& of = layer.colored.attributes;
    CellValues values;
    if (of.has_colors()) values.color = read_value(of.colors, number);
    if (of.has_normals()) {
      const Value8 normal = read_value(of.normals, number);
      for (int axis = 0; axis < 3; ++axis) {
        const int value = normal[layer.orientation.source_axis[axis]];
        values.normal[axis] = static_cast<std::uint8_t>(
            layer.orientation.is_flipped[axis] ? std::min(256 - value, 255) : value);
      }
    }
    if (of.has_materials()) {
      values.material = static_cast<std::uint16_t>(read_material(of.materials, number));
      if (!layer.material_ids.empty()) values.material = layer.material_ids[values.material];
    }
    return values;
  }

  /// Returns the values of a cell whose subtree is one of a layer, at a cell of its size.
  std::optional<CellValues> kept_values(int level, std::uint64_t code) const {
    const int size = dag_.levels - level;
    for (const AttributeLayer& layer : layers_) {
      if (!(layer.orientation == Orientation{})) return {};
      for (int axis = 0; axis < 3; ++axis)
        if (layer.offset[axis] % (1 << size) != 0) return {};
      const int layer_level = layer.colored.dag.levels - size;
      if (layer_level < 0) return {};
      const Vec3i place = morton_decode(code);
      Vec3i there;
      for (int axis = 0; axis < 3; ++axis)
        there[axis] = place[axis] - layer.offset[axis] / (1 << size);
      std::uint64_t number = 0;
      const int asked = std::min(layer_level, finest_of(layer));
      const int up = layer_level - asked;
      if ((there.x | there.y | there.z) >> layer_level != 0 ||
          !find_cell_number(layer.colored.dag, layer.colored.attributes.index,
                            {there.x >> up, there.y >> up, there.z >> up}, asked, number))
        continue;
      const ValueKinds of = kinds_of(layer.colored.attributes);
      if (finest_of(layer) - layer.colored.dag.levels != finest_ - dag_.levels ||
          (kinds_.colors && !of.colors) || (kinds_.normals && !of.normals) ||
          (kinds_.materials != 0 && of.materials == 0))
        return {};
      for (std::uint64_t i = 0; i < std::uint64_t{1} << 3 * (finest_ - level); ++i) {
        const int below = finest_ - level;
        const Vec3i cell = there * (1 << below) + morton_decode(i);
        std::uint64_t any = 0;
        if (find_cell_number(layer.colored.dag, layer.colored.attributes.index, cell,
                             finest_of(layer),
                             any) != cells(finest_).contains(code << 3 * below | i))
          return {};
      }
      return read(layer, number);
    }
    return {};
  }

  CellValues voxel_values(Vec3i voxel) const {
    const auto value_of = [&](const auto& has, bool is_given) -> std::optional<CellValues> {
      const AttributeLayer* first = nullptr;
      for (const AttributeLayer& layer : layers_) {
        if (!has(layer.colored.attributes)) continue;
        const int levels = layer.colored.dag.levels;
        const Vec3i there = source_cell(layer.orientation, voxel - layer.offset, levels);
        std::uint64_t number = 0;
        const int cut = levels - finest_of(layer);
        if ((there.x | there.y | there.z) >> levels == 0 &&
            find_cell_number(layer.colored.dag, layer.colored.attributes.index,
                             {there.x >> cut, there.y >> cut, there.z >> cut}, finest_of(layer),
                             number))
          return read(layer, number);
        if (first == nullptr) first = &layer;
      }
      if (is_given) return {};
      const int levels = first->colored.dag.levels;
      const Vec3i there = source_cell(first->orientation, voxel - first->offset, levels);
      std::uint64_t number = 0;
      find_cell_number(
          first->colored.dag, first->colored.attributes.index,
          nearest_voxel(first->colored.dag, static_cast<Vec3d>(there) + Vec3d{0.5, 0.5, 0.5})
              ->voxel,
          levels, number);
      return read(*first, number);
    };
    CellValues values;
    if (kinds_.colors) {
      const auto from = value_of([](const auto& of) { return of.has_colors(); }, !!given_.color);
      values.color = from ? from->color : *given_.color;
    }
    if (kinds_.normals)
      values.normal = value_of([](const auto& of) { return of.has_normals(); }, false)->normal;
    if (kinds_.materials != 0) {
      const auto from =
          value_of([](const auto& of) { return of.has_materials(); }, !!given_.material);
      values.material = from ? from->material : *given_.material;
    }
    return values;
  }

  SvdagView dag_;
  std::span<const AttributeLayer> layers_;
  NewValues given_;
  ValueKinds kinds_;
  int finest_;
  std::vector<std::set<std::uint64_t>> levels_;
};

ValueKinds kinds_of_layers(std::span<const AttributeLayer> layers, std::uint32_t materials) {
  ValueKinds kinds;
  for (const AttributeLayer& layer : layers) {
    const ValueKinds of = kinds_of(layer.colored.attributes);
    kinds.colors |= of.colors;
    kinds.normals |= of.normals;
    if (of.materials != 0) kinds.materials = materials != 0 ? materials : of.materials;
  }
  return kinds;
}

/// Expects the values of the rules in every cell.
void expect_rules(const Svdag& dag, std::span<const AttributeLayer> layers,
                  const NewValues& given = {}, std::uint32_t materials = 0) {
  const DagAttributes attributes = placed_attributes(dag.view(), layers, given, materials);
  const ValueKinds kinds = kinds_of_layers(layers, materials);
  if (dag.view().is_empty()) {
    EXPECT_TRUE(attributes.view().is_empty());
    return;
  }
  ASSERT_EQ(kinds_of(attributes.view()), kinds);
  const Reference reference(dag.view(), layers, given, kinds);
  ASSERT_EQ(attributes.index, build_cell_index(dag.view(), reference.finest()));
  EXPECT_EQ(attributes.color_errors.squared, 0u);
  StoredReader reader({attributes.view(), {}});
  for (int level = 0; level <= reference.finest(); ++level)
    for (const std::uint64_t code : reference.cells(level)) {
      std::uint64_t number = 0;
      ASSERT_TRUE(find_cell_number(dag.view(), attributes.view().index, morton_decode(code), level,
                                   number));
      ASSERT_EQ(reader.values(number), reference.values(level, code))
          << "level " << level << ", cell " << code;
    }
}

const int kFinest[] = {5, 4, 2};  // L, L-1, L-3

Svdag some_dag(unsigned seed, int count = 700) {
  return brute_svdag(5, random_voxels(5, count, seed));
}

TEST(PlacedAttributes, PartsKeepTheValuesOfTheirCells) {
  const Svdag dag = some_dag(1);
  for (const int finest : kFinest) {
    const NumberColors colors(dag.view(), finest);
    const AttributeLayer layer{colors.view()};
    expect_rules(dag, {&layer, 1});
    expect_rules(crop(dag.view(), {{3, 0, 5}, {20, 32, 17}}), {&layer, 1});
    const Svdag other = some_dag(2, 3000);
    for (const auto operation : {SetOperation::kIntersection, SetOperation::kDifference})
      expect_rules(combine(dag.view(), other.view(), operation), {&layer, 1});
    expect_rules(erode(other.view(), 1, Neighbours::k6), {&layer, 1});
    expect_rules(crop(dag.view(), {{0, 0, 0}, {0, 0, 0}}), {&layer, 1});
  }
}

TEST(PlacedAttributes, MovedVoxelsKeepTheirValues) {
  const Svdag dag = some_dag(3);
  for (const int finest : kFinest) {
    const NumberColors colors(dag.view(), finest);
    for (const Vec3i by : {Vec3i{1, 2, -3}, Vec3i{8, 0, 0}, Vec3i{-4, 4, 12}, Vec3i{2, -2, 6}})
      for (const int levels : {4, 5, 6, 7}) {
        const AttributeLayer layer{colors.view(), {}, by};
        expect_rules(shift(dag.view(), by, levels), {&layer, 1});
      }
  }
}

TEST(PlacedAttributes, TurnedVoxelsKeepTheirValuesAndNormalsTurn) {
  const Svdag dag = some_dag(4, 300);
  for (const int finest : kFinest) {
    const NumberColors colors(dag.view(), finest);
    for (int axis = 0; axis < 3; ++axis)
      for (const Orientation& orientation : {mirrored(axis), rotated(axis, 1), rotated(axis, 2),
                                             then(rotated(axis, 3), mirrored(0))}) {
        const AttributeLayer layer{colors.view(), orientation};
        expect_rules(reorient(dag.view(), orientation), {&layer, 1});
      }
  }
}

TEST(PlacedAttributes, NewVoxelsTakeTheNearestOrTheGivenValues) {
  const Svdag dag = some_dag(5, 60);
  for (const int finest : kFinest) {
    const NumberColors colors(dag.view(), finest);
    const AttributeLayer layer{colors.view()};
    const Svdag grown = dilate(dag.view(), 2, Neighbours::k6);
    expect_rules(grown, {&layer, 1});
    expect_rules(grown, {&layer, 1}, {Value8{1, 2, 3}, {}});
    expect_rules(grown, {&layer, 1}, {{}, 4});
    expect_rules(grown, {&layer, 1}, {Value8{200, 20, 3}, 2});
  }
}

TEST(PlacedAttributes, TheFirstLayerCountsThenTheSecond) {
  const Svdag a = some_dag(6), b = brute_svdag(4, random_voxels(4, 500, 7));
  for (const int finest_a : {5, 4, 2})
    for (const int finest_b : {4, 3, 1})
      for (const Vec3i by : {Vec3i{0, 0, 0}, Vec3i{8, 16, 0}, Vec3i{7, 4, 9}}) {
        const NumberColors colors_a(a.view(), finest_a), colors_b(b.view(), finest_b);
        const Svdag all = combine(a.view(), shift(b.view(), by, 5).view(), SetOperation::kUnion);
        AttributeLayer layers[] = {{colors_a.view()}, {colors_b.view(), {}, by, {7, 5, 3, 6, 0}}};
        expect_rules(all, layers, {}, 8);
        layers[0].colored.attributes.normals = {};
        layers[1].colored.attributes.materials = {};
        expect_rules(all, layers);
        layers[0].colored.attributes.materials = {};
        expect_rules(all, layers, {Value8{9, 9, 9}, {}});
      }
}

TEST(PlacedAttributes, BytesAreEqualOnAnyNumberOfThreads) {
  const Svdag dag = brute_svdag(7, random_voxels(7, 60'000, 8));
  const NumberColors colors(dag.view(), 7);
  const AttributeLayer layer{colors.view(), {}, {1, 0, 5}};
  const Svdag moved = shift(dag.view(), layer.offset, 7);
  const auto bytes_on = [&](int threads) {
    const ThreadLimit control(8);
    DagAttributes result;
    with_threads(threads, [&] { result = placed_attributes(moved.view(), {&layer, 1}); });
    return std::tuple(result.colors.words, result.normals.words, result.materials.words);
  };
  const auto one = bytes_on(1);
  EXPECT_EQ(bytes_on(2), one);
  EXPECT_EQ(bytes_on(7), one);
}

TEST(PlacedAttributes, BoundsLimitTheChange) {
  const Svdag dag = some_dag(9);
  const NumberColors colors(dag.view(), 5);
  const AttributeLayer layer{colors.view()};
  const DagAttributes attributes = placed_attributes(dag.view(), {&layer, 1}, {}, 0, {0.1, 10});
  EXPECT_LT(attributes.colors.words.size(),
            placed_attributes(dag.view(), {&layer, 1}).colors.words.size());
  const ValueMetric metric = make_value_metric(kColorWeights, 255 * 0.1);
  for (std::uint64_t i = 0; i < attributes.index.cells; ++i)
    ASSERT_LE(metric.error(color_of_number(i), read_value(attributes.colors.view(), i)),
              metric.bound);
}

TEST(PlacedAttributes, MemoryIsCountedAndReleased) {
  const Svdag dag = brute_svdag(7, random_voxels(7, 20'000, 4));
  const NumberColors colors(dag.view(), 7);
  const AttributeLayer layer{colors.view()};
  MemoryBudget budget(std::uint64_t{1} << 30);
  placed_attributes(dag.view(), {&layer, 1}, {}, 0, {}, &budget);
  EXPECT_GT(budget.peak(), 100'000u);
  EXPECT_EQ(budget.used(), 0u);
  MemoryBudget small(100'000);
  EXPECT_THROW(placed_attributes(dag.view(), {&layer, 1}, {}, 0, {}, &small), OverMemory);
  EXPECT_EQ(small.used(), 0u);
}

}  // namespace
}  // namespace voxdag
