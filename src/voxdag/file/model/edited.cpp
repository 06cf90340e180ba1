#include "voxdag/file/model/edited.hpp"

#include <utility>

namespace voxdag {

DagModel edited(const VdagMetadata& source, Svdag dag, const Grid& grid, const std::string& edit,
                Work work) {
  VdagMetadata metadata = source;
  metadata.grid = grid;
  metadata.attributes = {};
  metadata.presentation.home.reset();
  std::string& edits = metadata.build["edits"];
  edits += (edits.empty() ? "" : "; ") + edit;
  return {std::move(dag), {}, std::move(metadata), work};
}

}  // namespace voxdag
