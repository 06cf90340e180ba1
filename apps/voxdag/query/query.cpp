/// `voxdag query`: answers questions about the voxels of a DAG.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "cli/channel_columns.hpp"
#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/scene_input.hpp"
#include "cli/usage_error.hpp"
#include "query/answer_rows.hpp"
#include "query/contacts.hpp"
#include "query/thickness.hpp"
#include "query/write_box.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/algebra/query/containing_voxel.hpp"
#include "voxdag/algebra/query/distance_field.hpp"
#include "voxdag/algebra/query/height_map.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/algebra/query/surface_area.hpp"
#include "voxdag/algebra/query/voxel_moments.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/float_origin.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/cpu/trace_batch.hpp"
#include "voxdag/file/model/scene_model.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag::cli {
namespace {

struct QueryArguments {
  SceneInput input;
  std::string points, segments, output;
  ContactArguments contacts;
  bool count = false, distances = false, is_signed = false, area = false, from_low = false;
  std::optional<int> heights;  ///< Axis.
  std::optional<Box3i> window;
  ThicknessArguments thickness;
  std::uint64_t memory_limit = 0;
};

std::string answer_points(const QueryArguments& arguments, const DagModel& file, Session& session) {
  constexpr const char* kFields[] = {"occupied", "voxel", "nearest", "distance"};
  const SvdagView dag = file.view();
  const ChannelColumns channels({dag, file.attributes()}, kFields);
  const std::size_t row_bytes = 29 + channels.bytes();
  const Grid& grid = file.grid();
  const std::uint64_t points = answer_rows(
      arguments.points, 3, arguments.output,
      "[('occupied', '|b1'), ('voxel', '<i4', (3,)), ('nearest', '<i4', (3,)), "
      "('distance', '<f4')" +
          channels.dtype() + "]",
      row_bytes, session,
      [&](const std::vector<double>& values, std::size_t count, std::vector<std::byte>& rows) {
        constexpr std::size_t kChunk = 256;
        polled_for(
            (count + kChunk - 1) / kChunk, 1, &session.progress, "query", [&](std::size_t chunk) {
              for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) {
                const double* const p = values.data() + 3 * i;
                const Vec3d world{p[0], p[1], p[2]};
                const Vec3i voxel = containing_voxel(grid, world);
                const auto nearest =
                    nearest_voxel(dag, (world - grid.origin) * (1 / grid.voxel_size));
                const bool is_occupied = nearest && nearest->voxel == voxel;
                std::byte* row = rows.data() + row_bytes * i;
                row = store_value(row, is_occupied);
                row = store_value(row, voxel);
                row = store_value(row, nearest ? nearest->voxel : Vec3i{-1, -1, -1});
                row = store_value(row, nearest ? static_cast<float>(std::sqrt(nearest->distance2) *
                                                                    grid.voxel_size)
                                               : HUGE_VALF);
                channels.store(row, nearest.has_value(), nearest ? nearest->voxel : Vec3i{},
                               dag.levels);
              }
            });
      });
  return fmt::format("{} points", with_commas(points));
}

std::string answer_segments(const QueryArguments& arguments, const DagModel& file,
                            Session& session) {
  constexpr const char* kFields[] = {"clear", "t", "voxel"};
  const ChannelColumns channels({file.view(), file.attributes()}, kFields);
  const std::size_t row_bytes = 17 + channels.bytes();
  const CpuScene scene{VoxelSet(file.view())};
  Grid grid = file.grid();
  const Vec3d near = float_origin(grid.bounds());  // Rays are in float32.
  grid.origin = grid.origin - near;
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  std::uint64_t clear = 0;
  const std::uint64_t segments = answer_rows(
      arguments.segments, 6, arguments.output,
      "[('clear', '|b1'), ('t', '<f4'), ('voxel', '<i4', (3,))" + channels.dtype() + "]", row_bytes,
      session,
      [&](const std::vector<double>& values, std::size_t count, std::vector<std::byte>& rows) {
        rays.clear();
        hits.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
          const double* const s = values.data() + 6 * i;
          const auto from = static_cast<Vec3f>(Vec3d{s[0], s[1], s[2]} - near),
                     to = static_cast<Vec3f>(Vec3d{s[3], s[4], s[5]} - near);
          rays.push_back({from, 0, to - from, 1});
        }
        trace_batch(scene, grid, rays, hits);
        for (std::size_t i = 0; i < count; ++i) {
          const Hit& hit = hits[i];
          clear += hit.hit ? 0 : 1;
          std::byte* row = rows.data() + row_bytes * i;
          row = store_value(row, !hit.hit);
          row = store_value(row, hit.hit ? hit.t : 1.0f);
          row = store_value(row, hit.hit ? hit.voxel : Vec3i{-1, -1, -1});
          channels.store(row, hit.hit, hit.voxel, file.view().levels);
        }
      });
  return fmt::format("{} segments, {} clear", with_commas(segments), with_commas(clear));
}

