/// Tests `voxdag query` against the exported voxels.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "sponge.hpp"
#include "voxdag/algebra/contact/contacts.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/file/vdag_file.hpp"

namespace voxdag::cli {
namespace {

using Json = nlohmann::json;
using Voxel = std::array<int, 3>;

class Query : public Sponge {
 protected:
  static ProcessResult query(std::vector<std::string> options) {
    options.insert(options.begin(), {"query", path("in.vdag")});
    return run_voxdag(options);
  }
  static void write_rows(const std::string& name, std::uint64_t columns,
                         const std::vector<float>& values) {
    NpyWriter writer(path(name), "<f4", {columns}, sizeof(float), values.size() / columns);
    writer.write_rows(values.data(), values.size() / columns);
    writer.commit();
  }
  /// Returns the rows of an array, as bytes.
  static std::vector<std::string> rows_of(const std::string& name, const std::string& dtype,
                                          const std::vector<std::uint64_t>& shape,
                                          std::size_t item_bytes) {
    NpyReader reader(path(name), dtype, shape, item_bytes);
    std::vector<std::string> rows(reader.rows(), std::string(reader.row_bytes(), '\0'));
    for (std::string& row : rows) reader.read_rows(row.data(), 1);
    return rows;
  }
  template <class T>
  static T value_at(const std::string& row, std::size_t at) {
    T value;
    std::memcpy(&value, row.data() + at, sizeof value);
    return value;
  }
  static const std::set<Voxel>& voxels() {
    static const std::set<Voxel> all = [] {
      EXPECT_EQ(run_voxdag({"export", path("in.vdag"), "-o", path("all.npy"), "-q"}).status, 0);
      std::set<Voxel> set;
      for (const std::string& row : rows_of("all.npy", "<i4", {3}, 4))
        set.insert(value_at<Voxel>(row, 0));
      return set;
    }();
    return all;
  }
};

TEST_F(Query, PointsHaveTheirNearestVoxels) {
  const VdagFile file(path("in.vdag"));
  const Grid& grid = file.grid();
  std::mt19937 rng(4);
  std::uniform_real_distribution<double> at(-0.3, 1.3);
  std::vector<float> points;
  for (int i = 0; i < 3 * 200; ++i)
    points.push_back(static_cast<float>(grid.origin[i % 3] + at(rng) * grid.side()));
  write_rows("points.npy", 3, points);
  ASSERT_EQ(query({"--points", path("points.npy"), "-o", path("answers.npy")}).status, 0);
  {
    const std::vector<double> doubles(points.begin(), points.end());
    NpyWriter writer(path("doubles.npy"), "<f8", {3}, sizeof(double), points.size() / 3);
    writer.write_rows(doubles.data(), points.size() / 3);
    writer.commit();
  }
  ASSERT_EQ(query({"--points", path("doubles.npy"), "-o", path("same.npy")}).status, 0);
  EXPECT_EQ(read_text(path("same.npy")), read_text(path("answers.npy")));
  const auto rows = rows_of("answers.npy",
                            "[('occupied', '|b1'), ('voxel', '<i4', (3,)), ('nearest', '<i4', "
                            "(3,)), ('distance', '<f4')]",
                            {}, 29);
  ASSERT_EQ(rows.size(), 200u);
  int occupied = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Vec3d p;
    for (int axis = 0; axis < 3; ++axis)
      p[axis] = (static_cast<double>(points[3 * i + static_cast<std::size_t>(axis)]) -
                 grid.origin[axis]) *
                (1 / grid.voxel_size);
    double least = HUGE_VAL;
    for (const Voxel& v : voxels()) {
      double sum = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const double d = std::max({v[static_cast<std::size_t>(axis)] - p[axis],
                                   p[axis] - v[static_cast<std::size_t>(axis)] - 1, 0.0});
        sum += d * d;
      }
      least = std::min(least, sum);
    }
    const Voxel place = {static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                         static_cast<int>(std::floor(p.z))};
    EXPECT_EQ(value_at<Voxel>(rows[i], 1), place);
    EXPECT_EQ(value_at<bool>(rows[i], 0), voxels().count(place) != 0);
    EXPECT_EQ(voxels().count(value_at<Voxel>(rows[i], 13)), 1u);
    EXPECT_EQ(value_at<float>(rows[i], 25), static_cast<float>(std::sqrt(least) * grid.voxel_size));
    occupied += value_at<bool>(rows[i], 0) ? 1 : 0;
  }
  EXPECT_GT(occupied, 0);
}

