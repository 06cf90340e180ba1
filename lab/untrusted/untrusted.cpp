#include "lab/untrusted/untrusted.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lab/runs/scratch_folder.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

namespace fs = std::filesystem;

/// A command may use 10 % and 8 MiB more than its memory limit.
constexpr double kLimitFactor = 1.1;
constexpr std::uint64_t kLimitSlack = std::uint64_t{8} << 20;

std::uint64_t disk_bytes(const fs::path& folder) {
  std::uint64_t bytes = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    struct stat info {};
    if (::stat(entry.path().c_str(), &info) != 0) continue;
    const auto stored = static_cast<std::uint64_t>(info.st_blocks) * 512;
    bytes += std::min<std::uint64_t>(stored, static_cast<std::uint64_t>(info.st_size));
  }
  return bytes;
}

std::string join_lines(const std::string& text) {
  const std::size_t end = text.find('\n');
  return end == std::string::npos ? text : text.substr(0, end);
}

/// Returns how a run broke a promise of docs/security.md, or an empty text.
std::string broken_promise(const UntrustedCase& test, const ChildResult& result,
                           const fs::path& folder, const std::vector<fs::path>& before) {
  if (result.timed_out) return "does not end in time";
  if (result.status > 1 || result.status < 0)
    return fmt::format("ends with status {}", result.status);
  if (test.status >= 0 && result.status != test.status)
    return fmt::format("ends with status {}, not {}", result.status, test.status);
  const auto allowed =
      static_cast<std::uint64_t>(kLimitFactor * static_cast<double>(test.memory_limit));
  if (test.memory_limit != 0 && result.cost.peak_bytes > allowed + kLimitSlack)
    return fmt::format("uses {} of memory", human_bytes(result.cost.peak_bytes));
  if (result.status == 0) return {};
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (std::find(before.begin(), before.end(), entry.path()) == before.end())
      return "leaves " + entry.path().filename().string();
  const auto lines = std::count(result.err.begin(), result.err.end(), '\n');
  return lines == 1 ? "" : fmt::format("prints {} lines to stderr, not one", lines);
}

UntrustedRun run_case(const UntrustedPlan& plan, const UntrustedCase& test, Progress& progress) {
  const ScratchFolder folder;
  test.write(folder.path());
  const auto command = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> all{plan.program};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return all;
  };
  if (!test.setup.empty()) {
    const ChildResult setup = run_child(command(test.setup), folder.path(), 0, progress);
    if (setup.status != 0) throw Error(test.name, "", "the setup failed: " + join_lines(setup.err));
  }
  UntrustedRun run{test.name, disk_bytes(folder.path()), test.memory_limit, {}, {}};
  std::vector<fs::path> before;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
    before.push_back(entry.path());
  run.result = run_child(command(test.command), folder.path(), plan.timeout_seconds, progress);
  run.failure = broken_promise(test, run.result, folder.path(), before);
  return run;
}

}  // namespace

std::vector<UntrustedRun> bench_untrusted(const UntrustedPlan& plan, Progress& progress) {
  std::vector<UntrustedCase> cases;
  for (const auto& some : {untrusted_mesh_cases(), untrusted_image_cases(), untrusted_file_cases()})
    for (const UntrustedCase& test : some)
      if (test.name.find(plan.only) != std::string::npos) cases.push_back(test);
  if (cases.empty()) throw Error("no case has \"" + plan.only + "\" in its name");
  std::vector<UntrustedRun> runs;
  for (const UntrustedCase& test : cases) {
    progress.report(test.name,
                    static_cast<double>(runs.size()) / static_cast<double>(cases.size()));
    runs.push_back(run_case(plan, test, progress));
  }
  return runs;
}

nlohmann::ordered_json untrusted_json(const std::vector<UntrustedRun>& runs,
                                      const nlohmann::ordered_json& machine) {
  nlohmann::ordered_json json{{"machine", machine}, {"cases", nlohmann::ordered_json::array()}};
  for (const UntrustedRun& run : runs)
    json["cases"].push_back({{"name", run.name},
                             {"input_bytes", run.input_bytes},
                             {"memory_limit", run.memory_limit},
                             {"status", run.result.status},
                             {"cpu_seconds", run.result.cost.cpu_seconds()},
                             {"wall_seconds", run.result.cost.wall_seconds},
                             {"peak_bytes", run.result.cost.peak_bytes},
                             {"message", join_lines(run.result.err)},
                             {"failure", run.failure}});
  return json;
}

std::string untrusted_table(const std::vector<UntrustedRun>& runs) {
  std::string table = fmt::format("{:<34}{:>11}{:>10}{:>11}{:>11}{:>8}  {}\n", "case", "input",
                                  "CPU s", "peak", "limit", "status", "promise");
  for (const UntrustedRun& run : runs)
    table += fmt::format(
        "{:<34}{:>11}{:>10.2f}{:>11}{:>11}{:>8}  {}\n", run.name, human_bytes(run.input_bytes),
        run.result.cost.cpu_seconds(), human_bytes(run.result.cost.peak_bytes),
        run.memory_limit == 0 ? "-" : human_bytes(run.memory_limit), run.result.status,
        run.failure.empty() ? "kept" : "BROKEN: " + run.failure);
  const auto cost = [](const UntrustedRun& a, const UntrustedRun& b) {
    return a.result.cost.cpu_seconds() < b.result.cost.cpu_seconds();
  };
  const auto memory = [](const UntrustedRun& a, const UntrustedRun& b) {
    return a.result.cost.peak_bytes < b.result.cost.peak_bytes;
  };
  const UntrustedRun& slowest = *std::max_element(runs.begin(), runs.end(), cost);
  const UntrustedRun& largest = *std::max_element(runs.begin(), runs.end(), memory);
  return table + fmt::format("\nslowest: {}, {:.2f} s; largest: {}, {}\n", slowest.name,
                             slowest.result.cost.cpu_seconds(), largest.name,
                             human_bytes(largest.result.cost.peak_bytes));
}

}  // namespace voxdag::lab
