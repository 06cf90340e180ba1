#include "voxdag/cluster/triangle_segments.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/builders/voxelize/cell_finder.hpp"
#include "voxdag/core/checked_size.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/polled_sort.hpp"
#include "voxdag/core/parallel/thread_count.hpp"

namespace voxdag {
namespace {

/// Triangles that one task maps to the grid.
constexpr std::size_t kBatch = 4096;

/// A triangle that meets a cell.
struct Entry {
  std::uint32_t code, triangle;
  friend bool operator<(const Entry& a, const Entry& b) {
    return a.code != b.code ? a.code < b.code : a.triangle < b.triangle;
  }
};

/// The triangles of one batch, with the cells that each meets.
struct Batch {
  std::vector<QuantizedTriangle> triangles;
  std::vector<double> voxels;  ///< Per triangle: estimated voxels in each cell that it meets.
  std::vector<Entry> entries;
};

/// Estimates the number of voxels that a triangle meets: area plus longest side plus one.
double voxels_of(const QuantizedTriangle& t) {
  const auto side = [&](int a, int b) {
    return static_cast<Vec3d>(t[b] - t[a]) * (1.0 / kSubvoxels);
  };
  const Vec3d ab = side(0, 1), ac = side(0, 2), bc = side(1, 2);
  const Vec3d normal = cross(ab, ac);
  const double longest = std::sqrt(std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)}));
  return std::sqrt(dot(normal, normal)) / 2 + longest + 1;
}

Batch map_batch(const SharedMesh& mesh, const Grid& grid, const CellFinder& finder,
                std::uint64_t first, std::uint64_t last) {
  Batch batch;
  std::vector<QuantizedTriangle> pieces;
  ArrayFiles<Vec3f>::Reader vertices(mesh.vertices());
  ArrayFiles<Triangle>::Reader triangles(mesh.triangles());
  for (std::uint64_t i = first; i < last; ++i) {
    const Triangle& t = triangles[i];
    pieces.clear();
    const Vec3<Vec3f> corners{vertices[t[0]], vertices[t[1]], vertices[t[2]]};
    if (!is_finite(corners.x) || !is_finite(corners.y) || !is_finite(corners.z)) continue;
    quantize_triangle(
        grid, {mesh.position(corners.x), mesh.position(corners.y), mesh.position(corners.z)},
        pieces);
    for (const QuantizedTriangle& piece : pieces) {
      const auto index = static_cast<std::uint32_t>(batch.triangles.size());
      const std::size_t before = batch.entries.size();
      finder.for_each(piece, [&](std::uint32_t code) { batch.entries.push_back({code, index}); });
      const auto cells = static_cast<double>(batch.entries.size() - before);
      batch.triangles.push_back(piece);
      batch.voxels.push_back(voxels_of(piece) / std::max(cells, 1.0));
    }
  }
  return batch;
}

/// Writes the triangles in the order of their first entries, the entries and the cells.
void write_sorted(WorkFileWriter& file, const PageVector<QuantizedTriangle>& triangles,
                  const PageVector<double>& voxels, PageVector<Entry>& entries, Work work) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  polled_sort(entries.begin(), entries.end(), work);
  PageVector<std::uint32_t> order(work.memory), place(work.memory);
  place.resize(triangles.size());
  std::fill(place.begin(), place.end(), kNone);
  for (const Entry& entry : entries) {
    if (place[entry.triangle] != kNone) continue;
    place[entry.triangle] = static_cast<std::uint32_t>(order.size());
    order.push_back(entry.triangle);
  }
  std::vector<SegmentCell> cells;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (cells.empty() || cells.back().code != entries[i].code)
      cells.push_back({entries[i].code, 0, i, 0});
    ++cells.back().triangles;
    cells.back().voxels += voxels[entries[i].triangle];
  }
  file.write_value(SegmentHeader{order.size(), entries.size(), cells.size()});
  for (const std::uint32_t triangle : order) file.write_value(triangles[triangle]);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t end = i + 1 < cells.size() ? cells[i + 1].begin : entries.size();
    // Ascending places: take() then reads the triangles in their order in the file.
    std::vector<std::uint32_t> places;
    for (std::size_t e = cells[i].begin; e < end; ++e) places.push_back(place[entries[e].triangle]);
    std::sort(places.begin(), places.end());
    file.write_values<std::uint32_t>(places);
  }
  constexpr std::byte kZeros[8] = {};
  file.write({kZeros, checked_size((8 - file.size() % 8) % 8)});
  file.write_values<SegmentCell>(cells);
}

}  // namespace

int segment_cell_level(int levels) { return std::min(levels - kMinLevels, levels < 18 ? 6 : 7); }

std::string segment_name(std::uint64_t index) { return "triangles/" + std::to_string(index); }

