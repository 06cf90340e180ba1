#include "query/contacts.hpp"

#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "query/answer_rows.hpp"
#include "voxdag/algebra/contact/contacts.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/quaternion.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::cli {
namespace {

Vec3d vec3(const double* row, std::size_t first) {
  return {row[first], row[first + 1], row[first + 2]};
}

/// Returns the point, sphere or capsule of the first `columns` numbers, 3, 4 or 7.
Capsule capsule_of(const double* row, std::size_t columns) {
  if (columns == 7) return {vec3(row, 0), vec3(row, 3), row[6]};
  return Capsule::sphere(vec3(row, 0), columns == 4 ? row[3] : 0);
}

OrientedBox box_of(const double* row) {
  const auto axes = turned_axes(row[6], row[7], row[8], row[9]);
  return {vec3(row, 0), vec3(row, 3), {axes[0], axes[1], axes[2]}};
}

/// Returns the number of columns of an array. Throws Error unless it is one of `allowed`.
std::size_t columns_of(const std::string& path, const std::vector<std::uint64_t>& allowed,
                       const char* in_words) {
  const std::vector<std::uint64_t> shape = read_npy_start(path).header.shape;
  for (const std::uint64_t columns : allowed)
    if (shape.size() == 2 && shape[1] == columns) return static_cast<std::size_t>(columns);
  throw Error(
      path, "",
      std::string("the array must have the shape (N, columns), with ") + in_words + " columns");
}

/// The questions of a file, and where the answers go.
struct Rows {
  const std::string& input;
  const std::string& output;
  std::size_t columns;
  Session& session;

  /// Answers all rows with answer(rows as shapes, answers, work), and stores each answer with
  /// store(answer, row). shape(row) makes a shape. Errors name the file.
  template <class Answer, class Shape, class Ask, class Store>
  std::uint64_t answer(const std::string& dtype, std::size_t bytes, const Shape& shape,
                       const Ask& ask, const Store& store) const {
    std::uint64_t first = 0;
    using ShapeType = decltype(shape(static_cast<const double*>(nullptr)));
    std::vector<ShapeType> shapes;
    return answer_rows(
        input, columns, output, dtype, bytes, session,
        [&](const std::vector<double>& values, std::size_t count, std::vector<std::byte>& rows) {
          const auto answers = std::make_unique<Answer[]>(count);
          try {
            shapes.clear();
            for (std::size_t i = 0; i < count; ++i)
              shapes.push_back(shape(values.data() + columns * i));
            ask(std::span<const ShapeType>(shapes), values, std::span<Answer>(answers.get(), count),
                Work(&session.progress));
          } catch (const Cancelled&) {
            throw;
          } catch (const Error& error) {
            // Shapes that cannot be made have no number yet.
            const Error named = error.place().empty()
                                    ? error.within(fmt::format("shape {}", shapes.size()))
                                    : error;
            if (first == 0) throw named.in_file(input);
            throw named.within(fmt::format("rows from {} on", first)).in_file(input);
          }
          for (std::size_t i = 0; i < count; ++i) store(answers[i], rows.data() + bytes * i);
          first += count;
        });
  }
};

std::string answer_overlaps(const Rows& rows, const ContactScene& scene) {
  std::uint64_t touched = 0, count = 0;
  const auto run = [&](const auto& shape) {
    count = rows.answer<bool>(
        "|b1", 1, shape,
        [&](auto shapes, const auto&, std::span<bool> results, Work work) {
          overlaps(scene, shapes, results, work);
        },
        [&](bool is_touched, std::byte* row) {
          touched += is_touched ? 1 : 0;
          store_value(row, is_touched);
        });
  };
  if (rows.columns == 10)
    run(box_of);
  else
    run([&](const double* row) { return capsule_of(row, rows.columns); });
  return fmt::format("{} shapes, {} touch voxels", with_commas(count), with_commas(touched));
}

std::string answer_sweeps(const Rows& rows, const ContactScene& scene) {
  std::uint64_t hits = 0;
  std::vector<Vec3d> motions;
  const std::uint64_t count = rows.answer<SweepHit>(
      "[('hit', '|b1'), ('t', '<f8'), ('voxel', '<i4', (3,)), ('point', '<f8', (3,)), ('normal', "
      "'<f8', (3,))]",
      69, [&](const double* row) { return capsule_of(row, rows.columns - 3); },
      [&](std::span<const Capsule> shapes, const std::vector<double>& values,
          std::span<SweepHit> results, Work work) {
        motions.clear();
        for (std::size_t i = 0; i < shapes.size(); ++i)
          motions.push_back(vec3(values.data() + rows.columns * i, rows.columns - 3));
        sweep(scene, shapes, motions, results, work);
      },
      [&](const SweepHit& hit, std::byte* row) {
        hits += hit.hit ? 1 : 0;
        row = store_value(row, hit.hit);
        row = store_value(row, hit.t);
        row = store_value(row, hit.voxel);
        row = store_value(row, hit.point);
        store_value(row, hit.normal);
      });
  return fmt::format("{} motions, {} end at voxels", with_commas(count), with_commas(hits));
}

std::string answer_closest(const Rows& rows, const ContactScene& scene, double most) {
  std::uint64_t found = 0;
  const std::uint64_t count = rows.answer<ClosestVoxel>(
      "[('distance', '<f8'), ('voxel', '<i4', (3,)), ('point', '<f8', (3,)), ('normal', '<f8', "
      "(3,))]",
      68, [&](const double* row) { return capsule_of(row, rows.columns); },
      [&](std::span<const Capsule> shapes, const auto&, std::span<ClosestVoxel> results,
          Work work) { closest(scene, shapes, most, results, work); },
      [&](const ClosestVoxel& one, std::byte* row) {
        found += one.is_found ? 1 : 0;
        row = store_value(row, one.distance);
        row = store_value(row, one.voxel);
        row = store_value(row, one.point);
        store_value(row, one.normal);
      });
  return fmt::format("{} shapes, {} have a voxel in reach", with_commas(count), with_commas(found));
}

std::string answer_signed_distances(const Rows& rows, const ContactScene& scene, double most) {
  std::uint64_t inside = 0;
  const std::uint64_t count = rows.answer<SignedDistance>(
      "[('distance', '<f8'), ('gradient', '<f8', (3,))]", 32,
      [](const double* row) { return vec3(row, 0); },
      [&](std::span<const Vec3d> points, const auto&, std::span<SignedDistance> results,
          Work work) { signed_distance(scene, points, most, results, work); },
      [&](const SignedDistance& one, std::byte* row) {
        inside += one.distance < 0 ? 1 : 0;
        store_value(store_value(row, one.distance), one.gradient);
      });
  return fmt::format("{} points, {} in voxels", with_commas(count), with_commas(inside));
}

}  // namespace

