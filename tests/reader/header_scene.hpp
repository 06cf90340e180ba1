#pragma once
/// Opens files with include/voxdag.h, and compares its answers with those of the library.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "support/test_rays.hpp"
#include "support/vdag_bytes.hpp"
#include "voxdag.h"
#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_parse.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

/// A file that voxdag.h opened or refused. Its bytes begin at an odd address and end with their
/// memory, so that AddressSanitizer finds reads beyond them.
class HeaderScene {
 public:
  explicit HeaderScene(const std::string& bytes) : memory_(new char[bytes.size() + 1]) {
    std::memcpy(memory_.get() + 1, bytes.data(), bytes.size());
    const std::unique_ptr<char[]> scratch(new char[VOXDAG_SCRATCH_BYTES(bytes.size())]);
    const char* const error = voxdag_open(&scene_, memory_.get() + 1, bytes.size(), scratch.get(),
                                          VOXDAG_SCRATCH_BYTES(bytes.size()));
    error_ = error != nullptr ? error : "no error";
  }
  const voxdag_scene& scene() const { return scene_; }
  bool is_open() const { return error_ == "no error"; }
  const std::string& error() const { return error_; }

 private:
  std::unique_ptr<char[]> memory_;
  voxdag_scene scene_;
  std::string error_;
};

/// Returns the file with one of its chunks replaced, and offsets, sizes and checksums correct.
inline std::string with_chunk(const std::string& bytes, std::uint32_t id,
                              const std::string& content) {
  const auto count = peek<VdagHeader>(bytes, 0).chunk_count;
  std::string file = bytes.substr(0, vdag_align(entry_offset(count)));
  for (std::size_t i = 0; i < count; ++i) {
    auto entry = peek<VdagChunkEntry>(bytes, entry_offset(i));
    const std::string chunk = entry.id == id ? content : bytes.substr(entry.offset, entry.length);
    entry.offset = file.size();
    entry.length = chunk.size();
    poke(file, entry_offset(i), entry);
    file += chunk;
    file.resize(vdag_align(file.size()));
  }
  poke(file, offsetof(VdagHeader, file_bytes), std::uint64_t{file.size()});
  repair_checksums(file);
  return file;
}

inline std::string text_of(Vec3i v) {
  return std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z);
}

/// Returns the next voxel of a walk, or nothing.
inline bool next_voxel(voxdag_walk& walk, Vec3i& voxel) {
  std::int32_t xyz[3];
  if (voxdag_walk_next(&walk, xyz) == 0) return false;
  voxel = {xyz[0], xyz[1], xyz[2]};
  return true;
}

/// Casts a ray with the header. The result has the library's type.
inline Hit header_cast(const voxdag_scene& scene, const Ray& ray) {
  voxdag_ray in{{}, {}, ray.t_min, ray.t_max};
  for (int axis = 0; axis < 3; ++axis) {
    in.origin[axis] = static_cast<double>(ray.origin[axis]);
    in.direction[axis] = static_cast<double>(ray.direction[axis]);
  }
  voxdag_hit out;
  Hit hit;
  hit.hit = voxdag_cast(&scene, &in, &out) != 0;
  hit.t = out.t;
  hit.voxel = {out.voxel[0], out.voxel[1], out.voxel[2]};
  hit.face = static_cast<Face>(out.face);
  hit.level = static_cast<std::int8_t>(hit.hit ? scene.info.levels : 0);
  return hit;
}

inline bool have_equal_bits(float a, float b) { return bits_of_float(a) == bits_of_float(b); }

/// Returns how the header's answer for a cell differs from the library's; "" if it does not.
inline std::string cell_difference(const VdagContents& contents, const voxdag_scene& scene,
                                   Vec3i cell, int level) {
  const std::string place = " at level " + std::to_string(level) + ", cell " + text_of(cell);
  const std::int32_t xyz[3] = {cell.x, cell.y, cell.z};
  const bool is_set = svdag_contains(contents.view, cell, level);
  if ((voxdag_contains(&scene, level, xyz) != 0) != is_set) return "voxels" + place;
  const DagAttributesView& attributes = contents.attributes;
  std::uint64_t expected = 0, number = 0;
  const bool is_numbered = attributes.index.cells != 0 &&
                           find_cell_number(contents.view, attributes.index, cell, level, expected);
  if (attributes.index.finest_level < level && is_numbered) {
    const int finer = level - attributes.index.finest_level;
    find_cell_number(contents.view, attributes.index,
                     {cell.x >> finer, cell.y >> finer, cell.z >> finer},
                     attributes.index.finest_level, expected);
  }
  if ((voxdag_find_number(&scene, level, xyz, &number) != 0) != is_numbered)
    return "being numbered" + place;
  if (!is_numbered) return "";
  if (number != expected) return "number" + place;
  std::uint8_t color[3];
  if ((voxdag_color(&scene, number, color) != 0) != attributes.has_colors()) return "colours";
  if (attributes.has_colors() &&
      Value8{color[0], color[1], color[2]} != read_value(attributes.colors, number))
    return "colour" + place;
  float normal[3];
  if ((voxdag_normal(&scene, number, normal) != 0) != attributes.has_normals()) return "normals";
  if (attributes.has_normals()) {
    const Vec3f unpacked = unpack_normal(read_value(attributes.normals, number));
    for (int axis = 0; axis < 3; ++axis)
      if (!have_equal_bits(normal[axis], unpacked[axis])) return "normal" + place;
  }
  std::uint32_t material = 0;
  if ((voxdag_material(&scene, number, &material) != 0) != attributes.has_materials())
    return "materials";
  if (attributes.has_materials() && material != read_material(attributes.materials, number))
    return "material" + place;
  return "";
}

