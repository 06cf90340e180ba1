/// Replaces MeshViewSource in a library built without Embree. Every use reports that Embree is
/// missing.
#include "voxdag/core/error.hpp"
#include "voxdag/mesh_view/mesh_view_source.hpp"

namespace voxdag {

class MeshViewSource::Scene {};

namespace {

[[noreturn]] void refuse() {
  throw Error(
      "to show a mesh, voxdag needs Embree 3, but this one was built without it (install "
      "libembree-dev and build again)");
}

}  // namespace

MeshViewSource::MeshViewSource(Mesh /*mesh*/, const MeshViewOptions& /*options*/) { refuse(); }

MeshViewSource::MeshViewSource(Mesh /*mesh*/, Appearance /*appearance*/,
                               const MeshViewOptions& /*options*/,
                               std::vector<std::string>* /*warnings*/, Work /*work*/) {
  refuse();
}

MeshViewSource::~MeshViewSource() = default;

void MeshViewSource::sample(const Camera&, const ViewTile&, std::span<ViewSample>) const {}

}  // namespace voxdag