std::uint64_t segment_triangles(const MemoryBudget& budget) {
  // A triangle, its voxels and its places, and about six entries.
  constexpr std::uint64_t kBytes = 36 + 8 + 8 + 6 * sizeof(Entry) * 2;
  return std::clamp<std::uint64_t>(budget.left() / 4 / kBytes, kBatch, std::uint64_t{1} << 21);
}

void write_segment(const WorkFolder& folder, std::uint64_t index, const SharedMesh& mesh,
                   const Grid& grid, std::uint64_t first, std::uint64_t last, Work work) {
  const CellFinder finder(grid.levels, segment_cell_level(grid.levels));
  PageVector<QuantizedTriangle> triangles(work.memory);
  PageVector<double> voxels(work.memory);
  PageVector<Entry> entries(work.memory);
  // A few batches at a time, which are then joined in order.
  const std::uint64_t step = 2 * kBatch * thread_count();
  for (std::uint64_t begin = first; begin < last; begin += step) {
    const std::uint64_t end = std::min(last, begin + step);
    std::vector<Batch> batches((end - begin + kBatch - 1) / kBatch);
    polled_for(batches.size(), 1, {}, "", [&](std::size_t i) {
      work.poll();
      const std::uint64_t at = begin + i * kBatch;
      batches[i] = map_batch(mesh, grid, finder, at, std::min(end, at + kBatch));
    });
    for (Batch& batch : batches) {
      const auto base = static_cast<std::uint32_t>(triangles.size());
      for (const QuantizedTriangle& t : batch.triangles) triangles.push_back(t);
      for (const double v : batch.voxels) voxels.push_back(v);
      for (const Entry& e : batch.entries) entries.push_back({e.code, e.triangle + base});
      batch = {};
    }
  }
  WorkFileWriter file = folder.create(segment_name(index));
  write_sorted(file, triangles, voxels, entries, work);
  file.commit();
}

TriangleSegment::TriangleSegment(WorkFile file) : file_(std::move(file)) {
  const std::byte* at = file_.bytes().data();
  const auto& header = *reinterpret_cast<const SegmentHeader*>(at);
  at += sizeof header;
  triangles_ = {reinterpret_cast<const QuantizedTriangle*>(at), checked_size(header.triangles)};
  at += triangles_.size_bytes();
  entries_ = {reinterpret_cast<const std::uint32_t*>(at), checked_size(header.entries)};
  at = file_.bytes().data() + file_.bytes().size() - header.cells * sizeof(SegmentCell);
  cells_ = {reinterpret_cast<const SegmentCell*>(at), checked_size(header.cells)};
}

std::span<const SegmentCell> TriangleSegment::cells_in(const CellRange& range, int level) const {
  const auto code_less = [](const SegmentCell& cell, std::uint32_t code) {
    return cell.code < code;
  };
  // The cells that contain those of the range.
  const int down = 3 * (range.level - level);
  const std::uint32_t first = range.first >> down, last = ((range.last - 1) >> down) + 1;
  const auto begin = std::lower_bound(cells_.begin(), cells_.end(), first, code_less);
  return {begin, std::lower_bound(begin, cells_.end(), last, code_less)};
}

std::uint64_t TriangleSegment::entries_in(const CellRange& range, int level) const {
  std::uint64_t sum = 0;
  for (const SegmentCell& cell : cells_in(range, level)) sum += cell.triangles;
  return sum;
}

TriangleSegment::Taken TriangleSegment::take(const CellRange& range, int level, std::uint64_t skip,
                                             std::uint64_t most,
                                             CountedVector<QuantizedTriangle>& triangles,
                                             MemoryBudget* budget) const {
  const auto cells = cells_in(range, level);
  CountedVector<std::uint32_t> met{CountedAllocator<std::uint32_t>(budget)};
  std::uint64_t count = 0;
  for (const SegmentCell& cell : cells) count += cell.triangles;
  met.reserve(count);
  for (const SegmentCell& cell : cells)
    met.insert(met.end(), entries_.begin() + static_cast<std::ptrdiff_t>(cell.begin),
               entries_.begin() + static_cast<std::ptrdiff_t>(cell.begin + cell.triangles));
  if (cells.size() > 1) {
    std::sort(met.begin(), met.end());
    met.erase(std::unique(met.begin(), met.end()), met.end());
  }
  Taken taken{std::min<std::uint64_t>(skip, met.size()), true};
  for (; taken.passed < met.size() && triangles.size() < most; ++taken.passed)
    triangles.push_back(triangles_[met[taken.passed]]);
  taken.is_all = taken.passed == met.size();
  file_.release(file_.bytes().size());
  return taken;
}

}  // namespace voxdag
