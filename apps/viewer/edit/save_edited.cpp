#include "viewer/edit/save_edited.hpp"

#include <utility>

#include "voxdag/file/model/dag_model.hpp"

namespace voxdag {

void save_edited(const EditSnapshot& version, VdagMetadata metadata,
                 const std::filesystem::path& path, bool compact, Work work) {
  std::string& edits = metadata.build["edits"];
  edits += (edits.empty() ? "" : "; ") + std::string("in the viewer");
  Svdag voxels = version.svdag(work);
  DagAttributes attributes = version.attributes(voxels.view(), {}, work);
  for (auto* values : {&metadata.attributes.colors, &metadata.attributes.normals})
    if (*values) (*values)->errors.reset();
  if (attributes.view().is_empty() && !voxels.view().is_empty()) metadata.attributes = {};
  const DagModel model(std::move(voxels), std::move(attributes), std::move(metadata), work);
  model.save(path, compact, work);
}

}  // namespace voxdag