TEST_F(Query, SegmentsAreThoseOfTrace) {
  const VdagFile file(path("in.vdag"));
  std::mt19937 rng(5);
  std::uniform_real_distribution<float> at(-0.2f, 1.2f);
  std::vector<float> segments, rays;
  for (int i = 0; i < 300; ++i) {
    float s[6];
    for (int k = 0; k < 6; ++k)
      s[k] = static_cast<float>(file.grid().origin[k % 3]) +
             at(rng) * static_cast<float>(file.grid().side());
    segments.insert(segments.end(), s, s + 6);
    rays.insert(rays.end(), {s[0], s[1], s[2], 0, s[3] - s[0], s[4] - s[1], s[5] - s[2], 1});
  }
  write_rows("segments.npy", 6, segments);
  write_rows("rays.npy", 8, rays);
  ASSERT_EQ(query({"--segments", path("segments.npy"), "-o", path("sight.npy")}).status, 0);
  ASSERT_EQ(
      run_voxdag({"trace", path("in.vdag"), "--rays", path("rays.npy"), "-o", path("hits.npy")})
          .status,
      0);
  const auto sight =
      rows_of("sight.npy", "[('clear', '|b1'), ('t', '<f4'), ('voxel', '<i4', (3,))]", {}, 17);
  const auto hits =
      rows_of("hits.npy", "[('t', '<f4'), ('voxel', '<i4', (3,)), ('face', '|i1'), ('hit', '|b1')]",
              {}, 18);
  int clear = 0;
  for (std::size_t i = 0; i < sight.size(); ++i) {
    const bool is_hit = value_at<bool>(hits[i], 17);
    EXPECT_EQ(value_at<bool>(sight[i], 0), !is_hit);
    clear += is_hit ? 0 : 1;
    if (!is_hit) continue;
    EXPECT_EQ(value_at<float>(sight[i], 1), value_at<float>(hits[i], 0));
    EXPECT_EQ(value_at<Voxel>(sight[i], 5), value_at<Voxel>(hits[i], 4));
  }
  EXPECT_GT(clear, 0);
  EXPECT_LT(clear, 300);
}

TEST_F(Query, CountsHeightsAndAreasAreThoseOfTheVoxels) {
  const ProcessResult all = query({"--count", "--json"});
  EXPECT_EQ(Json::parse(all.out).at("voxels"), voxels().size()) << all.err;
  const ProcessResult some = query({"--count", "--window", "3,-5,7,30,20,90", "--json"});
  std::uint64_t inside = 0, faces = 0;
  for (const Voxel& v : voxels()) {
    inside += v[0] >= 3 && v[0] < 30 && v[1] < 20 && v[2] >= 7 && v[2] < 90 ? 1 : 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Voxel beside = v;
        beside[axis] += step;
        faces += voxels().count(beside) == 0 ? 1 : 0;
      }
  }
  EXPECT_EQ(Json::parse(some.out).at("voxels"), inside) << some.err;
  const Json area = Json::parse(query({"--area", "--json"}).out);
  EXPECT_EQ(area.at("faces")[0].get<std::uint64_t>() + area.at("faces")[1].get<std::uint64_t>() +
                area.at("faces")[2].get<std::uint64_t>(),
            faces);
  const double side = VdagFile(path("in.vdag")).grid().voxel_size;
  EXPECT_NEAR(area.at("area").get<double>(), static_cast<double>(faces) * side * side, 1e-9);

  const auto resolution = static_cast<std::uint64_t>(VdagFile(path("in.vdag")).grid().resolution());
  for (const bool from_low : {false, true}) {
    std::vector<std::string> options = {"--heights", "y", "-o", path("heights.npy")};
    if (from_low) options.push_back("--from-low");
    ASSERT_EQ(query(options).status, 0);
    const auto rows = rows_of("heights.npy", "<i4", {resolution}, 4);
    for (std::uint64_t z = 0; z < resolution; ++z)
      for (std::uint64_t x = 0; x < resolution; ++x) {
        int height = -1;
        for (int y = 0; y < static_cast<int>(resolution); ++y)
          if (voxels().count({static_cast<int>(x), y, static_cast<int>(z)}) != 0 &&
              (height < 0 || !from_low))
            height = y;
        ASSERT_EQ(value_at<std::int32_t>(rows[z], 4 * x), height);
      }
  }
}

