#include "voxdag/algebra/attributes/placed_channels.hpp"

#include <gtest/gtest.h>

#include <map>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/algebra/attributes/channel_of_voxels.hpp"
#include "voxdag/algebra/attributes/placed_attributes.hpp"
#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/algebra/combine.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/algebra/reorient.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace {

/// A DAG with one channel, whose values tell the voxels.
struct ChannelDag {
  ChannelDag(Svdag of, int finest, const ChannelSpec& spec, double scale) : dag(std::move(of)) {
    attributes.index = build_cell_index(dag.view(), finest);
    const EncodedChannel channel =
        channel_of_voxels(dag.view(), attributes.index.view(), spec,
                          [scale](Vec3i v) { return scale * (v.x + 100 * v.y + 10000 * v.z); });
    attributes.channels = join_channels(attributes.index.cells, {&channel, 1});
  }
  ColoredDagView view() const { return {dag.view(), attributes.view()}; }
  AttributeLayer layer(Vec3i offset = {}, const Orientation& turn = {}) const {
    return {view(), turn, offset, {}};
  }

  Svdag dag;
  DagAttributes attributes;
};

double value_at(const ColoredDagView& colored, std::size_t channel, Vec3i cell, int level) {
  std::uint64_t number = 0;
  EXPECT_TRUE(find_number(colored, cell, level, number));
  return colored.attributes.channels[channel].read(number);
}

/// Compares all cells with means of `value_of`, by the rule of channel_of_voxels.hpp.
void expect_cells(const ColoredDagView& colored, std::size_t channel, ChannelKind kind,
                  const std::function<double(Vec3i)>& value_of) {
  struct Mean {
    double sum = 0, weight = 0;
  };
  const int finest = colored.attributes.index.finest_level, cut = colored.dag.levels - finest;
  std::map<std::uint64_t, Mean> means;
  for_each_voxel(colored.dag, whole_grid(colored.dag.levels), [&](Vec3i voxel) {
    Mean& mean = means[morton_encode(voxel) >> 3 * cut];
    mean.sum += value_of(voxel);
    ++mean.weight;
  });
  for (int level = finest; level >= 0; --level) {
    std::map<std::uint64_t, Mean> above;
    for (auto& [code, mean] : means) {
      const double value = value_of_code(kind, channel_code(kind, mean.sum / mean.weight));
      ASSERT_EQ(value_at(colored, channel, morton_decode(code), level), value) << "level " << level;
      const double weight = level == finest ? 1 : mean.weight;
      above[code >> 3].sum += value * weight;
      above[code >> 3].weight += weight;
    }
    means = std::move(above);
  }
}

TEST(ChannelOfVoxels, CellsHaveTheMeansOfTheirChildren) {
  for (const ChannelKind kind : {ChannelKind::kF32, ChannelKind::kI32})
    for (int finest = 0; finest <= 5; ++finest) {
      const ChannelDag made(brute_svdag(5, random_voxels(5, 300, 7)), finest, {"a", kind, 0}, 1);
      expect_cells(made.view(), 0, kind, [](Vec3i v) { return v.x + 100.0 * v.y + 10000.0 * v.z; });
    }
}

TEST(PlacedChannels, MovedAndTurnedVoxelsKeepTheirValues) {
  const ChannelDag made(brute_svdag(5, random_voxels(5, 200, 3)), 5, {"a", ChannelKind::kF32, 0},
                        0.5);
  const Vec3i by{4, 8, 13};
  const Orientation turn{{1, 2, 0}, {true, false, true}};
  Svdag turned = reorient(made.dag.view(), turn);
  const AttributeLayer layer = made.layer({}, turn);
  const DagAttributes attributes = placed_attributes(turned.view(), {&layer, 1});
  expect_cells({turned.view(), attributes.view()}, 0, ChannelKind::kF32, [&](Vec3i voxel) {
    return value_at(made.view(), 0, source_cell(turn, voxel, 5), 5);
  });
  const Svdag larger = brute_svdag(6, [&] {
    std::vector<Vec3i> voxels;
    for_each_voxel(made.dag.view(), whole_grid(5), [&](Vec3i v) { voxels.push_back(v + by); });
    return voxels;
  }());
  const AttributeLayer moved = made.layer(by);
  const DagAttributes of_larger = placed_attributes(larger.view(), {&moved, 1});
  EXPECT_EQ(of_larger.index.finest_level, 6);
  expect_cells({larger.view(), of_larger.view()}, 0, ChannelKind::kF32,
               [&](Vec3i voxel) { return value_at(made.view(), 0, voxel - by, 5); });
}

TEST(PlacedChannels, TheFirstLayerCountsAndNewVoxelsTakeTheNearestValue) {
  const ChannelDag a(brute_svdag(4, random_voxels(4, 60, 1)), 4, {"a", ChannelKind::kU16, 0}, 0.01);
  const ChannelDag b(brute_svdag(4, random_voxels(4, 60, 2)), 4, {"b", ChannelKind::kI16, 0}, 0.02);
  const Svdag both = combine(a.dag.view(), b.dag.view(), SetOperation::kUnion);
  const AttributeLayer layers[] = {a.layer(), b.layer()};
  const DagAttributes attributes = placed_attributes(both.view(), layers);
  const ColoredDagView result{both.view(), attributes.view()};
  ASSERT_EQ(attributes.channels.view().count(), 2u);
  for (const ChannelDag* from : {&a, &b}) {
    const ChannelView channel = from->attributes.channels.view()[0];
    expect_cells(result, from == &a ? 0 : 1, channel.kind, [&](Vec3i voxel) {
      const Vec3d centre = static_cast<Vec3d>(voxel) + Vec3d{0.5, 0.5, 0.5};
      return value_at(from->view(), 0, nearest_voxel(from->dag.view(), centre)->voxel, 4);
    });
  }
}

TEST(PlacedChannels, AChannelOfTwoKindsHasAKindForBoth) {
  const Svdag dag = brute_svdag(4, random_voxels(4, 60, 1));
  const auto joined = [&](const ChannelSpec& first, const ChannelSpec& second) {
    const ChannelDag a(dag, 4, first, 0.01), b(dag, 4, second, 0.01);
    const AttributeLayer layers[] = {a.layer(), b.layer()};
    return spec_of(placed_attributes(dag.view(), layers).channels.view()[0]);
  };
  const ChannelSpec u16{"a", ChannelKind::kU16, 0}, i16{"a", ChannelKind::kI16, 0},
      f32{"a", ChannelKind::kF32, 0.5};
  EXPECT_EQ(joined(u16, u16), u16);
  EXPECT_EQ(joined(u16, i16).kind, ChannelKind::kI32);
  EXPECT_EQ(joined(u16, f32), f32);
}

TEST(CoarsenAttributes, CellsKeepTheirChannels) {
  const ChannelDag made(brute_svdag(5, random_voxels(5, 300, 7)), 5, {"a", ChannelKind::kF32, 0.1},
                        0.3);
  const Svdag coarse = coarsen(made.dag.view(), 3);
  const DagAttributes attributes = coarsen_attributes(made.view(), coarse.view());
  for_each_voxel(coarse.view(), whole_grid(3), [&](Vec3i cell) {
    for (int level = 0; level <= 3; ++level) {
      const Vec3i at{cell.x >> (3 - level), cell.y >> (3 - level), cell.z >> (3 - level)};
      ASSERT_EQ(value_at({coarse.view(), attributes.view()}, 0, at, level),
                value_at(made.view(), 0, at, level));
    }
  });
}

}  // namespace
}  // namespace voxdag
