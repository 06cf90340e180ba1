#pragma once
/// Makes a page of values that other pages hold and of new ones.
///
/// Copied values do not change: the page takes the blocks that hold them over, cut where a copy or
/// the page ends, with their ends and weights. It joins parts of one block again, so pages do not
/// grow however often their values move.
#include <span>

#include "voxdag/stored/attributes/encode_page.hpp"

namespace voxdag {

/// Consecutive values of a page that are those of another page, or of two.
struct CopiedValues {
  int begin = 0, count = 0;
  ValuePagesView from;
  std::uint64_t first = 0;  ///< The number of the first value in `from`.
};

/// Returns the precision of pages that copy values from pages with these precisions: theirs if they
/// are equal, else 8 bits; with blocks of any length.
PagePrecision joined_precision(std::span<const PagePrecision> from);

/// Compresses the values of a page. Those of `copies`, in order and disjoint, stay as they are. Of
/// `values`, which may be empty if all are copied, only the others count: they are rounded to
/// `precision`, which is joined_precision() of all sources, and EncodedPage::errors has their
/// differences. A page that would outgrow kMaxPageWords stores each value by itself; unless
/// `precision` has 8 bits, that rounds copied values, too, and sets EncodedPage::rounds_copies. The
/// last of the `given` values fills the page up.
EncodedPage join_page(std::span<const Value8> values, std::span<const CopiedValues> copies,
                      int given, const ValueMetric& metric, PagePrecision precision);

}  // namespace voxdag