TEST_F(Query, DistancesHaveTheShapeOfTheWindow) {
  ASSERT_EQ(query({"--distances", "--window", "-2,0,1,7,3,5", "-o", path("field.npy")}).status, 0);
  const auto rows = rows_of("field.npy", "<f4", {3, 9}, 4);
  ASSERT_EQ(rows.size(), 4u);
  // A place has distance 0 exactly if it is a voxel.
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 9; ++x)
        EXPECT_EQ(value_at<float>(rows[static_cast<std::size_t>(z)],
                                  4 * static_cast<std::size_t>(9 * y + x)) == 0,
                  voxels().count({x - 2, y, z + 1}) != 0);
}

TEST_F(Query, SignedDistancesOfTheGridAreNegativeInVoxels) {
  ASSERT_EQ(query({"--distances", "--signed", "-o", path("field.npy")}).status, 0);
  const auto side = static_cast<std::size_t>(std::cbrt(
      static_cast<double>(std::filesystem::file_size(path("field.npy")) / sizeof(float))));
  const auto rows = rows_of("field.npy", "<f4", {side, side}, 4);
  for (std::size_t z = 0; z < side; ++z)
    for (std::size_t y = 0; y < side; ++y)
      for (std::size_t x = 0; x < side; ++x)
        EXPECT_EQ(
            value_at<float>(rows[z], 4 * (side * y + x)) < 0,
            voxels().count({static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)}) != 0);
}