void add_contact_options(const Command& command, ContactArguments& arguments,
                         const std::function<Option(Option)>& add) {
  add(command.text("--overlap", arguments.overlap, "S.npy",
                   "For each sphere (x, y, z, radius), capsule (both ends, radius) or box (centre, "
                   "half sides, quaternion): whether it touches a voxel. N x 4, 7 or 10 float32 or "
                   "float64"));
  add(command.text("--sweep", arguments.sweep, "S.npy",
                   "For each sphere or capsule, and its motion (N x 7 or 10): where it first "
                   "touches a voxel"));
  add(command.text("--closest", arguments.closest, "S.npy",
                   "For each point, sphere or capsule (N x 3, 4 or 7): the nearest voxel, its "
                   "distance and its nearest point"));
  add(command.text("--signed-distances", arguments.signed_distances, "P.npy",
                   "For each point (N x 3): the distance to the surface, negative in voxels, and "
                   "its gradient"));
  command
      .parsed("--within", arguments.within, parse_length, "LENGTH",
              "With --closest and --signed-distances: look no farther than this")
      .only_if(
          [&arguments] {
            return !arguments.closest.empty() || !arguments.signed_distances.empty();
          },
          "without --closest or --signed-distances");
}

std::string answer_contacts(const ContactArguments& arguments, const std::string& output,
                            const DagModel& file, Session& session) {
  const ContactScene scene{file.view(), file.grid()};
  const double most =
      arguments.within
          ? in_scene_unit(*arguments.within, file.metadata().presentation.unit, session.subject)
          : HUGE_VAL;
  const auto rows = [&](std::initializer_list<std::uint64_t> allowed, const char* in_words) {
    return Rows{arguments.rows(), output, columns_of(arguments.rows(), allowed, in_words), session};
  };
  if (!arguments.overlap.empty()) return answer_overlaps(rows({4, 7, 10}, "4, 7 or 10"), scene);
  if (!arguments.sweep.empty()) return answer_sweeps(rows({7, 10}, "7 or 10"), scene);
  if (!arguments.closest.empty()) return answer_closest(rows({3, 4, 7}, "3, 4 or 7"), scene, most);
  return answer_signed_distances(rows({3}, "3"), scene, most);
}

}  // namespace voxdag::cli
