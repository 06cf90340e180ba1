#include "voxdag/file/model/seeded.hpp"

#include <optional>
#include <utility>

#include "voxdag/algebra/attributes/derive_attributes.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"

namespace voxdag {
namespace {

/// A source of derive_attributes() that gives one value to all cells.
struct OneValue {
  ValueKinds of_kinds;

  struct Cell {};
  struct Reader {
    CellValues values(Cell, Vec3i) const { return {{200, 200, 200}, {128, 255, 128}, 0}; }
  };
  Cell root() const { return {}; }
  Cell child(Cell, const NumberedCell&, Vec3i) const { return {}; }
  std::optional<StoredRun> run(Cell, const NumberedCell&) const { return {}; }
  Reader reader() const { return {}; }
  std::size_t stored_count() const { return 0; }
  StoredValues stored(std::size_t) const { return {}; }
  const ValueKinds& kinds() const { return of_kinds; }
};

}  // namespace

DagModel seeded(const DagModel& empty, Work work) {
  const int levels = empty.grid().levels;
  const AttributesMetadata& values = empty.metadata().attributes;
  const std::uint64_t codes[] = {0, (std::uint64_t{1} << 3 * levels) - 1};
  Svdag dag = svdag_of_sorted(levels, codes, work.memory);
  const OneValue source{
      {values.colors.has_value(), values.normals.has_value(),
       values.materials ? static_cast<std::uint32_t>(values.materials->size()) : 0}};
  const int finest = source.of_kinds.is_empty() ? 0 : values.level();
  DagAttributes attributes = derive_attributes(dag.view(), finest, source, {}, work);
  return {std::move(dag), std::move(attributes), empty.metadata(), work};
}

}  // namespace voxdag
