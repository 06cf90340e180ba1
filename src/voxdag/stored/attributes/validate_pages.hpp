#pragma once
/// Checks compressed values and packed materials from an untrusted file.
#include "voxdag/stored/attributes/material_ids.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// Throws Error unless every page consists of whole blocks with 256 values in all, pages follow
/// each other without gaps, both tables have the pages' first bytes, and all unused bits are zero.
/// Then read_value() is safe for every number. The arrays of `view` must be as long as it says.
/// Linear time. The place of an error is "page 17".
void validate_value_pages(const ValuePagesView& view);

/// Throws Error unless `view` is what MaterialEncoder makes of some ids. Then read_material() is
/// safe for every number. The arrays of `view` must be as long as it says. Linear time. The place
/// of an error is "page 17".
void validate_material_ids(const MaterialIdsView& view);

}  // namespace voxdag
