#pragma once
/// Runs all checks of a .vdag file and reports the result of each.
#include <filesystem>
#include <string>
#include <vector>

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

/// Runs all checks, but skips those that make no sense after a failed one:
///   container        magic, version, sizes, chunk table, padding
///   checksums        every chunk has its checksum
///   metadata         the JSON and its values
///   structure        validate_svdag: acyclic by level, pointers in range, no empty nodes
///   canonical order  check_canonical: also that every node is reachable
///   minimality       check_minimal: no two equal nodes in a level
///   counts           the metadata has the counts of the DAG
///   attributes       numbers of cells, blocks of colours and normals; passes without any
/// Throws Error only if the file cannot be read.
VerifyReport verify_vdag(const std::filesystem::path& path);

}  // namespace voxdag
