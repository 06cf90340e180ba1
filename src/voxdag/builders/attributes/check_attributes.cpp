#include "voxdag/builders/attributes/check_attributes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/attributes/cell_filter.hpp"
#include "voxdag/builders/attributes/material_cells.hpp"
#include "voxdag/builders/pieces/duplicate_surfaces.hpp"
#include "voxdag/builders/pieces/split_triangles.hpp"
#include "voxdag/core/angles.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/cell_index_lookup.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kMaxSubtree = 1 << 16;  ///< Cells in the subtree of a cell to compare.
constexpr std::uint64_t kCellSamplesAtOnce = 1 << 18;  ///< Samples.

/// Returns the error of a colour, 0 to 1.
double color_error(Value8 stored, const std::uint8_t (&exact)[3]) {
  double sum = 0, weights = 0;
  for (int c = 0; c < 3; ++c) {
    const double weight = kColorWeights[static_cast<std::size_t>(c)];
    const double apart = static_cast<double>(stored[c]) - static_cast<double>(exact[c]);
    sum += weight * apart * apart;
    weights += weight;
  }
  return std::sqrt(sum / weights) / 255;
}

double degrees_between(Vec3f a, Vec3f b) {
  const Vec3d apart = Vec3d(a) - Vec3d(b);
  const double chord = std::sqrt(dot(apart, apart));
  const double sine = std::min(chord / 2, 1.0);  // of half of the angle
  return 2 * arc_tangent(sine, std::sqrt(1 - sine * sine)) * 180 / std::numbers::pi;
}

/// Returns whether the normals agree enough that their mean is the stored direction, whatever
/// rounding does.
bool has_clear_normal(const SurfaceSum& sum) {
  return 4 * dot(sum.normal, sum.normal) > 1.01f * sum.length * sum.length;
}

/// The errors of one cell; negative: not compared.
struct CellErrors {
  double color = -1, normal = -1, material = -1, mirror = -1;
};

/// Compares cells. Each thread has its own.
class CellComparer {
 public:
  /// `cover` is the DAG of the mesh, whose cells `index` numbers. `source` has the triangles
  /// without those that repeat others, `all` has all.
  CellComparer(const ColoredDagView& colored, const SvdagView& cover, const CellIndexView& index,
               const TriangleSource& source, const TriangleSource& all,
               std::span<const std::uint32_t> materials, const SurfaceShading& shading)
      : dag_(colored.dag),
        attributes_(colored.attributes),
        mirrors_(metallic_roughness_of(colored.attributes.channels)),
        source_(source),
        filter_(cover, index, source, &shading, colored.attributes.has_normals(), nullptr),
        materials_(cover, index, all, materials, nullptr) {}

  /// Compares a cell of the cover, if the coloured DAG has it.
  CellErrors compare(const CellTask& task) {
    CellErrors errors;
    std::uint64_t number = 0;
    if (!find_cell_number(dag_, attributes_.index, task.place, task.cell.level, number))
      return errors;
    if (attributes_.has_colors() || attributes_.has_normals() || !mirrors_.is_empty()) {
      const SurfaceSum sum = filter_.filter(without_duplicates(task), values_);
      if (sum.area > 0 && attributes_.has_colors())
        errors.color = color_error(read_value(attributes_.colors, number), values_[0].color);
      if (sum.area > 0 && attributes_.has_normals() && has_clear_normal(sum))
        errors.normal = degrees_between(unpack_normal(read_value(attributes_.normals, number)),
                                        values_[0].normal);
      if (sum.area > 0 && !mirrors_.is_empty()) errors.mirror = mirror_error(number, values_[0]);
    }
    if (attributes_.has_materials()) {
      double stored = 0, largest = 0;
      for (const MaterialArea& of : materials_.filter(task, runs_)) {
        if (of.id == read_material(attributes_.materials, number)) stored = of.area;
        largest = std::max(largest, of.area);
      }
      if (largest > 0) errors.material = 1 - stored / largest;
    }
    return errors;
  }

 private:
  /// Returns the task without the triangles that repeat others, which colours do not count.
  CellTask without_duplicates(CellTask task) {
    if (source_.duplicates.empty()) return task;
    unique_.clear();
    for (const std::uint32_t triangle : task.triangles)
      if (!source_.is_duplicate(triangle)) unique_.push_back(triangle);
    task.triangles = unique_;
    return task;
  }

  double mirror_error(std::uint64_t number, const VoxelValue& exact) const {
    int most = 0;
    const auto compare = [&](const ByteChannelView& channel, int value) {
      if (!channel.is_empty())
        most = std::max(most, std::abs(static_cast<int>(channel.read(number)) - value));
    };
    compare(mirrors_.metallic, exact.metallic);
    compare(mirrors_.roughness, exact.roughness);
    return most / 255.0;
  }

  const SvdagView& dag_;
  const DagAttributesView& attributes_;
  const MetallicRoughnessView mirrors_;
  const TriangleSource& source_;
  std::vector<std::uint32_t> unique_;
  CellFilter filter_;
  MaterialFilter materials_;
  std::vector<VoxelValue> values_;
  std::vector<CellRun> runs_;
};

/// A cell on the way to sampled cells.
struct VisitedCell {
  NumberedCell cell;
  Vec3i place{};
  TriangleList triangles;
  std::span<const std::uint64_t> samples;  ///< Numbers of cells in its subtree, increasing.
};

void add(ValueCheck& check, double error, const VisitedCell& cell) {
  if (error < 0) return;
  ++check.cells;
  if (error <= check.largest_error) return;
  check.largest_error = error;
  check.worst = cell.place;
  check.worst_level = cell.cell.level;
}

