#pragma once
/// Checks compressed values, so that untrusted ones can be read.
#include "voxdag/layout/value_pages.hpp"

namespace voxdag {

/// Throws Error unless every page consists of whole blocks of 256 values in all, pages follow each
/// other without gaps, both tables have their places, and unused bits are zero. read_value() is
/// then safe for every number. view.groups, view.pages and view.words must have as many values as
/// the view says. Linear time. Errors name the page.
void validate_value_pages(const ValuePagesView& view);

}  // namespace voxdag
