#pragma once
/// The interface of rivals: other programs and libraries that do voxdag's work.
#include <span>
#include <string>
#include <vector>

#include "lab/rays/trace_rays.hpp"
#include "lab/rays/trace_runner.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

/// A set of rays in one scene.
struct RaySet {
  RayClass rays_class;
  std::span<const CastRay> casts;
};

/// The time of a rival for a set that it cast by itself.
struct RivalTime {
  RayClass rays_class;
  double seconds = 0;       ///< Time for the whole set.
  double agreeing = 0;      ///< Rays that hit for both rival and voxdag, or for neither.
  std::uint64_t bytes = 0;  ///< Size of the structure that it cast at; 0 if it does not say.
};

/// A rival casts rays. It keeps the default of functions that it does not support.
class Rival {
 public:
  explicit Rival(std::string name) : name_(std::move(name)) {}
  virtual ~Rival() = default;
  Rival(const Rival&) = delete;
  Rival& operator=(const Rival&) = delete;

  const std::string& name() const { return name_; }

  /// Takes a set of rays and returns casts of it, which run in turns with voxdag's casts. They are
  /// valid until the next call. If several have the same name, the fastest counts. A rival that
  /// casts its sets later returns none.
  virtual std::vector<TraceRunner> prepare(const Grid& grid, const RaySet& set);

  /// Casts the sets for which prepare() returned no casts. Returns one result for each set, in
  /// order. Throws Error if the rival fails, and Cancelled.
  virtual std::vector<RivalTime> cast_all(int repeat, Progress& progress);

 private:
  std::string name_;
};

}  // namespace voxdag::lab