std::string write_distances(const QueryArguments& arguments, const DagModel& file,
                            MemoryBudget& memory, Session& session) {
  const auto side = static_cast<std::int32_t>(file.grid().resolution());
  const Box3i box = arguments.window.value_or(Box3i{{0, 0, 0}, {side, side, side}});
  std::uint64_t places = 1, size[3];
  for (int axis = 0; axis < 3; ++axis) {
    size[axis] = static_cast<std::uint64_t>(std::int64_t{box.hi[axis]} - box.lo[axis]);
    if (places > (std::uint64_t{1} << 40) / size[axis])
      throw Error("", "",
                  arguments.window ? "--window has more than 2^40 places"
                                   : "the grid has more than 2^40 places: give --window");
    places *= size[axis];
  }
  const MemoryReservation field(&memory, places * sizeof(float));
  const Work work{&memory, &session.progress};
  std::vector<float> distances = arguments.is_signed ? signed_distance_field(file.view(), box, work)
                                                     : distance_field(file.view(), box, work);
  for (float& distance : distances)
    distance = static_cast<float>(static_cast<double>(distance) * file.grid().voxel_size);
  write_box(arguments.output, file.grid(), box, distances);
  return fmt::format("{} x {} x {} distances", size[0], size[1], size[2]);
}

std::string write_heights(const QueryArguments& arguments, const DagModel& file,
                          MemoryBudget& memory, Session& session) {
  const auto side = static_cast<std::uint64_t>(file.grid().resolution());
  const MemoryReservation map(&memory, side * side * (sizeof(std::int32_t) + 1));
  const std::vector<std::int32_t> heights =
      height_map(file.view(), *arguments.heights,
                 arguments.from_low ? HeightSide::kLow : HeightSide::kHigh, &session.progress);
  NpyWriter writer(arguments.output, "<i4", {side}, sizeof(std::int32_t), side);
  writer.write_rows(heights.data(), static_cast<std::size_t>(side));
  writer.commit();
  return fmt::format("{} x {} heights", side, side);
}

void print_count(const QueryArguments& arguments, const DagModel& file, MemoryBudget& memory,
                 Session& session) {
  std::uint64_t voxels = file.metadata().counts.voxels;
  if (arguments.window) {
    const Svdag part = crop(file.view(), *arguments.window, {&memory, &session.progress});
    voxels = part.view().is_empty() ? 0 : count_svdag(part.view()).voxels;
  } else {
    voxels = file.view().is_empty() ? 0 : count_svdag(file.view()).voxels;
  }
  session.bar.clear();
  if (session.json)
    fmt::print("{}", json_text(nlohmann::ordered_json{{"voxels", voxels}}));
  else
    fmt::print("{}: {} voxels\n", session.named(session.subject), with_commas(voxels));
}

void print_area(const DagModel& file, MemoryBudget& memory, Session& session) {
  const VoxelSurface surface = surface_of(file.view(), {&memory, &session.progress});
  const VoxelMoments moments = moments_of(file.view(), {&memory, &session.progress});
  const Vec3d centre = file.grid().to_world(moments.centre),
              lo = file.grid().to_world(Vec3d(moments.bounds.lo)),
              hi = file.grid().to_world(Vec3d(moments.bounds.hi));
  const double side = file.grid().voxel_size;
  const double volume = static_cast<double>(surface.voxels) * side * side * side,
               area = static_cast<double>(surface.all_faces()) * side * side;
  session.bar.clear();
  if (session.json) {
    const nlohmann::ordered_json json = {{"voxels", surface.voxels},
                                         {"volume", volume},
                                         {"faces", surface.faces},
                                         {"area", area},
                                         {"centre", {centre.x, centre.y, centre.z}},
                                         {"bounds", {lo.x, lo.y, lo.z, hi.x, hi.y, hi.z}}};
    fmt::print("{}", json_text(json));
  } else {
    fmt::print(
        "{}: {} voxels, volume {:.9g}; {} faces, area {:.9g}\n"
        "  centre of mass {:.9g}, {:.9g}, {:.9g}; bounds {:.9g}, {:.9g}, {:.9g} to {:.9g}, {:.9g}, "
        "{:.9g}\n",
        session.named(session.subject), with_commas(surface.voxels), volume,
        with_commas(surface.all_faces()), area, centre.x, centre.y, centre.z, lo.x, lo.y, lo.z,
        hi.x, hi.y, hi.z);
  }
}

void query(const QueryArguments& arguments, Session& session) {
  if (!arguments.output.empty()) check_writable(arguments.output);
  MemoryBudget memory = command_budget(arguments.memory_limit);
  const DagModel file(session.subject, {&memory, &session.progress});
  if (arguments.count) return print_count(arguments, file, memory, session);
  if (arguments.area) return print_area(file, memory, session);
  if (arguments.thickness.is_asked)
    return answer_thickness(arguments.thickness, arguments.output, arguments.window, file, memory,
                            session);
  const std::string done =
      !arguments.points.empty()     ? answer_points(arguments, file, session)
      : !arguments.segments.empty() ? answer_segments(arguments, file, session)
      : arguments.contacts.is_asked()
          ? answer_contacts(arguments.contacts, arguments.output, file, session)
      : arguments.distances ? write_distances(arguments, file, memory, session)
                            : write_heights(arguments, file, memory, session);
  session.bar.clear();
  if (!session.quiet) fmt::print("{}: {}\n", arguments.output, done);
}

