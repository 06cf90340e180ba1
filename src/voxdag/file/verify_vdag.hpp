#pragma once
/// Runs all checks of a .vdag file and reports the result of each.
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/file/vdag_container.hpp"
#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {

struct VerifyCheck {
  enum class Result { kPassed, kFailed, kSkipped };

  std::string name;  ///< "container", "checksums", "metadata", "structure", ...
  Result result = Result::kSkipped;
  std::string detail;  ///< "PLACE: REASON" if it failed; why it was skipped; empty if it passed.
};

struct VerifyReport {
  std::vector<VerifyCheck> checks;  ///< Always the same checks in the same order.
  bool passed() const;
};

/// Runs `work` as the check `name` and adds its result to the report: it fails with the Error that
/// work throws, and is skipped if one of the checks in `needed` (by index) did not pass.
template <class Work>
void run_check(VerifyReport& report, std::string name, std::initializer_list<std::size_t> needed,
               const Work& work) {
  VerifyCheck check;
  check.name = std::move(name);
  for (const std::size_t index : needed)
    if (check.detail.empty() && report.checks[index].result != VerifyCheck::Result::kPassed)
      check.detail = report.checks[index].name + " did not pass";
  if (check.detail.empty()) {
    try {
      work();
      check.result = VerifyCheck::Result::kPassed;
    } catch (const Error& error) {
      check.result = VerifyCheck::Result::kFailed;
      check.detail = error.what();
    }
  }
  report.checks.push_back(std::move(check));
}

/// Throws Error if the counts that a file states are not those of its DAG.
void compare_counts(const SvdagCounts& stated, const SvdagCounts& counted);

/// Throws Error if the metadata describes other attributes than those that are stored. A DAG
/// without voxels stores none.
void compare_attributes(const AttributesMetadata& stated, const DagAttributesView& stored);

/// Runs all checks, but skips those that make no sense after a failed one:
///   container        magic, version, sizes, chunk table, padding
///   checksums        every chunk has its checksum
///   metadata         the JSON and its values
///   structure        validate_svdag: acyclic by level, pointers in range, no empty nodes
///   canonical order  check_canonical: also that every node is reachable
///   minimality       check_minimal: no two equal nodes in a level
///   counts           the metadata has the counts of the DAG
///   attributes       numbers of cells and attributes are valid, and the metadata describes them;
///                    passes if the file has none
/// Throws Error only if the file cannot be read.
VerifyReport verify_vdag(const std::filesystem::path& path);
VerifyReport verify_vdag(const VdagContainer& file);

}  // namespace voxdag
