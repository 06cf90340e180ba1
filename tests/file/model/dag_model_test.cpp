#include "voxdag/file/model/dag_model.hpp"

#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/formats/imports/colors/colored_voxel_builder.hpp"

namespace voxdag {
namespace {

/// A model with random voxels and colours.
DagModel colored_model(const TempDir& dir, MemoryBudget* memory = nullptr) {
  ColoredVoxelBuilder builder(6, 10000, dir.path(), {});
  for (const Vec3i v : random_voxels(6, 500, 3))
    builder.add(v, {static_cast<std::uint8_t>(4 * v.x), static_cast<std::uint8_t>(4 * v.y), 9});
  auto [dag, attributes] = builder.finish(0);
  VdagMetadata metadata;
  metadata.grid.levels = 6;
  metadata.source.name = "random";
  metadata.attributes.resolution = 64;
  metadata.attributes.colors = {0, attributes.color_errors.squared};
  return DagModel(std::move(dag), std::move(attributes), metadata, memory);
}

TEST(DagModel, IsReadBackFromBothForms) {
  const TempDir dir;
  const DagModel model = colored_model(dir);
  EXPECT_EQ(model.metadata().counts.voxels, count_svdag(model.view()).voxels);
  model.save(dir / "plain.vdag", false);
  model.save(dir / "compact.vdag", true);
  const DagModel plain(dir / "plain.vdag"), compact(dir / "compact.vdag");
  EXPECT_FALSE(plain.is_compact());
  EXPECT_TRUE(compact.is_compact());
  for (const DagModel* read : {&plain, &compact}) {
    EXPECT_EQ(read->metadata(), model.metadata());
    EXPECT_EQ(read->view().bytes(), model.view().bytes());
    EXPECT_TRUE(read->attributes().has_colors());
  }
  // The file of a model that was read is the file itself.
  plain.save(dir / "again.vdag", false);
  EXPECT_EQ(read_text(dir / "again.vdag"), read_text(dir / "plain.vdag"));
  compact.save(dir / "plain_again.vdag", false);
  EXPECT_EQ(read_text(dir / "plain_again.vdag"), read_text(dir / "plain.vdag"));
}

TEST(DagModel, CountsItsMemory) {
  const TempDir dir;
  MemoryBudget memory;
  {
    const DagModel model = colored_model(dir, &memory);
    EXPECT_GE(memory.used(), model.view().bytes());
  }
  EXPECT_EQ(memory.used(), 0u);
  MemoryBudget little(1000);
  EXPECT_THROW(colored_model(dir, &little), OverMemory);
}

TEST(DagModel, CountsTheBytesOfItsFileOnce) {
  const TempDir dir;
  const DagModel model = colored_model(dir);
  for (const bool is_compact : {false, true}) {
    model.save(dir / "a.vdag", is_compact);
    MemoryBudget memory;
    VdagContainer file(dir / "a.vdag", &memory);
    const std::uint64_t file_bytes = file.bytes().size();
    EXPECT_EQ(memory.used(), file_bytes);
    {
      const DagModel read(file, &memory);
      const std::uint64_t decoded = is_compact ? read.view().bytes() : 0;
      EXPECT_GE(memory.used(), file_bytes + decoded);
      EXPECT_LT(memory.used(), 2 * file_bytes + decoded);
    }
    EXPECT_EQ(memory.used(), file_bytes);
    { const DagModel read(std::move(file), &memory); }
    EXPECT_EQ(memory.used(), 0u);
  }
}

TEST(DagModel, ADamagedFileIsNamedThoughItIsLargerThanTheLimit) {
  const TempDir dir;
  colored_model(dir).save(dir / "a.vdag", false);
  MemoryBudget little(1000);
  EXPECT_THROW(DagModel(dir / "a.vdag", &little), OverMemory);
  write_text(dir / "a.vdag", read_text(dir / "a.vdag").substr(0, 2000));
  EXPECT_NE(error_of([&] { DagModel(dir / "a.vdag", &little); }).find("truncated"),
            std::string::npos);
  EXPECT_EQ(little.used(), 0u);
}

TEST(SceneModel, AnEsvoOrADagIsOpened) {
  const TempDir dir;
  colored_model(dir).save(dir / "a.vdag", false);
  SceneModel scene(dir / "a.vdag");
  EXPECT_NE(scene.voxels().dag(), nullptr);
  EXPECT_FALSE(scene.colored_dag().attributes.is_empty());
  EXPECT_EQ(error_of([&] { scene.show_materials("a.vdag"); }),
            "a.vdag: has no material ids: voxdag build --material-ids stores them");
}

}  // namespace
}  // namespace voxdag
