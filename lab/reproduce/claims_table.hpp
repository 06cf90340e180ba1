#pragma once
/// A table with a line for each claim of a paper.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "lab/report/document.hpp"
#include "lab/reproduce/table_text.hpp"

namespace voxdag::lab {

/// A value of one scene.
struct ClaimValue {
  std::string where;  ///< "Lucy at 4K³".
  int levels = 0;
  double value = 0;
};

inline bool is_less(const ClaimValue& a, const ClaimValue& b) { return a.value < b.value; }

inline std::string text_of(const ClaimValue& value) {
  return fmt::format("{} ({})", number_text(value.value), value.where);
}

/// Returns "3.1 (Lucy at 2K³) to 109 (Crysponza at 4K³)".
inline std::string range_text(const std::vector<ClaimValue>& values) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end(), is_less);
  return least == most ? text_of(*least) : text_of(*least) + " to " + text_of(*most);
}

inline const char* verdict(bool is_reproduced) {
  return is_reproduced ? "reproduced" : "not reproduced";
}

class ClaimsTable {
 public:
  ClaimsTable() : table_{"", {"claim", "published", "measured here", "verdict"}, {}, 4} {}

  void add(const char* claim, const char* published, const std::string& ours, const char* result) {
    table_.rows.push_back({claim, published, ours, result});
  }
  void add_unmeasured(const char* claim, const char* published) {
    add(claim, published, "–", "not measured");
  }
  /// Adds a claim about all values: it is reproduced if `holds` for each.
  template <class Holds>
  void add_range(const char* claim, const char* published, const std::vector<ClaimValue>& values,
                 const Holds& holds) {
    if (values.empty()) return add_unmeasured(claim, published);
    add(claim, published, range_text(values),
        verdict(std::all_of(values.begin(), values.end(),
                            [&](const ClaimValue& v) { return holds(v.value); })));
  }
  Table take(std::string caption) {
    table_.caption = std::move(caption);
    return std::move(table_);
  }

 private:
  Table table_;
};

}  // namespace voxdag::lab