TEST_F(Query, ContactsAreThoseOfTheLibrary) {
  const VdagFile file(path("in.vdag"));
  const ContactScene scene{file.view(), file.grid()};
  std::mt19937 rng(6);
  std::uniform_real_distribution<float> part(-0.2f, 1.2f);
  const auto side = static_cast<float>(file.grid().side());
  std::vector<float> spheres, moves, capsules, points, boxes;
  constexpr std::size_t kCount = 200;
  for (std::size_t i = 0; i < kCount; ++i) {
    float p[6];
    for (int k = 0; k < 6; ++k)
      p[k] = static_cast<float>(file.grid().origin[k % 3]) + part(rng) * side;
    const float radius = part(rng) < 0.5f ? 0 : 0.05f * side;
    spheres.insert(spheres.end(), {p[0], p[1], p[2], radius});
    moves.insert(moves.end(), {p[0], p[1], p[2], radius, p[3] - p[0], p[4] - p[1], p[5] - p[2]});
    capsules.insert(capsules.end(), {p[0], p[1], p[2], p[3], p[4], p[5], radius});
    points.insert(points.end(), {p[0], p[1], p[2]});
    boxes.insert(boxes.end(), {p[0], p[1], p[2], 0.1f * side, 0.05f * side, radius, 0, 0, 3, 4});
  }
  write_rows("spheres.npy", 4, spheres);
  write_rows("moves.npy", 7, moves);
  write_rows("capsules.npy", 7, capsules);
  write_rows("places.npy", 3, points);
  write_rows("boxes.npy", 10, boxes);
  const auto ask = [](const char* kind, const char* rows, const char* dtype, std::size_t bytes) {
    EXPECT_EQ(query({kind, path(rows), "-o", path("contacts.npy")}).status, 0) << kind;
    return rows_of("contacts.npy", dtype, {}, bytes);
  };
  const auto vec = [](const std::vector<float>& from, std::size_t at) {
    return static_cast<Vec3d>(Vec3f{from[at], from[at + 1], from[at + 2]});
  };
  const auto touches = ask("--overlap", "spheres.npy", "|b1", 1);
  const auto capsule_touches = ask("--overlap", "capsules.npy", "|b1", 1);
  const auto box_touches = ask("--overlap", "boxes.npy", "|b1", 1);
  const auto hits = ask("--sweep", "moves.npy",
                        "[('hit', '|b1'), ('t', '<f8'), ('voxel', '<i4', (3,)), ('point', '<f8', "
                        "(3,)), ('normal', '<f8', (3,))]",
                        69);
  const auto near = ask("--closest", "capsules.npy",
                        "[('distance', '<f8'), ('voxel', '<i4', (3,)), ('point', '<f8', (3,)), "
                        "('normal', '<f8', (3,))]",
                        68);
  const auto distances = ask("--signed-distances", "places.npy",
                             "[('distance', '<f8'), ('gradient', '<f8', (3,))]", 32);
  ASSERT_EQ(distances.size(), kCount);
  int touched = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Vec3d p = vec(points, 3 * i);
    const Capsule sphere = Capsule::sphere(p, static_cast<double>(spheres[4 * i + 3]));
    const Capsule capsule{p, vec(capsules, 7 * i + 3), sphere.radius};
    OrientedBox box{p, vec(boxes, 10 * i + 3)};
    box.axes[0] = {0.28, 0.96, 0};  // Turned by the quaternion (0, 0, 3, 4).
    box.axes[1] = {-0.96, 0.28, 0};
    EXPECT_EQ(value_at<bool>(touches[i], 0), overlaps(scene, sphere));
    EXPECT_EQ(value_at<bool>(capsule_touches[i], 0), overlaps(scene, capsule));
    EXPECT_EQ(value_at<bool>(box_touches[i], 0), overlaps(scene, box));
    touched += value_at<bool>(box_touches[i], 0) ? 1 : 0;
    const SweepHit hit = sweep(scene, sphere, vec(moves, 7 * i + 4));
    EXPECT_EQ(value_at<bool>(hits[i], 0), hit.hit);
    EXPECT_EQ(value_at<double>(hits[i], 1), hit.t);
    EXPECT_EQ(value_at<Vec3i>(hits[i], 9), hit.voxel);
    EXPECT_EQ(value_at<Vec3d>(hits[i], 21), hit.point);
    EXPECT_EQ(value_at<Vec3d>(hits[i], 45), hit.normal);
    const ClosestVoxel one = closest(scene, capsule);
    EXPECT_EQ(value_at<double>(near[i], 0), one.distance);
    EXPECT_EQ(value_at<Vec3i>(near[i], 8), one.voxel);
    EXPECT_EQ(value_at<Vec3d>(near[i], 44), one.normal);
    const SignedDistance distance = signed_distance(scene, p);
    EXPECT_EQ(value_at<double>(distances[i], 0), distance.distance);
    EXPECT_EQ(value_at<Vec3d>(distances[i], 8), distance.gradient);
  }
  EXPECT_GT(touched, 0);
  ASSERT_EQ(
      query({"--closest", path("places.npy"), "--within", "1e-3", "-o", path("few.npy")}).status,
      0);

  spheres[4 * 7 + 3] = -1;
  write_rows("bad.npy", 4, spheres);
  expect_failure(query({"--overlap", path("bad.npy"), "-o", path("out.npy")}), 1,
                 "bad.npy: shape 7: the radius is negative");
  boxes[10 * 3 + 8] = boxes[10 * 3 + 9] = 0;
  write_rows("bad.npy", 10, boxes);
  expect_failure(query({"--overlap", path("bad.npy"), "-o", path("out.npy")}), 1,
                 "bad.npy: shape 3: the quaternion of the turn has no length");
  expect_failure(query({"--sweep", path("spheres.npy"), "-o", path("out.npy")}), 1,
                 "with 7 or 10 columns");
  expect_failure(query({"--overlap", path("spheres.npy"), "--within", "1", "-o", path("out.npy")}),
                 2, "--within");
  EXPECT_EQ(files_like("out"), 0);
}

TEST_F(Query, WrongQuestionsAreRefused) {
  expect_failure(query({}), 2, "one of --points");
  expect_failure(query({"--points", path("none.npy")}), 2, "--output");
  expect_failure(query({"--points", path("none.npy"), "-o", path("out.npy")}), 1, "none.npy");
  expect_failure(query({"--count", "-o", path("out.npy")}), 2, "the answer is printed");
  expect_failure(query({"--count", "--signed"}), 2, "--signed");
  expect_failure(query({"--count", "--area"}), 2, "");
  expect_failure(query({"--area", "--window", "0,0,0,1,1,1"}), 2, "--window");
  expect_failure(query({"--heights", "w", "-o", path("out.npy")}), 2, "must be x, y or z");
  expect_failure(query({"--count", "--from-low"}), 2, "--from-low");
  expect_failure(query({"--distances", "--memory", "100M", "--window", "0,0,0,1000000,1000000,1000",
                        "-o", path("out.npy")}),
                 1, "");
  EXPECT_EQ(files_like("out"), 0);
}

}  // namespace
}  // namespace voxdag::cli
