#pragma once
/// The checks of a compact DAG.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/file/verify_vdag.hpp"

namespace voxdag::cli {

/// Runs all checks, but skips those that make no sense after a failed one:
///   container   magic, version, sizes, chunk table, padding
///   checksums   every chunk has its checksum
///   metadata    the JSON and its values
///   structure   the head is right, and the stream decodes to a DAG
///   canonical   encoding that DAG again gives the same bytes
///   counts      the metadata has the counts of the DAG
///   attributes  attributes are valid, and the metadata describes them; passes if the file has none
/// Throws Cancelled.
VerifyReport verify_compact(const VdagContainer& file, Work work);

}  // namespace voxdag::cli
