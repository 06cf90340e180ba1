#include "trace/hit_rows.hpp"

#include <cstring>
#include <limits>

#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag::cli {
namespace {

template <class T>
void append_value(std::byte*& row, const T& value) {
  std::memcpy(row, &value, sizeof value);
  row += sizeof value;
}

constexpr const char* kFields[] = {"t", "voxel", "face", "hit", "normal", "color", "material"};

}  // namespace

HitRows::HitRows(int levels, const LookView& look)
    : levels_(levels), look_(look), channels_(look.dag, kFields) {
  dtype_ = "[('t', '<f4'), ('voxel', '<i4', (3,)), ('face', '|i1'), ('hit', '|b1')";
  row_bytes_ = 18;
  normals_ = look.has_normals();
  colors_ = look.has_colors();
  if (normals_) {
    dtype_ += ", ('normal', '<f4', (3,))";
    row_bytes_ += sizeof(Vec3f);
  }
  if (colors_) {
    dtype_ += ", ('color', '|u1', (3,))";
    row_bytes_ += sizeof(Vec3<std::uint8_t>);
  }
  if (look.has_materials()) {
    dtype_ += ", ('material', '<u2')";
    row_bytes_ += sizeof(std::uint16_t);
  }
  dtype_ += channels_.dtype() + "]";
  row_bytes_ += channels_.bytes();
}

void HitRows::pack(std::span<const Hit> hits, std::byte* rows) const {
  constexpr std::size_t kGrain = 1024;
  parallel_for(hits.size(), kGrain,
               [&](std::size_t i) { pack_one(hits[i], rows + i * row_bytes_); });
}

void HitRows::pack_one(const Hit& hit, std::byte* row) const {
  append_value(row, hit.hit ? hit.t : std::numeric_limits<float>::infinity());
  append_value(row, hit.hit ? hit.voxel : Vec3i{-1, -1, -1});
  append_value(row, hit.hit ? hit.face : Face::kNone);
  append_value(row, hit.hit);
  if (look_.is_empty()) return;
  Vec3f normal{};
  Vec3<std::uint8_t> color{};
  const int shift = levels_ - hit.level;
  const Vec3i cell{hit.voxel.x >> shift, hit.voxel.y >> shift, hit.voxel.z >> shift};
  if (hit.hit) {
    const StoredLook look = look_at(look_, cell, hit.level);
    normal = look.normal;
    for (int c = 0; c < 3; ++c) color[c] = static_cast<std::uint8_t>(255 * look.color[c] + 0.5f);
  }
  if (normals_) append_value(row, normal);
  if (colors_) append_value(row, color);
  if (look_.has_materials())
    append_value(row, static_cast<std::uint16_t>(hit.hit ? material_at(look_.dag, cell, hit.level)
                                                         : kMaxMaterials));
  channels_.store(row, hit.hit, cell, hit.level);
}

}  // namespace voxdag::cli