/// Returns how the header's hit differs from the library's scalar cast; "" if it does not.
inline std::string ray_difference(const VdagContents& contents, const voxdag_scene& scene,
                                  const Ray& ray) {
  const Hit expected = closest_hit(SvdagNodes(contents.view), contents.metadata.grid, ray);
  const Hit found = header_cast(scene, ray);
  if (found == expected && have_equal_bits(found.t, expected.t)) return "";
  return "hit: voxel " + text_of(found.voxel) + " instead of " + text_of(expected.voxel) +
         ", t = " + std::to_string(found.t) + " instead of " + std::to_string(expected.t);
}

/// Compares what the file says, its first `most` voxels, the cells around them at all levels, and
/// rays at them. Returns the first difference, or "".
inline std::string first_difference(const VdagContents& contents, const voxdag_scene& scene,
                                    std::size_t most, unsigned seed) {
  const Grid& grid = contents.metadata.grid;
  const voxdag_info& info = scene.info;
  if (info.levels != grid.levels || info.resolution != grid.resolution()) return "levels";
  for (int axis = 0; axis < 3; ++axis)
    if (std::memcmp(&info.origin[axis], &grid.origin[axis], sizeof(double)) != 0) return "origin";
  if (info.voxel_size != grid.voxel_size) return "voxel_size";
  if (info.voxels != contents.metadata.counts.voxels) return "counts.voxels";
  if (info.up != contents.metadata.presentation.up.value_or('\0')) return "up";
  if (info.dag_bytes != contents.view.bytes()) return "bytes of the DAG";
  if (info.materials != contents.attributes.materials.materials && info.has_materials != 0)
    return "number of materials";

  voxdag_walk walk;
  const std::int32_t lo[3] = {0, 0, 0};
  const std::int32_t hi[3] = {info.resolution, info.resolution, info.resolution};
  voxdag_walk_begin(&walk, &scene, lo, hi);
  std::size_t left = most;
  std::string difference;
  struct Enough {};
  std::vector<Vec3i> voxels;
  try {
    for_each_voxel(contents.view, whole_grid(grid.levels), [&](Vec3i voxel) {
      if (left-- == 0) throw Enough();
      Vec3i found;
      if (!next_voxel(walk, found) || found != voxel) difference = "walk at " + text_of(voxel);
      voxels.push_back(voxel);
      if (!difference.empty()) throw Enough();
    });
    Vec3i found;
    if (next_voxel(walk, found)) return "voxel after the last one";
  } catch (const Enough&) {
  }
  for (std::size_t i = 0; i < voxels.size() && difference.empty(); ++i)
    for (int shift = 0; shift <= grid.levels && difference.empty(); ++shift)
      for (const int aside : {0, 1}) {
        const Vec3i cell{(voxels[i].x >> shift) + aside, voxels[i].y >> shift,
                         voxels[i].z >> shift};
        if (difference.empty())
          difference = cell_difference(contents, scene, cell, grid.levels - shift);
      }
  if (!difference.empty() || !(grid.voxel_size > 1e-30 && grid.voxel_size < 1e30))
    return difference;  // beyond this, coordinates of rays are not floats
  TestRays rays(grid, seed);
  for (std::size_t i = 0; i < std::min<std::size_t>(most, 64) && difference.empty(); ++i)
    difference = ray_difference(
        contents, scene,
        rays.make(static_cast<RayKind>(i % static_cast<std::size_t>(RayKind::kCount))));
  return difference;
}

/// Returns the library's error, or "no error" and sets `contents`, which refers to `bytes`.
inline std::string library_error(const AlignedBytes& bytes, VdagContents& contents) {
  try {
    contents = parse_vdag(bytes.span());
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// Opens bytes with the library and with the header. Returns a text that says how they disagree, or
/// "". They may disagree where the header does not look: at members of META that voxdag_info does
/// not have, and at attributes in the wire form. It must refuse what it needs an allocation for.
inline std::string disagreement(const std::string& bytes, std::size_t most_voxels) {
  const AlignedBytes aligned(bytes);
  VdagContents contents;
  const std::string error = library_error(aligned, contents);
  const HeaderScene header(bytes);
  const bool is_valid = error == "no error";
  if (!header.is_open() && is_valid) return "only the header refuses: " + header.error();
  if (header.is_open() && !is_valid) {
    // Attributes in the wire form are checked after they are decoded, as COLR, NRML or MTID.
    const bool has_wire_form = header.scene().info.has_wire_form != 0;
    bool is_skipped = error.rfind("chunk META", 0) == 0;
    for (const char* chunk : {"WCOL", "WNRM", "WMTI", "COLR", "NRML", "MTID"})
      is_skipped |= has_wire_form && error.rfind(std::string("chunk ") + chunk, 0) == 0;
    return is_skipped ? "" : "only the library refuses: " + error;
  }
  if (!is_valid) {
    const voxdag_scene& scene = header.scene();
    const std::int32_t root[3] = {0, 0, 0};
    return scene.error_at <= bytes.size() && voxdag_contains(&scene, 0, root) == 0 ? "" : "scene";
  }
  if (header.scene().info.has_wire_form != 0) {
    const CellIndexView index = contents.attributes.index;
    contents.attributes = {};
    contents.attributes.index = index;
  }
  return first_difference(contents, header.scene(), most_voxels, 1);
}

}  // namespace voxdag
