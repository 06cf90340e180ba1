#pragma once
/// Writes a DAG as a .vdag file.
#include <filesystem>

#include "voxdag/file/attribute_form.hpp"
#include "voxdag/file/vdag_metadata.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/compact/compact_svdag.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Writes the file, which appears under `path` when it is complete (see AtomicFile). Its bytes
/// depend on the arguments alone. metadata.grid.levels must equal view.levels. Throws Error if the
/// file cannot be written, or if the grid has values that parse_vdag_metadata() would refuse.
/// `attributes` are the attributes of the DAG's cells; empty: the file has none. `form`
/// says how it stores colours and normals.
void write_vdag(const std::filesystem::path& path, const SvdagView& view,
                const VdagMetadata& metadata, const DagAttributesView& attributes = {},
                AttributeForm form = AttributeForm::kPages);

/// Writes a DAG in the compact form. Leaves out the numbers of cells, because they follow from the
/// DAG. Throws Error like the function above, and if metadata.attributes does not describe
/// `attributes`.
void write_vdag(const std::filesystem::path& path, const CompactSvdag& compact,
                const VdagMetadata& metadata, const DagAttributesView& attributes = {},
                AttributeForm form = AttributeForm::kPages);

}  // namespace voxdag