/// Walks breadth first to the cells with these numbers, which increase, and compares them.
class SampleWalk {
 public:
  SampleWalk(const SvdagView& cover, const CellIndexView& index, const TriangleSource& source,
             PerThread<CellComparer>& comparers, Work work)
      : dag_(cover), index_(index), source_(source), comparers_(comparers), work_(work) {}

  void compare(std::span<const std::uint64_t> numbers, AttributeCheck& check) {
    std::vector<VisitedCell> cells(1);
    cells[0].triangles = triangles_of_grid(source_, nullptr);
    cells[0].samples = numbers;
    while (!cells.empty()) {
      std::vector<std::vector<VisitedCell>> below(cells.size());
      std::vector<CellErrors> errors(cells.size());
      polled_for(cells.size(), 1, work_, "attributes",
                 [&](std::size_t i) { errors[i] = visit(cells[i], below[i]); });
      for (std::size_t i = 0; i < cells.size(); ++i) {
        add(check.colors, errors[i].color, cells[i]);
        add(check.normals, errors[i].normal, cells[i]);
        add(check.materials, errors[i].material, cells[i]);
        add(check.metallic_roughness, errors[i].mirror, cells[i]);
      }
      cells.clear();
      for (std::vector<VisitedCell>& list : below)
        for (VisitedCell& cell : list) cells.push_back(std::move(cell));
    }
  }

 private:
  /// Compares the cell if it is a sample. Appends its children that have samples to `below`.
  CellErrors visit(VisitedCell& at, std::vector<VisitedCell>& below) {
    CellErrors errors;
    if (at.samples.front() == at.cell.number) {
      if (cells_in(dag_, index_, at.cell) <= kMaxSubtree)
        errors = comparers_.local().compare({at.cell, at.place, at.triangles});
      at.samples = at.samples.subspan(1);
    }
    if (at.samples.empty()) return errors;
    ChildTriangles lists = split_triangles(source_, at.cell.level, at.place, at.triangles, nullptr);
    for (int child = 0; child < 8; ++child) {
      if ((children_of(dag_, at.cell) >> child & 1u) == 0) continue;
      VisitedCell visited;
      visited.cell = child_of(dag_, index_, at.cell, child);
      const std::uint64_t end = visited.cell.number + cells_in(dag_, index_, visited.cell);
      const auto count = static_cast<std::size_t>(
          std::lower_bound(at.samples.begin(), at.samples.end(), end) - at.samples.begin());
      if (count == 0) continue;
      visited.samples = at.samples.first(count);
      at.samples = at.samples.subspan(count);
      visited.place = at.place * 2 + child_offset(child);
      visited.triangles = std::move(lists[static_cast<std::size_t>(child)]);
      below.push_back(std::move(visited));
    }
    return errors;
  }

  const SvdagView& dag_;
  const CellIndexView& index_;
  const TriangleSource& source_;
  PerThread<CellComparer>& comparers_;
  Work work_;
};

/// Returns the next samples of `left`, in increasing order: from `first` on if all cells are
/// samples.
std::vector<std::uint64_t> next_samples(std::uint64_t cells, std::uint64_t left, bool is_all,
                                        std::uint64_t first, std::mt19937_64& random) {
  std::vector<std::uint64_t> numbers(std::min(left, kCellSamplesAtOnce));
  if (is_all) {
    std::iota(numbers.begin(), numbers.end(), first);
    return numbers;
  }
  for (std::uint64_t& number : numbers) number = random() % cells;
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

}  // namespace

AttributeCheck check_attributes(const Mesh& mesh, const Grid& grid, const ColoredDagView& colored,
                                const SurfaceShading& shading, std::uint64_t samples,
                                std::uint64_t seed, Work work, const TriangleIds& ids,
                                const SvdagView* cover) {
  AttributeCheck check;
  const SvdagView& dag = cover != nullptr ? *cover : colored.dag;
  const std::span<const std::uint32_t> materials =
      ids.count > 0 ? ids.ids : std::span<const std::uint32_t>(mesh.triangle_materials);
  if (colored.is_empty() || dag.is_empty()) return check;
  const CellIndex cover_index =
      cover != nullptr ? build_cell_index(dag, colored.attributes.index.finest_level, work.memory)
                       : CellIndex();
  const MemoryReservation index_bytes(work.memory, cover_index.view().bytes());
  const CellIndexView index = cover != nullptr ? cover_index.view() : colored.attributes.index;
  const QuantizedMesh quantized(mesh, grid, work);
  const IndexSet duplicates = find_duplicate_surfaces(mesh, &shading.appearance(), work),
                 no_duplicates;
  const std::vector<std::uint8_t> no_open_edges(quantized.triangle_count());
  // Materials count all triangles; CellComparer leaves the repeated ones out for colours.
  const TriangleSource all{grid, quantized, no_open_edges, nullptr, no_duplicates};
  const TriangleSource source{grid, quantized, no_open_edges, nullptr, duplicates};
  PerThread<CellComparer> comparers(
      [&] { return CellComparer(colored, dag, index, source, all, materials, shading); });
  SampleWalk walk(dag, index, all, comparers, work);
  const std::uint64_t cells = index.cells;
  const bool is_all = samples >= cells;
  std::mt19937_64 random(seed);
  for (std::uint64_t done = 0, count = std::min(samples, cells); done < count;) {
    const std::vector<std::uint64_t> numbers =
        next_samples(cells, count - done, is_all, done, random);
    walk.compare(numbers, check);
    done += std::min(count - done, kCellSamplesAtOnce);
  }
  return check;
}

}  // namespace voxdag
