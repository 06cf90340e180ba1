#include "lab/contacts/bench_contacts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>

#include "lab/contacts/embree_closest.hpp"
#include "lab/runs/child.hpp"
#include "lab/runs/scratch_folder.hpp"
#include "voxdag/algebra/contact/contacts.hpp"
#include "voxdag/algebra/query/voxel_moments.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/model/dag_model.hpp"
#include "voxdag/file/npy.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag::lab {
namespace {

/// Shapes and motions in world units.
struct ContactQuestions {
  std::vector<Vec3d> near, far, motions;
  std::vector<Capsule> near_points, far_points, spheres, capsules;
  std::vector<OrientedBox> boxes;
};

ContactQuestions make_questions(const ContactScene& scene, const ContactsPlan& plan,
                                Progress& progress) {
  const double size = scene.grid.voxel_size, radius = plan.radius * size;
  const VoxelMoments moments = moments_of(scene.dag, &progress);
  std::mt19937 random(1);
  const auto number = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const auto in_box = [&](Vec3d lo, Vec3d hi) {
    return Vec3d{number(lo.x, hi.x), number(lo.y, hi.y), number(lo.z, hi.z)};
  };
  const Vec3d lo = scene.grid.to_world(static_cast<Vec3d>(moments.bounds.lo)),
              hi = scene.grid.to_world(static_cast<Vec3d>(moments.bounds.hi)), one{1, 1, 1};
  ContactQuestions made;
  for (std::uint32_t i = 0; i < plan.count; ++i) {
    made.far.push_back(in_box(lo, hi));
    made.far_points.push_back(Capsule::sphere(made.far.back(), 0));
  }
  std::vector<ClosestVoxel> surface(plan.count);
  closest(scene, made.far_points, HUGE_VAL, surface, &progress);
  for (std::uint32_t i = 0; i < plan.count; ++i) {
    const Vec3d p = surface[i].point + in_box(one * (-2 * radius), one * (2 * radius));
    made.near.push_back(p);
    made.near_points.push_back(Capsule::sphere(p, 0));
    made.spheres.push_back(Capsule::sphere(p, radius));
    made.capsules.push_back({p, p + in_box(one * (-3 * radius), one * (3 * radius)), radius});
    made.motions.push_back(in_box(one * (-8 * radius), one * (8 * radius)));
    OrientedBox box{p, one * radius};
    box.axes[0] = normalized_or(in_box(-one, one), {1, 0, 0});
    box.axes[1] = normalized_or(cross(box.axes[0], in_box(-one, one)), {0, 1, 0});
    box.axes[2] = cross(box.axes[0], box.axes[1]);
    made.boxes.push_back(box);
  }
  return made;
}

class ContactsBench {
 public:
  ContactsBench(const ContactsPlan& plan, ContactsRun& run, Progress& progress)
      : plan_(plan), run_(run), progress_(progress) {}

  /// Measures body(), whose answers are positive where is_positive(i).
  template <class Body, class IsPositive>
  ContactsRate& measure(const char* query, const char* program, const Body& body,
                        const IsPositive& is_positive) {
    double least = HUGE_VAL, least_cpu = HUGE_VAL;
    for (int i = 0; i <= plan_.repeats; ++i) {  // The first is a warm-up.
      progress_.throw_if_cancelled();
      const std::clock_t cpu = std::clock();
      const auto start = std::chrono::steady_clock::now();
      body();
      const std::chrono::duration<double, std::milli> took =
          std::chrono::steady_clock::now() - start;
      if (i == 0) continue;
      least = std::min(least, took.count());
      least_cpu =
          std::min(least_cpu, 1000.0 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
    }
    std::uint32_t positive = 0;
    for (std::uint32_t i = 0; i < plan_.count; ++i) positive += is_positive(i) ? 1 : 0;
    return run_.rates.emplace_back(
        ContactsRate{query, program, plan_.count / least, plan_.count / least_cpu,
                     static_cast<double>(positive) / static_cast<double>(plan_.count), 0});
  }

 private:
  const ContactsPlan& plan_;
  ContactsRun& run_;
  Progress& progress_;
};

double mean_difference(const std::vector<ClosestVoxel>& own, const std::vector<double>& other,
                       double voxel_size) {
  double sum = 0;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!own[i].is_found || other[i] == HUGE_VAL) continue;
    sum += std::fabs(own[i].distance - other[i]) / voxel_size;
    ++count;
  }
  return sum / std::max(count, 1u);
}

/// Lets rival_bullet sweep the spheres, and adds its rate.
void run_bullet(const ContactsPlan& plan, const ContactQuestions& asked,
                const std::vector<SweepHit>& own, double voxel_size, ContactsRun& run,
                Progress& progress) {
  const ScratchFolder folder;
  const auto sweeps = folder.path() / "sweeps.npy", times = folder.path() / "times.npy";
  {
    NpyWriter writer(sweeps, "<f8", {7}, sizeof(double), asked.spheres.size());
    for (std::size_t i = 0; i < asked.spheres.size(); ++i) {
      const Capsule& s = asked.spheres[i];
      const Vec3d m = asked.motions[i];
      const double row[7] = {s.from.x, s.from.y, s.from.z, s.radius, m.x, m.y, m.z};
      writer.write_rows(row, 1);
    }
    writer.commit();
  }
  const ChildResult child = run_child(
      {std::filesystem::absolute(plan.bullet), std::filesystem::absolute(plan.mesh), sweeps, times},
      folder.path(), 0, progress);
  if (child.status != 0) throw Error(plan.bullet, "", failure_of(child, 0));
  NpyReader reader(times, {1});
  std::vector<double> t(own.size());
  reader.read_rows(t.data(), t.size());
  const auto json = nlohmann::json::parse(child.out);
  ContactsRate rate{"sweep sphere",
                    "bullet",
                    json.at("per_ms").get<double>(),
                    json.at("per_cpu_ms").get<double>(),
                    0,
                    0};
  double sum = 0;
  std::uint32_t both = 0, hits = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    hits += t[i] < 1 ? 1 : 0;
    if (!own[i].hit || t[i] >= 1) continue;
    sum += std::fabs(own[i].t - t[i]) * length(asked.motions[i]) / voxel_size;
    ++both;
  }
  rate.positive = static_cast<double>(hits) / static_cast<double>(t.size());
  rate.difference_voxels = sum / std::max(both, 1u);
  run.rates.push_back(rate);
}

}  // namespace

