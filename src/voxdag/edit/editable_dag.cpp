#include "voxdag/edit/editable_dag.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <unordered_map>
#include <utility>

#include "voxdag/algebra/crop.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/edit/filter_ball.hpp"
#include "voxdag/edit/shape_edit.hpp"
#include "voxdag/edit/stamp_edit.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace {

/// Edits collect unused nodes and values when this many bytes were added since the last time.
constexpr std::uint64_t kCollectAtLeast = std::uint64_t{64} << 20;

/// Returns the middle of a shape, in voxels; of a half-space, a point on its side.
Vec3d middle_of(const EditShape& shape) {
  const auto voxels = [](Vec3d subvoxels) { return subvoxels * (1.0 / kSubvoxels); };
  if (const auto* ball = std::get_if<BallShape>(&shape)) return voxels(Vec3d(ball->center));
  if (const auto* capsule = std::get_if<CapsuleShape>(&shape))
    return voxels(Vec3d(capsule->a + capsule->b) * 0.5);
  const auto& slabs = std::get<SlabsShape>(shape);
  Vec3d middle{};
  for (int i = 0; i < slabs.count; ++i) {
    const SlabsShape::Slab& slab = slabs.slabs[i];
    const Vec3d axis = Vec3d(slab.axis) * (1.0 / SlabsShape::kAxisUnit);
    const double at = slabs.count == 1
                          ? static_cast<double>(slab.end)
                          : (static_cast<double>(slab.first) + static_cast<double>(slab.end)) / 2;
    middle = middle + axis * (at / SlabsShape::kAxisUnit);
  }
  return voxels(middle);
}

/// Returns the direction out of a shape, at a point in voxels.
Vec3f outward(const EditShape& shape, Vec3d point) {
  const Vec3d at = point * double{kSubvoxels};
  Vec3d direction{};
  if (const auto* ball = std::get_if<BallShape>(&shape)) {
    direction = at - Vec3d(ball->center);
  } else if (const auto* capsule = std::get_if<CapsuleShape>(&shape)) {
    const Vec3d a(capsule->a), along = Vec3d(capsule->b) - a;
    const double length2 = dot(along, along);
    const double t = length2 > 0 ? std::clamp(dot(at - a, along) / length2, 0.0, 1.0) : 0;
    direction = at - a - along * t;
  } else {
    double nearest = HUGE_VAL;
    const auto& slabs = std::get<SlabsShape>(shape);
    for (int i = 0; i < slabs.count; ++i) {
      const SlabsShape::Slab& slab = slabs.slabs[i];
      const Vec3d axis(slab.axis);
      const double here = dot(axis, at);
      if (const double off = std::abs(static_cast<double>(slab.end) - here); off < nearest)
        nearest = off, direction = axis;
      if (const double off = std::abs(here - static_cast<double>(slab.first)); off < nearest)
        nearest = off, direction = -axis;
    }
  }
  return Vec3f(normalized_or(direction, Vec3d{0, 1, 0}));
}

/// Returns the middle of a cell, in voxels.
Vec3d middle_of_cell(Vec3i cell, int level, int levels) {
  const double side = static_cast<double>(std::int64_t{1} << (levels - level));
  return (Vec3d(cell) + Vec3d{0.5, 0.5, 0.5}) * side;
}

}  // namespace

EditableDag::EditableDag(const ColoredDagView& base, EditOptions options, Work work)
    : work_(work),
      options_(options),
      attributes_(base.attributes),
      nodes_(std::make_shared<EditNodes>(base.dag, work)),
      values_(std::make_shared<EditValues>(work)),
      collect_at_(kCollectAtLeast) {
  if (options.tracks_changes) nodes_->track_changes(), values_->track_changes();
  Version version;
  version.root = options.starts_empty ? EditNodes::kNone : nodes_->base_root();
  push(std::move(version));
}

void EditableDag::check(const EditPaint& paint) const {
  if (paint.color && !attributes_.has_colors())
    throw Error("the DAG has no colours: build it with colours to paint it");
  if (!paint.material) return;
  if (!attributes_.has_materials()) throw Error("the DAG has no materials");
  if (*paint.material >= attributes_.materials.materials)
    throw Error("the DAG has no material " + std::to_string(*paint.material) + ": it has " +
                std::to_string(attributes_.materials.materials));
}

void EditableDag::add_shape(Version& version, const EditShape& shape, const EditPaint& paint) {
  std::visit([&](const auto& of) { version.root = ShapeEdit(*nodes_, of, true).run(version.root); },
             shape);
  paint_new(version, versions_[now_]->root, paint, &shape);
}

void EditableDag::paint_shape(Version& version, const EditShape& shape, const EditPaint& paint) {
  const auto run = [&](std::uint32_t& overlay, std::uint32_t value) {
    std::visit(
        [&](const auto& of) {
          overlay = ShapePaint(*nodes_, *values_, of, attributes_.index.finest_level, value)
                        .run(version.root, overlay);
        },
        shape);
  };
  if (paint.color) run(version.colors, overlay_value(*paint.color));
  if (paint.material) run(version.materials, overlay_material(*paint.material));
}

