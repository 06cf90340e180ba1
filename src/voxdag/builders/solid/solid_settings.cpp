#include "voxdag/builders/solid/solid_settings.hpp"

#include <stdexcept>

#include "voxdag/core/number_text.hpp"

namespace voxdag {
namespace {

constexpr const char *kThreshold = "winding_threshold", *kRule = "solid_rule";

double positive_number(const std::string& text) {
  const double number = number_in(text).value_or(0);
  if (!(number > 0)) throw std::invalid_argument("\"" + text + "\" is no positive number");
  return number;
}

}  // namespace

std::string name_of(SolidRule rule) {
  switch (rule) {
    case SolidRule::kParity:
      return "parity";
    case SolidRule::kWinding:
      return "winding";
    case SolidRule::kFlood:
      break;
  }
  return "flood";
}

SolidRule solid_rule(const std::string& name) {
  for (const SolidRule rule : {SolidRule::kParity, SolidRule::kWinding, SolidRule::kFlood})
    if (name == name_of(rule)) return rule;
  throw std::invalid_argument("\"" + name + "\" is none of parity, winding and flood");
}

void add_solid_settings(const SolidOptions& options, std::map<std::string, std::string>& settings) {
  settings["solid"] = name_of(options.rule);
  if (options.rule == SolidRule::kWinding)
    settings[kThreshold] = number_text(options.winding_threshold);
  if (options.by_centre) settings[kRule] = "centre";
}

SolidOptions solid_options(const std::map<std::string, std::string>& settings) {
  SolidOptions options;
  options.rule = solid_rule(settings.at("solid"));
  if (const auto threshold = settings.find(kThreshold); threshold != settings.end())
    options.winding_threshold = positive_number(threshold->second);
  if (const auto rule = settings.find(kRule); rule != settings.end()) {
    if (rule->second != "centre")
      throw std::invalid_argument("\"" + rule->second + "\" is no rule for voxels");
    options.by_centre = true;
  }
  return options;
}

}  // namespace voxdag
