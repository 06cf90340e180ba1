#pragma once
/// The errors of readers of a compact DAG.
#include "voxdag/core/error.hpp"

namespace voxdag {

[[noreturn]] inline void fail_broken_stream() {
  throw Error("the stream of the compact DAG is broken");
}

/// Throws for nodes with more words than 32-bit pointers can address.
[[noreturn]] inline void fail_too_large() {
  throw Error("the DAG is too large: its nodes have more words than 32-bit pointers can address");
}

}  // namespace voxdag