ContactsRun bench_contacts(const ContactsPlan& plan, Progress& progress) {
  ContactsRun run;
  run.scene = std::filesystem::path(plan.scene).filename().string();
  const DagModel model(plan.scene, &progress);
  const ContactScene scene{model.view(), model.grid()};
  run.levels = scene.dag.levels;
  if (scene.dag.is_empty()) throw Error(plan.scene, "", "has no voxels");
  const double reach = 4 * plan.radius * scene.grid.voxel_size;
  const ContactQuestions asked = make_questions(scene, plan, progress);
  ContactsBench bench(plan, run, progress);

  const auto touched = std::make_unique<bool[]>(plan.count);
  const std::span<bool> touches(touched.get(), plan.count);
  const auto is_touched = [&](std::uint32_t i) { return touched[i]; };
  const auto overlap_of = [&](const char* name, const auto& shapes) {
    bench.measure(
        name, "voxdag", [&] { overlaps(scene, std::span(shapes), touches); }, is_touched);
  };
  overlap_of("overlap sphere", asked.spheres);
  overlap_of("overlap capsule", asked.capsules);
  overlap_of("overlap box", asked.boxes);
  std::vector<SweepHit> hits(plan.count);
  const auto sweep_of = [&](const char* name, const std::vector<Capsule>& shapes) {
    bench.measure(
        name, "voxdag", [&] { sweep(scene, shapes, asked.motions, hits); },
        [&](std::uint32_t i) { return hits[i].hit; });
  };
  sweep_of("sweep capsule", asked.capsules);
  sweep_of("sweep sphere", asked.spheres);
  std::vector<SignedDistance> distances(plan.count);
  bench.measure(
      "signed distance near", "voxdag",
      [&] { signed_distance(scene, asked.near, reach, distances); },
      [&](std::uint32_t i) { return distances[i].gradient != Vec3d{}; });

  std::optional<EmbreeClosest> embree;
  if (!plan.mesh.empty()) {
    Mesh mesh = read_mesh(plan.mesh, {&progress});
    run.triangles = mesh.triangles.size();
    if (EmbreeClosest::is_available()) embree.emplace(std::move(mesh));
  }
  std::vector<ClosestVoxel> found(plan.count);
  std::vector<double> other(plan.count);
  const auto closest_of = [&](const char* name, const std::vector<Capsule>& points,
                              const std::vector<Vec3d>& places, double most) {
    bench.measure(
        name, "voxdag", [&] { closest(scene, points, most, found); },
        [&](std::uint32_t i) { return found[i].is_found; });
    if (!embree) return;
    ContactsRate& rate = bench.measure(
        name, "embree", [&] { embree->find(places, most, other); },
        [&](std::uint32_t i) { return other[i] < HUGE_VAL; });
    rate.difference_voxels = mean_difference(found, other, scene.grid.voxel_size);
  };
  closest_of("closest near", asked.near_points, asked.near, reach);
  closest_of("closest far", asked.far_points, asked.far, HUGE_VAL);
  if (!plan.bullet.empty()) run_bullet(plan, asked, hits, scene.grid.voxel_size, run, progress);
  return run;
}

nlohmann::ordered_json contacts_json(const ContactsRun& run,
                                     const nlohmann::ordered_json& machine) {
  nlohmann::ordered_json json{{"machine", machine},
                              {"scene", run.scene},
                              {"levels", run.levels},
                              {"triangles", run.triangles},
                              {"rates", nlohmann::ordered_json::array()}};
  for (const ContactsRate& rate : run.rates) {
    nlohmann::ordered_json& row =
        json["rates"].emplace_back(nlohmann::ordered_json{{"query", rate.query},
                                                          {"program", rate.program},
                                                          {"per_ms", rate.per_ms},
                                                          {"per_cpu_ms", rate.per_cpu_ms},
                                                          {"positive", rate.positive}});
    if (rate.program != "voxdag") row["difference_voxels"] = rate.difference_voxels;
  }
  return json;
}

std::string contacts_table(const ContactsRun& run) {
  std::string text = fmt::format("{}, {}³ voxels; {} triangles\n", run.scene,
                                 std::int64_t{1} << run.levels, run.triangles);
  text += fmt::format("{:22} {:8} {:>10} {:>10} {:>10} {:>12}\n", "query", "program", "per ms",
                      "per CPU ms", "positive", "difference");
  for (const ContactsRate& rate : run.rates)
    text += fmt::format(
        "{:22} {:8} {:>10.1f} {:>10.1f} {:>9.1f}% {:>12}\n", rate.query, rate.program, rate.per_ms,
        rate.per_cpu_ms, 100 * rate.positive,
        rate.program == "voxdag" ? "" : fmt::format("{:.2f} voxels", rate.difference_voxels));
  return text;
}

}  // namespace voxdag::lab
