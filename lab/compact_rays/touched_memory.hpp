#pragma once
/// Counts what rays read of a DAG in memory if each starts with empty caches.
#include <span>

#include "voxdag/stored/compact/compact_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag::lab {

/// The means over rays.
struct TouchedMemory {
  double bytes = 0;    ///< Different bytes read.
  double lines = 0;    ///< Different 64-byte lines that they lie in.
  double symbols = 0;  ///< Decoded symbols; 0 at the plain form.
};

/// Counts the words of nodes and leaf blocks.
TouchedMemory touched_memory(const SvdagView& dag, std::span<const CastRay> casts);
/// Counts the bits of records and the places of shared nodes. The counts omit the context trees and
/// their tables, which are few and which all rays share. A ray decodes each record once.
TouchedMemory touched_memory(const CompactSvdagView& dag, std::span<const CastRay> casts);

}  // namespace voxdag::lab
