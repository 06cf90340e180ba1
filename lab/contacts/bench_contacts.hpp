#pragma once
/// `voxdag bench contacts`: contact queries per millisecond, also against other programs.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "voxdag/core/parallel/work.hpp"

namespace voxdag::lab {

struct ContactsPlan {
  std::string scene;             ///< A .vdag file.
  std::string mesh;              ///< The mesh that it was built from, for the rivals; empty: none.
  std::string bullet;            ///< The program rival_bullet; empty: none.
  std::uint32_t count = 100000;  ///< Queries of each kind.
  double radius = 16;            ///< Of spheres and capsules, in voxels.
  int repeats = 3;               ///< The fastest counts.
};

/// The rate of one kind of query.
struct ContactsRate {
  std::string query;
  std::string program;    ///< voxdag, embree or bullet.
  double per_ms = 0;      ///< Of wall-clock time, on all threads.
  double per_cpu_ms = 0;  ///< Of processor time, all threads together.
  double positive = 0;    ///< The part of the queries that touch, hit or find something.
  /// The mean difference between a rival's distances and voxdag's, in voxels, where both find
  /// something.
  double difference_voxels = 0;
};

struct ContactsRun {
  std::string scene;
  int levels = 0;
  std::uint64_t triangles = 0;
  std::vector<ContactsRate> rates;
};

/// Measures on the threads of the current TBB arena. Queries lie near the surface, within two radii
/// of random voxels, and for "far" anywhere in the box of the voxels; seeds are fixed. Throws Error
/// and Cancelled.
ContactsRun bench_contacts(const ContactsPlan& plan, Progress& progress);

nlohmann::ordered_json contacts_json(const ContactsRun& run, const nlohmann::ordered_json& machine);
std::string contacts_table(const ContactsRun& run);

}  // namespace voxdag::lab
