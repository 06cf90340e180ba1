#include "query/thickness.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "query/write_box.hpp"
#include "voxdag/algebra/query/local_thickness.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag::cli {
namespace {

/// Calls visit(place, thickness in voxels) for each place of `box`; x runs fastest. Places outside
/// of the field are 0.
template <class Visit>
void for_each_place(const LocalThickness& field, const Box3i& box, Work work, const Visit& visit) {
  const Vec3<std::size_t> size(field.box.hi - field.box.lo);
  for (std::int32_t z = box.lo.z; z < box.hi.z; ++z) {
    work.poll();
    for (std::int32_t y = box.lo.y; y < box.hi.y; ++y)
      for (std::int32_t x = box.lo.x; x < box.hi.x; ++x) {
        const Vec3i p = Vec3i{x, y, z} - field.box.lo;
        const bool is_in = p.x >= 0 && p.y >= 0 && p.z >= 0 && x < field.box.hi.x &&
                           y < field.box.hi.y && z < field.box.hi.z;
        const Vec3<std::size_t> at(p);
        visit(Vec3i{x, y, z}, is_in ? std::sqrt(static_cast<double>(
                                          field.squares[(at.z * size.y + at.y) * size.x + at.x]))
                                    : 0.0);
      }
  }
}

struct Summary {
  double least = HUGE_VAL, most = 0, sum = 0;  ///< In voxels.
  std::uint64_t voxels = 0, thinner = 0;
  std::vector<std::uint64_t> histogram;  ///< [k]: voxels of k to k + 1 voxels, without k + 1.
};

/// Measures all voxels. `limit` is in voxels. Calls thin(voxel) for those that are thinner.
template <class Thin>
Summary summary_of(const LocalThickness& field, double limit, Work work, const Thin& thin) {
  Summary result;
  for_each_place(field, field.box, work, [&](Vec3i voxel, double thickness) {
    if (thickness == 0) return;
    result.least = std::min(result.least, thickness);
    result.most = std::max(result.most, thickness);
    result.sum += thickness;
    ++result.voxels;
    const auto bin = static_cast<std::size_t>(thickness);
    if (bin >= result.histogram.size()) result.histogram.resize(bin + 1);
    ++result.histogram[bin];
    if (thickness >= limit) return;
    ++result.thinner;
    thin(voxel);
  });
  return result;
}

void write_thickness(const LocalThickness& field, const std::string& output, const Box3i& box,
                     const DagModel& file, Work work) {
  const Vec3<double> size(box.hi - box.lo);
  if (size.x * size.y * size.z > std::ldexp(1, 40))
    throw Error(output, "", "would have more than 2^40 places: give --window");
  const Vec3<std::uint64_t> places(box.hi - box.lo);
  const MemoryReservation held(work.memory, places.x * places.y * places.z * sizeof(float));
  std::vector<float> values;
  values.reserve(places.x * places.y * places.z);
  for_each_place(field, box, work, [&](Vec3i, double thickness) {
    values.push_back(static_cast<float>(thickness * file.grid().voxel_size));
  });
  write_box(output, file.grid(), box, values);
}

bool is_in(const Box3i& box, Vec3i voxel) {
  for (int axis = 0; axis < 3; ++axis)
    if (voxel[axis] < box.lo[axis] || voxel[axis] >= box.hi[axis]) return false;
  return true;
}

}  // namespace

void answer_thickness(const ThicknessArguments& arguments, const std::string& output,
                      const std::optional<Box3i>& window, const DagModel& file,
                      MemoryBudget& memory, Session& session) {
  const Work work{&memory, &session.progress};
  const std::string& unit = file.metadata().presentation.unit;
  const double side = file.grid().voxel_size;
  const double limit =
      arguments.thinner ? in_scene_unit(*arguments.thinner, unit, session.subject) : 0;
  const Box3i box = window.value_or(whole_grid(file.grid().levels));
  const LocalThickness field = local_thickness(file.view(), work);
  if (!output.empty() && !arguments.thinner) write_thickness(field, output, box, file, work);
  CountedVector<Vec3i> thin(work.memory);
  // A billionth is for the rounding of the quotient, so that 1.2 is not thinner than 12 times 0.1.
  const Summary found = summary_of(field, limit / side * (1 - 1e-9), work, [&](Vec3i voxel) {
    if (!output.empty() && is_in(box, voxel)) thin.push_back(voxel);
  });
  if (!output.empty() && arguments.thinner) {
    NpyWriter writer(output, "<i4", {3}, sizeof(std::int32_t), thin.size());
    writer.write_rows(thin.data(), thin.size());
    writer.commit();
  }
  const double count = static_cast<double>(std::max<std::uint64_t>(found.voxels, 1));
  const double least = found.voxels == 0 ? 0 : found.least * side, mean = found.sum / count * side;
  session.bar.clear();
  if (session.json) {
    nlohmann::ordered_json json = {{"voxels", found.voxels},      {"unit", unit}, {"least", least},
                                   {"most", found.most * side},   {"mean", mean}, {"bin", side},
                                   {"histogram", found.histogram}};
    if (arguments.thinner) json["limit"] = limit, json["thinner"] = found.thinner;
    fmt::print("{}", json_text(json));
    return;
  }
  if (session.quiet && !output.empty()) return;
  const std::string named_unit = unit.empty() ? "" : " " + unit;
  fmt::print("{}: {} voxels, {:.6g} to {:.6g}{} thick, mean {:.6g}{}\n",
             session.named(session.subject), with_commas(found.voxels), least, found.most * side,
             named_unit, mean, named_unit);
  if (arguments.thinner)
    fmt::print("  thinner than {:.6g}{}: {} voxels, {:.3g} %\n", limit, named_unit,
               with_commas(found.thinner), 100 * static_cast<double>(found.thinner) / count);
}

}  // namespace voxdag::cli