void EditableDag::add(const EditShape& shape, const EditPaint& paint) {
  check(paint);
  apply([&](Version& version) { add_shape(version, shape, paint); });
}

void EditableDag::remove(const EditShape& shape) {
  apply([&](Version& version) {
    std::visit(
        [&](const auto& of) { version.root = ShapeEdit(*nodes_, of, false).run(version.root); },
        shape);
  });
}

void EditableDag::paint(const EditShape& shape, const EditPaint& paint) {
  check(paint);
  apply([&](Version& version) { paint_shape(version, shape, paint); });
}

void EditableDag::replace(const EditShape& shape, const EditPaint& paint) {
  check(paint);
  apply([&](Version& version) {
    add_shape(version, shape, paint);
    paint_shape(version, shape, paint);
  });
}

void EditableDag::paint_new(Version& version, std::uint32_t before_root, const EditPaint& paint,
                            const EditShape* shape) {
  if (!has_values() || version.root == before_root) return;
  const Version& before = *versions_[now_];
  const int finest = attributes_.index.finest_level;
  LookReader reader(before.values);
  /// Returns what the voxel nearest to a point had before.
  const auto nearest = [&](Vec3d point) {
    const auto found = nearest_voxel(before.view, point);
    return found ? reader.read(found->voxel, levels()) : VoxelLook{{0, 1, 0}, {200, 200, 200}, 0};
  };
  const auto run = [&](std::uint32_t& overlay, const auto& value) {
    overlay =
        NewCellsPaint(*nodes_, *values_, finest, value).run(before_root, version.root, overlay);
  };
  /// Paints with what of(look) returns for the voxel that was nearest to the shape, or to each new
  /// cell of the finest level.
  const auto run_nearest = [&](std::uint32_t& overlay, const auto& of) {
    if (shape != nullptr) {
      const std::uint32_t value = of(nearest(middle_of(*shape)));
      run(overlay, [&](int, Vec3i) { return value; });
      return;
    }
    run(overlay, [&](int level, Vec3i cell) {
      return level < finest ? kStoredValue : of(nearest(middle_of_cell(cell, level, levels())));
    });
  };
  if (attributes_.has_colors()) {
    if (paint.color)
      run(version.colors, [&](int, Vec3i) { return overlay_value(*paint.color); });
    else
      run_nearest(version.colors, [](const VoxelLook& look) { return overlay_value(look.color); });
  }
  if (attributes_.has_materials()) {
    if (paint.material)
      run(version.materials, [&](int, Vec3i) { return overlay_material(*paint.material); });
    else
      run_nearest(version.materials,
                  [](const VoxelLook& look) { return overlay_material(look.material); });
  }
  if (!attributes_.has_normals()) return;
  if (shape == nullptr) {
    run_nearest(version.normals,
                [](const VoxelLook& look) { return overlay_value(pack_normal(look.normal)); });
    return;
  }
  // Cells inside the shape are not seen: each has one normal.
  run(version.normals, [&](int level, Vec3i cell) {
    const int bits = levels() - level;
    const Vec3i origin{cell.x << bits, cell.y << bits, cell.z << bits};
    const bool is_inside = std::visit([&](const auto& of) { return of.place(origin, bits); },
                                      *shape) == CellPlace::kInside;
    if (level < finest && !is_inside) return kStoredValue;
    return overlay_value(pack_normal(outward(*shape, middle_of_cell(cell, level, levels()))));
  });
}

std::uint32_t EditableDag::join_stamp(std::uint32_t root, const SvdagView& voxels, bool adds) {
  if (adds) nodes_->add_full();
  EditNodes::Writer writer(*nodes_);
  return StampEdit(writer, voxels, adds).run(root);
}

void EditableDag::stamp(const SvdagView& voxels, StampMode mode, const LookView& look,
                        const EditPaint& paint, const Box3i& box) {
  if (voxels.levels != levels())
    throw Error("the stamp's grid has " + std::to_string(voxels.levels) +
                " levels, and that of the DAG " + std::to_string(levels()));
  check(paint);
  apply([&](Version& version) {
    if (mode == StampMode::kReplace) {
      SlabsShape slabs;
      for (int axis = 0; axis < 3; ++axis) {
        SlabsShape::Slab& slab = slabs.slabs[slabs.count++];
        slab.axis[axis] = 1;
        slab.first = std::int64_t{box.lo[axis]} * kSubvoxels;
        slab.end = std::int64_t{box.hi[axis]} * kSubvoxels;
      }
      version.root = ShapeEdit(*nodes_, slabs, false).run(version.root);
    }
    const std::uint32_t emptied = version.root;
    version.root = join_stamp(version.root, voxels, mode != StampMode::kRemove);
    if (mode == StampMode::kRemove) return;
    if (look.is_empty()) return paint_new(version, emptied, paint, nullptr);
    LookReader reader(look);
    paint_stamp(version, emptied, reader, [](Vec3i cell) { return cell; });
  });
}

