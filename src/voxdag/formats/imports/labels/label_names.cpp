#include "voxdag/formats/imports/labels/label_names.hpp"

#include <charconv>

#include "voxdag/core/error.hpp"
#include "voxdag/core/printable.hpp"

namespace voxdag {

std::vector<std::string> names_of_labels(const std::vector<Label>& labels,
                                         const std::map<Label, std::string>& known) {
  std::vector<std::string> names;
  std::map<std::string, int> uses;
  for (const Label label : labels) {
    const auto found = known.find(label);
    const bool has_name = found != known.end() && !found->second.empty();
    names.push_back(has_name ? found->second : std::to_string(label));
    ++uses[names.back()];
  }
  for (std::size_t i = 0; i < names.size(); ++i)
    if (uses[names[i]] > 1) names[i] += " " + std::to_string(labels[i]);
  return names;
}

LabelFilter::LabelFilter(const VoxelSource& source, const ImportOptions& options)
    : is_for_all_(options.labels.empty()), drops_(options.drops_labels) {
  if (is_for_all_) return;
  const std::map<Label, std::string> names = source.label_names();
  for (const std::string& wanted : options.labels) {
    bool is_name = false;
    for (const auto& [label, name] : names)
      if (name == wanted) labels_.insert(label), is_name = true;
    if (is_name) continue;
    Label number = 0;
    const char* const end = wanted.data() + wanted.size();
    const auto [read, error] = std::from_chars(wanted.data(), end, number);
    if (error != std::errc{} || read != end)
      throw Error("", "", "has no label " + in_quotes(wanted));
    labels_.insert(number);
  }
}

}  // namespace voxdag
