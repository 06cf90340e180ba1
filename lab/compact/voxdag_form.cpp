#include "lab/compact/voxdag_form.hpp"

#include "voxdag/stored/compact/compact_bytes.hpp"
#include "voxdag/stored/compact/compact_parts.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"

namespace voxdag::lab {

SizeInParts voxdag_size(const SvdagView& dag, Progress& progress) {
  const CompactSvdag compact = encode_svdag(dag, {}, &progress);
  const CompactParts parts = compact_parts(compact.view());
  const auto bytes = [](std::uint64_t bits) { return (bits + 7) / 8; };
  return {{{"head", compact_head(compact).size()},
           {"nodes", bytes(parts.node_bits)},
           {"units", bytes(parts.unit_bits)},
           {"shared bricks", bytes(parts.shared_brick_bits)}}};
}

}  // namespace voxdag::lab
