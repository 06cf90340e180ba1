#include "bench/reproduce/build_series.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "voxdag/report/human.hpp"

namespace voxdag {
namespace {

std::vector<std::string> options_of(BuildKind kind) {
  switch (kind) {
    case BuildKind::kPaper:
      return {"--method", "paper"};
    case BuildKind::kHash:
      return {"--method", "hash"};
    case BuildKind::kEsvo:
      return {"--as", "esvo"};
    case BuildKind::kShape:
      break;
  }
  return {"--as", "esvo", "--no-attributes"};
}

/// Returns why the build after `last` is not worth a try; empty if it is.
std::string reason_to_stop(const PapersPlan& plan, const SeriesBuild& last, int levels) {
  if (!last.result.failure.empty())
    return fmt::format("not run, because {}³ failed: {}", 1 << last.levels, last.result.failure);
  // The seconds of reading the mesh do not grow; the others grow by four at most, as surfaces do.
  const double predicted = last.result.cost.wall_seconds * std::exp2(levels - last.levels);
  if (plan.cell_seconds > 0 && predicted > plan.cell_seconds)
    return fmt::format("not run, because {}³ took {}, and the limit is {}", 1 << last.levels,
                       human_duration(last.result.cost.wall_seconds),
                       human_duration(plan.cell_seconds));
  return "";
}

}  // namespace

Cell build_cell(const PapersPlan& plan, const std::filesystem::path& mesh, int levels,
                const std::filesystem::path& output, const std::vector<std::string>& options) {
  Cell cell;
  cell.output = output;
  cell.inputs = {mesh};
  cell.arguments = {"build", mesh, "-r", std::to_string(1 << levels), "-o", output, "--json"};
  cell.arguments.insert(cell.arguments.end(), options.begin(), options.end());
  if (plan.memory_bytes > 0)
    cell.arguments.insert(cell.arguments.end(), {"--memory", std::to_string(plan.memory_bytes)});
  if (plan.threads > 0)
    cell.arguments.insert(cell.arguments.end(), {"--threads", std::to_string(plan.threads)});
  return cell;
}

std::vector<SeriesBuild> build_series(const PapersPlan& plan, BuildKind kind,
                                      const std::filesystem::path& mesh,
                                      const std::vector<int>& levels, CellStore& cells,
                                      Progress& progress) {
  const bool is_esvo = kind == BuildKind::kEsvo || kind == BuildKind::kShape;
  // An ESVO's file cannot be a device.
  const std::filesystem::path output = is_esvo ? plan.folder / "build.esvo" : "/dev/null";
  std::vector<SeriesBuild> builds;
  std::string reason;
  for (const int level : levels) {
    progress.throw_if_cancelled();
    SeriesBuild build{level, build_cell(plan, mesh, level, output, options_of(kind)), {}};
    build.cell.seconds_limit = plan.cell_seconds;
    if (reason.empty() && !builds.empty()) reason = reason_to_stop(plan, builds.back(), level);
    if (reason.empty()) {
      build.result = cells.run(build.cell);
      if (is_esvo) std::filesystem::remove(build.cell.output);
    } else {
      build.result.failure = reason;
    }
    builds.push_back(std::move(build));
  }
  return builds;
}

double typical_seconds(const PapersPlan& plan, BuildKind kind, const std::vector<int>& levels) {
  // Measured with Crytek Sponza: seconds at 2048³, and the factor from one level to the next.
  struct Cost {
    double seconds, growth;
  };
  static constexpr Cost kCosts[] = {{0.9, 3}, {0.4, 2.4}, {20, 4}, {4, 3.5}};
  const Cost& cost = kCosts[static_cast<int>(kind)];
  double sum = 0;
  for (const int level : levels) {
    const double seconds = cost.seconds * std::pow(cost.growth, level - 11);
    if (plan.cell_seconds > 0 && seconds > plan.cell_seconds) break;
    sum += seconds;
  }
  return sum;
}

}  // namespace voxdag