template <class Place>
void EditableDag::paint_stamp(Version& version, std::uint32_t before, LookReader& reader,
                              const Place& source) {
  const int finest = attributes_.index.finest_level;
  const auto run = [&](std::uint32_t& overlay, const auto& of) {
    const auto value = [&](int level, Vec3i cell) {
      return level < finest ? kStoredValue : of(reader.read(source(cell), level));
    };
    overlay = NewCellsPaint(*nodes_, *values_, finest, value).run(before, version.root, overlay);
  };
  if (attributes_.has_colors() && reader.has_colors())
    run(version.colors, [](const VoxelLook& of) { return overlay_value(of.color); });
  if (attributes_.has_normals() && reader.has_normals())
    run(version.normals, [](const VoxelLook& of) { return overlay_value(pack_normal(of.normal)); });
  if (attributes_.has_materials() && reader.has_materials())
    run(version.materials, [&](const VoxelLook& of) {
      if (of.material >= attributes_.materials.materials)
        throw Error("the stamp has a material that the DAG has not");
      return overlay_material(of.material);
    });
}

void EditableDag::copy(const Box3i& box, Vec3i to, bool moves) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(std::int64_t{to[axis]} - box.lo[axis]) > std::int64_t{1} << kMaxLevels)
      throw Error("a box cannot be copied by more than 2^20 voxels");
  const Vec3i offset = to - box.lo;
  apply([&](Version& version) {
    const EditSnapshot before = snapshot();
    const Svdag part = crop(before.view(), box, work_);
    if (moves) version.root = join_stamp(version.root, part.view(), false);
    const std::uint32_t emptied = version.root;
    const Svdag moved = shift(part.view(), offset, levels(), work_);
    version.root = join_stamp(version.root, moved.view(), true);
    if (!has_values()) return;
    // The voxel in the middle of a cell stands for the cell.
    const int bits = levels() - attributes_.index.finest_level;
    LookReader reader(before.values());
    paint_stamp(version, emptied, reader, [&](Vec3i cell) {
      for (int axis = 0; axis < 3; ++axis)
        cell[axis] = ((cell[axis] << bits) + (1 << bits) / 2 - offset[axis]) >> bits;
      return cell;
    });
  });
}

void EditableDag::filter(const BallShape& ball, BallFilter filter) {
  apply([&](Version& version) {
    const Svdag voxels = filter_ball(versions_[now_]->view, ball, filter, work_);
    version.root = ShapeEdit(*nodes_, ball, false).run(version.root);
    version.root = join_stamp(version.root, voxels.view(), true);
    paint_new(version, versions_[now_]->root, {}, nullptr);
  });
}

bool EditableDag::undo() {
  if (now_ == 0) return false;
  --now_;
  return true;
}

bool EditableDag::redo() {
  if (redo_count() == 0) return false;
  ++now_;
  return true;
}

void EditableDag::apply(const Change& change) {
  for (const bool is_last : {false, true}) {
    Version version = *versions_[now_];
    try {
      change(version);
      push(std::move(version));
      break;
    } catch (const OverMemory&) {
      if (is_last) throw;
      collect();
    }
  }
  if (drops_ > 0 && used_bytes() > collect_at_) collect();
}

void EditableDag::push(Version version) {
  version.nodes = nodes_;
  version.of_values = values_;
  version.view = nodes_->view(version.root);
  version.words_end = nodes_->words_end();
  version.values = {nodes_->base(),
                    attributes_,
                    {values_->view(version.colors), values_->view(version.normals),
                     values_->view(version.materials)}};
  const auto made = std::make_shared<const Version>(std::move(version));
  const std::size_t before = versions_.size();
  if (before > 0) versions_.resize(now_ + 1);
  versions_.push_back(made);
  if (options_.history != 0 && versions_.size() > options_.history + 1)
    versions_.erase(versions_.begin());
  drops_ += before + 1 - versions_.size();
  now_ = versions_.size() - 1;
  alive_.push_back(made);
}

std::uint64_t EditableDag::used_bytes() const {
  return nodes_->added_bytes() - nodes_->unused_bytes() + values_->bytes() -
         values_->unused_bytes();
}

void EditableDag::collect() {
  std::vector<std::uint32_t> roots, value_roots;
  std::erase_if(alive_, [&](const std::weak_ptr<const Version>& weak) {
    const auto version = weak.lock();
    if (version == nullptr) return true;
    roots.push_back(version->root);
    value_roots.insert(value_roots.end(), {version->colors, version->normals, version->materials});
    return false;
  });
  drops_ = 0;
  nodes_->collect(roots);
  values_->collect(value_roots);
  collect_at_ = std::max(kCollectAtLeast, 2 * used_bytes());
}

}  // namespace voxdag