void check_query_arguments(const QueryArguments& arguments, Session& session) {
  const bool writes = !arguments.points.empty() || !arguments.segments.empty() ||
                      arguments.contacts.is_asked() || arguments.distances || arguments.heights;
  if (!writes && !arguments.count && !arguments.area && !arguments.thickness.is_asked)
    throw UsageError(
        "one of --points, --segments, --overlap, --sweep, --closest, --signed-distances, "
        "--distances, --heights, --thickness, --count and --area is required");
  if (writes && arguments.output.empty()) throw UsageError("--output", "is required");
  if (!writes && !arguments.output.empty() && !arguments.thickness.is_asked)
    throw UsageError("--output", "has no effect: the answer is printed");
  session.inputs = {arguments.points, arguments.segments, arguments.contacts.rows()};
  check_distinct({{"--output", arguments.output}}, session);
}

}  // namespace

void add_query_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<QueryArguments>();
  const Command command =
      program.add("query", "Answer questions about the voxels of a DAG",
                  "voxdag query scene.vdag --points points.npy -o answers.npy\n"
                  "  voxdag query scene.vdag --segments segments.npy -o sight.npy\n"
                  "  voxdag query scene.vdag --sweep moves.npy -o contacts.npy\n"
                  "  voxdag query scene.vdag --heights y -o heights.npy\n"
                  "  voxdag query scene.vdag --count --window "
                  "0,0,0,4096,4096,4096\n"
                  "  voxdag query scene.vdag --area\n"
                  "  voxdag query part.stl --area -r 512\n"
                  "  voxdag query solid.vdag --thickness --thinner 1mm -o thin.npy\n\n"
                  "Each call answers one kind of question. All answers are exact. Distances are "
                  "computed in double precision; those of --points, --distances and --thickness "
                  "are rounded to float32.");
  add_scene_input(command, arguments->input, session, "The .vdag file, in either form");
  std::vector<Option> kinds;
  const auto add = [&kinds](Option option) {
    for (const Option& other : kinds) option.not_with(other);
    kinds.push_back(option);
    return option;
  };
  add(command.text(
      "--points", arguments->points, "P.npy",
      "For each point (N x 3 float32 or float64, world units): whether it is in a voxel, and the "
      "nearest voxel with its distance and the channels of the file"));
  add(command.text(
      "--segments", arguments->segments, "S.npy",
      "For each segment (N x 6 float32 or float64, from and to): whether it meets no voxel, and "
      "the first voxel that it meets, with the channels of the file"));
  add_contact_options(command, arguments->contacts, add);
  const Option distances = add(
      command.flag("--distances", arguments->distances,
                   "For each place of --window, or of the grid: the distance of its centre to the "
                   "nearest voxel"));
  const Option heights = add(command.parsed(
      "--heights", arguments->heights, parse_axis, "AXIS",
      "For each column along x, y or z: the coordinate of its highest voxel, -1 without voxels"));
  const Option thickness =
      add(command.flag("--thickness", arguments->thickness.is_asked,
                       "Measure the thickness at each voxel of a solid: the diameter of the "
                       "largest ball inside that "
                       "holds it. -o writes them; --window says of which places"));
  add(command.flag("--count", arguments->count, "Count the voxels, or those of --window"));
  add(command.flag(
      "--area", arguments->area,
      "Measure the volume of the voxels, the area of their surface, their centre of mass and their "
      "bounds"));
  command
      .flag("--signed", arguments->is_signed,
            "With --distances: negative in voxels, where it is the distance to the nearest empty "
            "place")
      .needs(distances);
  command.flag("--from-low", arguments->from_low, "With --heights: of its lowest voxel")
      .needs(heights);
  command
      .parsed("--thinner", arguments->thickness.thinner, parse_length, "LENGTH",
              "With --thickness: count the voxels that are thinner than this: 1mm, 0.1in, or a "
              "number in the unit of the coordinates. -o writes these voxels, as an array of int32 "
              "of shape (N, 3)")
      .needs(thickness);
  command
      .parsed("--window", arguments->window, parse_window, "X0,Y0,Z0,X1,Y1,Z1",
              "The first voxel, and one past the last on each axis")
      .only_if(
          [arguments = arguments.get()] {
            return arguments->distances || arguments->count ||
                   (arguments->thickness.is_asked && !arguments->output.empty());
          },
          "without --distances, --count, or --thickness with -o");
  command.text(
      "-o,--output", arguments->output, "OUT.npy",
      "The array to write; of --distances and --thickness also a volume: .nrrd, .mha, .mhd, "
      ".vti, .nii or .nii.gz");
  add_memory_option(command, arguments->memory_limit);
  add_json_option(command, session);
  add_threads_option(command, session);
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    check_query_arguments(*arguments, session);
    session.work = [arguments, &session] {
      work_on_scene(arguments->input, session, [&] { query(*arguments, session); });
    };
  });
}

}  // namespace voxdag::cli
